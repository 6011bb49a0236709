// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Measures soft solids, cloth, ropes and liquids at several resolutions beside theory: docs/physics/convergence.md.
int run_convergence(const BenchArguments& arguments);

}  // namespace embody::cli
