// SPDX-License-Identifier: MIT
#include "physics/deformable/solid_kernels.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::SolidKernels solid_kernels;
}
namespace embody::lanes_8 {
extern const physics::SolidKernels solid_kernels;
}
namespace embody::lanes_16 {
extern const physics::SolidKernels solid_kernels;
}

namespace embody::physics {

const SolidKernels* solid_kernels(int lanes) {
    return of_width(lanes, lanes_4::solid_kernels, lanes_8::solid_kernels, lanes_16::solid_kernels);
}

const SolidKernels& widest_solid_kernels() {
    return widest(lanes_4::solid_kernels, lanes_8::solid_kernels, lanes_16::solid_kernels);
}

}  // namespace embody::physics
