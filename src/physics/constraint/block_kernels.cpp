// SPDX-License-Identifier: MIT
// Which width this processor can run.
#include "physics/constraint/block_kernels.h"

namespace embody {
namespace lanes_4 {
extern const physics::BlockKernels block_kernels;
}
#ifdef EMBODY_HAS_X86_KERNELS
namespace lanes_8 {
extern const physics::BlockKernels block_kernels;
}
namespace lanes_16 {
extern const physics::BlockKernels block_kernels;
}
#endif
}  // namespace embody

namespace embody::physics {

const BlockKernels* block_kernels(int lanes) {
    if (lanes == 4) return &lanes_4::block_kernels;
#ifdef EMBODY_HAS_X86_KERNELS
    if (lanes == 8 && __builtin_cpu_supports("avx2")) return &lanes_8::block_kernels;
    if (lanes == 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        return &lanes_16::block_kernels;
    }
#endif
    return nullptr;
}

const BlockKernels& widest_block_kernels() {
    static const BlockKernels* const widest = [] {
        if (const BlockKernels* kernels = block_kernels(16)) return kernels;
        if (const BlockKernels* kernels = block_kernels(8)) return kernels;
        return &lanes_4::block_kernels;
    }();
    return *widest;
}

}  // namespace embody::physics
