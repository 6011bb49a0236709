// SPDX-License-Identifier: MIT
// The contact solver for 16 lanes; compiled with the flags of its instruction set (src/CMakeLists.txt).
#define EMBODY_LANES 16
#include "physics/constraint/sweeps/contact_kernel_code.h"
