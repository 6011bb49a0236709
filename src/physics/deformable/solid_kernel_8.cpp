// SPDX-License-Identifier: MIT
// Loops of soft solids for 8 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 8
#include "physics/deformable/solid_kernel_code.h"
