// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Fills soft models of the database with tetrahedra and prints what that gives: counts, shares of the volume, parts,
/// angles, the least weight of a drawn vertex, processor time. Fails where no model could be filled.
int run_tetrahedra(const BenchArguments& arguments);

}  // namespace embody::cli
