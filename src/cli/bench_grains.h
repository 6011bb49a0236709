// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Pours heaps of several friction angles, sizes and numbers of grains, draws a wall away, and times slabs, awake and
/// asleep. Fails where a poured heap misses its angle by more than 2 degrees.
int run_grains(const BenchArguments& arguments);

}  // namespace embody::cli
