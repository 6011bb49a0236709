// SPDX-License-Identifier: MIT
// Which width this processor can run.
#include "physics/constraint/contact_batch.h"

namespace embody {
namespace lanes_4 {
extern const physics::ContactKernels kernels;
}
#ifdef EMBODY_HAS_X86_KERNELS
namespace lanes_8 {
extern const physics::ContactKernels kernels;
}
namespace lanes_16 {
extern const physics::ContactKernels kernels;
}
#endif
}  // namespace embody

namespace embody::physics {

const ContactKernels* contact_kernels(int lanes) {
    if (lanes == 4) return &lanes_4::kernels;
#ifdef EMBODY_HAS_X86_KERNELS
    if (lanes == 8 && __builtin_cpu_supports("avx2")) return &lanes_8::kernels;
    if (lanes == 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
        return &lanes_16::kernels;
    }
#endif
    return nullptr;
}

const ContactKernels& widest_contact_kernels() {
    if (const ContactKernels* kernels = contact_kernels(16)) return *kernels;
    if (const ContactKernels* kernels = contact_kernels(8)) return *kernels;
    return lanes_4::kernels;
}

}  // namespace embody::physics
