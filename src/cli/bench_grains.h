// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Pours heaps of several friction angles, sizes and numbers of grains, removes a wall that holds grains back, and
/// times layers of grains, awake and asleep. Fails where a poured heap's angle is wrong by more than 2 degrees.
int run_grains(const BenchArguments& arguments);

}  // namespace embody::cli
