// SPDX-License-Identifier: MIT
// The contact solver for 4 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 4
#include "physics/constraint/sweeps/contact_kernel_code.h"
