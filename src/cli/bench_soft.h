// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Times cushions of some 1,200 to 15,000 tetrahedra that fall on each other beside 200 boxes in stacks, on one and two
/// threads. Fails where the end state is wrong or its bits depend on the number of threads.
int run_soft(const BenchArguments& arguments);

}  // namespace embody::cli
