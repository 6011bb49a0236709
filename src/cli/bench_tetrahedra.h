// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Fills soft models of the database with tetrahedra and prints the result: counts, fractions of the volume, parts,
/// angles, the smallest weight of a drawn vertex, processor time. Fails where no model could be filled.
int run_tetrahedra(const BenchArguments& arguments);

}  // namespace embody::cli
