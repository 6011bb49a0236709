// SPDX-License-Identifier: MIT
//
// Only numbers here: kernels include this file, and inline code would be merged across instruction sets.
#pragma once

#include <cstddef>

namespace embody {

/// Any width of the processor's registers gives the same bits.
struct RotationKernels {
    /// As embody::follow_rotations for `count` matrices of nine numbers, by columns, and as many quaternions x, y, z,
    /// w.
    void (*follow)(const double* deformation, double* rotation, std::size_t count);

    /// For each width of math/kernel_width.h.
    static const RotationKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody
