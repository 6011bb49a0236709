// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Decomposes models of the database and prints how well the hulls stand for them, beside the single hull: how many
/// hulls, what they add to the model and leave out of it, processor time. Fails where a model could not be decomposed.
int run_decomposition(const BenchArguments& arguments);

}  // namespace embody::cli
