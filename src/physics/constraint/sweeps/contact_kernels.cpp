// SPDX-License-Identifier: MIT
#include "physics/constraint/sweeps/contact_batch.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::constraint::ContactKernels kernels;
}
namespace embody::lanes_8 {
extern const physics::constraint::ContactKernels kernels;
}
namespace embody::lanes_16 {
extern const physics::constraint::ContactKernels kernels;
}

namespace embody::physics::constraint {

const ContactKernels* contact_kernels(int lanes) {
    return of_width(lanes, lanes_4::kernels, lanes_8::kernels, lanes_16::kernels);
}

const ContactKernels& widest_contact_kernels() { return widest(lanes_4::kernels, lanes_8::kernels, lanes_16::kernels); }

}  // namespace embody::physics::constraint
