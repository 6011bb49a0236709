// SPDX-License-Identifier: MIT
// Rotations in deformations for 16 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 16
#include "math/rotation_kernel_code.h"
