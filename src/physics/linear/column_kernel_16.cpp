// SPDX-License-Identifier: MIT
// Loops over columns for 16 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 16
#include "physics/linear/column_kernel_code.h"
