// SPDX-License-Identifier: MIT
// Which width this processor can run.
#include "physics/collision/polytope_kernels.h"

namespace embody {
namespace lanes_4 {
extern const physics::PolytopeKernels polytope_kernels;
}
#ifdef EMBODY_HAS_X86_KERNELS
namespace lanes_8 {
extern const physics::PolytopeKernels polytope_kernels;
}
namespace lanes_16 {
extern const physics::PolytopeKernels polytope_kernels;
}
#endif
}  // namespace embody

namespace embody::physics {

const PolytopeKernels* polytope_kernels(int lanes) {
    if (lanes == 4) return &lanes_4::polytope_kernels;
#ifdef EMBODY_HAS_X86_KERNELS
    if (lanes == 8 && __builtin_cpu_supports("avx2")) return &lanes_8::polytope_kernels;
    if (lanes == 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        return &lanes_16::polytope_kernels;
    }
#endif
    return nullptr;
}

}  // namespace embody::physics
