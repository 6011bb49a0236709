// SPDX-License-Identifier: MIT
// Which width this processor can run.
#include "physics/deformable/solid_kernels.h"

namespace embody {
namespace lanes_4 {
extern const physics::SolidKernels solid_kernels;
}
#ifdef EMBODY_HAS_X86_KERNELS
namespace lanes_8 {
extern const physics::SolidKernels solid_kernels;
}
namespace lanes_16 {
extern const physics::SolidKernels solid_kernels;
}
#endif
}  // namespace embody

namespace embody::physics {

const SolidKernels* solid_kernels(int lanes) {
    if (lanes == 4) return &lanes_4::solid_kernels;
#ifdef EMBODY_HAS_X86_KERNELS
    if (lanes == 8 && __builtin_cpu_supports("avx2")) return &lanes_8::solid_kernels;
    if (lanes == 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        return &lanes_16::solid_kernels;
    }
#endif
    return nullptr;
}

const SolidKernels& widest_solid_kernels() {
    static const SolidKernels* const widest = [] {
        if (const SolidKernels* kernels = solid_kernels(16)) return kernels;
        if (const SolidKernels* kernels = solid_kernels(8)) return kernels;
        return &lanes_4::solid_kernels;
    }();
    return *widest;
}

}  // namespace embody::physics
