// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Prints what steps of moving cloth, solids, water and grains cost in three sizes each, with one worker and with as
/// many as pay, and how that grows; fails where an end state is wrong or depends on the workers.
int run_matter(const BenchArguments& arguments);

}  // namespace embody::cli
