// SPDX-License-Identifier: MIT
// Rotations in deformations for 8 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 8
#include "math/rotation_kernel_code.h"
