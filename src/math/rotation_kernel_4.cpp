// SPDX-License-Identifier: MIT
// Rotations in deformations for 4 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 4
#include "math/rotation_kernel_code.h"
