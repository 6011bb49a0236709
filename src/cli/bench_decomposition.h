// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Decomposes models of the database and prints how well the hulls represent them, compared with the single hull:
/// number of hulls, volume added and left out, processor time. Fails where a model could not be decomposed.
int run_decomposition(const BenchArguments& arguments);

}  // namespace embody::cli
