// SPDX-License-Identifier: MIT
#include "math/kernel_width.h"

namespace embody {

// The flags that wider kernels are compiled with: src/CMakeLists.txt.
bool has_lanes(int lanes) {
    if (lanes == 4) return true;
#if defined(__x86_64__)
    if (lanes == 8) return __builtin_cpu_supports("avx2");
    if (lanes == 16) return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
#endif
    return false;
}

}  // namespace embody
