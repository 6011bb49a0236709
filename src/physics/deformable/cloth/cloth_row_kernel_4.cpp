// SPDX-License-Identifier: MIT
// Rows of cloth for 4 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 4
#include "physics/deformable/cloth/cloth_row_kernel_code.h"
