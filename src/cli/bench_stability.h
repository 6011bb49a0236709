// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Simulates the structures, or the one that `arguments.scene` names, and prints the results; fails where a goal is
/// missed.
int run_stability(const BenchArguments& arguments);

}  // namespace embody::cli
