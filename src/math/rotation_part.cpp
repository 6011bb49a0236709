// SPDX-License-Identifier: MIT
#include "math/rotation_part.h"

#include "math/kernel_width.h"
#include "math/rotation_kernels.h"

namespace embody {

static_assert(sizeof(Mat3) == 9 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double), "kernels read plain numbers");

void follow_rotations(std::span<const Mat3> deformations, std::span<Quat> rotations) {
    if (rotations.empty()) return;
    widest_kernels<RotationKernels>().follow(&deformations[0].x.x, &rotations[0].x, rotations.size());
}

void follow_rotation(const Mat3& deformation, Quat& rotation) { follow_rotations({&deformation, 1}, {&rotation, 1}); }

}  // namespace embody
