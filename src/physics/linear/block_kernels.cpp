// SPDX-License-Identifier: MIT
#include "physics/linear/block_kernels.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::linear::BlockKernels block_kernels;
}
namespace embody::lanes_8 {
extern const physics::linear::BlockKernels block_kernels;
}
namespace embody::lanes_16 {
extern const physics::linear::BlockKernels block_kernels;
}

namespace embody::physics::linear {

const BlockKernels* block_kernels(int lanes) {
    return of_width(lanes, lanes_4::block_kernels, lanes_8::block_kernels, lanes_16::block_kernels);
}

const BlockKernels& widest_block_kernels() {
    return widest(lanes_4::block_kernels, lanes_8::block_kernels, lanes_16::block_kernels);
}

}  // namespace embody::physics::linear
