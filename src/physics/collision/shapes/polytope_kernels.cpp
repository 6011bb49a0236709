// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/polytope_kernels.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::collision::PolytopeKernels polytope_kernels;
}
namespace embody::lanes_8 {
extern const physics::collision::PolytopeKernels polytope_kernels;
}
namespace embody::lanes_16 {
extern const physics::collision::PolytopeKernels polytope_kernels;
}

namespace embody::physics::collision {

const PolytopeKernels* polytope_kernels(int lanes) {
    return of_width(lanes, lanes_4::polytope_kernels, lanes_8::polytope_kernels, lanes_16::polytope_kernels);
}

}  // namespace embody::physics::collision
