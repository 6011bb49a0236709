// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Stands up the structures, or the one of `arguments.scene`, and prints how they did; fails where a goal is missed.
int run_stability(const BenchArguments& arguments);

}  // namespace embody::cli
