// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Runs SimBenchmark's accuracy tests, or the one of `arguments.scene`, beside the best published errors; fails only
/// where an error is no number.
int run_simbenchmark(const BenchArguments& arguments);

}  // namespace embody::cli
