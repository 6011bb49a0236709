// SPDX-License-Identifier: MIT
// Factors of blocked matrices for 8 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 8
#include "physics/linear/block_kernel_code.h"
