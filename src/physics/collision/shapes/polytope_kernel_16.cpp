// SPDX-License-Identifier: MIT
// Loops over polytopes for 16 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 16
#include "physics/collision/shapes/polytope_kernel_code.h"
