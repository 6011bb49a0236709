// SPDX-License-Identifier: MIT
// Rows of cloth for 8 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 8
#include "physics/deformable/cloth/cloth_row_kernel_code.h"
