// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Fills `arguments.database` with seeded variants of its models until it holds `arguments.models`, then measures
/// search, listing and memory on it; a second run adds nothing.
int run_catalogue_bench(const BenchArguments& arguments);

}  // namespace embody::cli
