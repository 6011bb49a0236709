// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Runs SimBenchmark's accuracy tests, or the one that `arguments.scene` names, and prints the errors beside the best
/// published ones; fails only where an error is not a number.
int run_simbenchmark(const BenchArguments& arguments);

}  // namespace embody::cli
