// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/cloth_row_kernels.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::deformable::ClothRowKernels cloth_row_kernels;
}
namespace embody::lanes_8 {
extern const physics::deformable::ClothRowKernels cloth_row_kernels;
}
namespace embody::lanes_16 {
extern const physics::deformable::ClothRowKernels cloth_row_kernels;
}

namespace embody::physics::deformable {

const ClothRowKernels* cloth_row_kernels(int lanes) {
    return of_width(lanes, lanes_4::cloth_row_kernels, lanes_8::cloth_row_kernels, lanes_16::cloth_row_kernels);
}

const ClothRowKernels& widest_cloth_row_kernels() {
    return widest(lanes_4::cloth_row_kernels, lanes_8::cloth_row_kernels, lanes_16::cloth_row_kernels);
}

}  // namespace embody::physics::deformable
