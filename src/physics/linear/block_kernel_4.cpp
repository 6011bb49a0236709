// SPDX-License-Identifier: MIT
// Factors of blocked matrices for 4 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 4
#include "physics/linear/block_kernel_code.h"
