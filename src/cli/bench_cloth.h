// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Times a tablecloth of 3,000 to 30,000 edges that falls over a table beside 200 boxes in stacks, on one and two
/// threads. Fails where the end state is wrong or its bits depend on the number of threads.
int run_cloth(const BenchArguments& arguments);

}  // namespace embody::cli
