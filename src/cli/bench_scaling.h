// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Prints what a step costs with 1,000 bodies, 10,000 … `arguments.bodies`, and how it grows; fails where a scene did
/// not end as it must.
int run_scaling(const BenchArguments& arguments);

}  // namespace embody::cli
