// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Prints the cost of a step with 1,000 bodies, 10,000 … `arguments.bodies`, and its growth; fails where the end state
/// of a scene is wrong.
int run_scaling(const BenchArguments& arguments);

}  // namespace embody::cli
