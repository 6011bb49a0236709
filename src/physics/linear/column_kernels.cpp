// SPDX-License-Identifier: MIT
#include "physics/linear/column_kernels.h"

#include "math/kernel_width.h"

namespace embody::lanes_4 {
extern const physics::linear::ColumnKernels column_kernels;
}
namespace embody::lanes_8 {
extern const physics::linear::ColumnKernels column_kernels;
}
namespace embody::lanes_16 {
extern const physics::linear::ColumnKernels column_kernels;
}

namespace embody::physics::linear {

const ColumnKernels* column_kernels(int lanes) {
    return of_width(lanes, lanes_4::column_kernels, lanes_8::column_kernels, lanes_16::column_kernels);
}

const ColumnKernels& widest_column_kernels() {
    return widest(lanes_4::column_kernels, lanes_8::column_kernels, lanes_16::column_kernels);
}

}  // namespace embody::physics::linear
