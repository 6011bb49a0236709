// SPDX-License-Identifier: MIT
// Which width this processor can run.
#include "physics/deformable/cloth_row_kernels.h"

namespace embody {
namespace lanes_4 {
extern const physics::ClothRowKernels cloth_row_kernels;
}
#ifdef EMBODY_HAS_X86_KERNELS
namespace lanes_8 {
extern const physics::ClothRowKernels cloth_row_kernels;
}
namespace lanes_16 {
extern const physics::ClothRowKernels cloth_row_kernels;
}
#endif
}  // namespace embody

namespace embody::physics {

const ClothRowKernels* cloth_row_kernels(int lanes) {
    if (lanes == 4) return &lanes_4::cloth_row_kernels;
#ifdef EMBODY_HAS_X86_KERNELS
    if (lanes == 8 && __builtin_cpu_supports("avx2")) return &lanes_8::cloth_row_kernels;
    if (lanes == 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        return &lanes_16::cloth_row_kernels;
    }
#endif
    return nullptr;
}

const ClothRowKernels& widest_cloth_row_kernels() {
    static const ClothRowKernels* const widest = [] {
        if (const ClothRowKernels* kernels = cloth_row_kernels(16)) return kernels;
        if (const ClothRowKernels* kernels = cloth_row_kernels(8)) return kernels;
        return &lanes_4::cloth_row_kernels;
    }();
    return *widest;
}

}  // namespace embody::physics
