// SPDX-License-Identifier: MIT
#include "math/rotation_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/random.h"
#include "math/kernel_width.h"
#include "math/rotation_kernels.h"

namespace embody {
namespace {

Vec3 vector_in_cube(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

/// Turned by up to half a turn and strained by up to `strain` in every direction.
std::vector<Mat3> random_deformations(std::size_t count, double strain, std::uint64_t seed) {
    Random random(seed);
    std::vector<Mat3> all(count);
    for (Mat3& deformation : all) {
        const Quat turn = from_axis_angle(normalized(vector_in_cube(random), {1, 0, 0}), random.between(0, 3));
        const Mat3 stretch{Vec3{1, 0, 0} + strain * vector_in_cube(random),
                           Vec3{0, 1, 0} + strain * vector_in_cube(random),
                           Vec3{0, 0, 1} + strain * vector_in_cube(random)};
        deformation = to_matrix(turn) * stretch;
    }
    return all;
}

TEST(RotationPart, LeavesASymmetricStretch) {
    const std::vector<Mat3> deformations = random_deformations(101, 0.4, 1);
    std::vector<Quat> rotations(deformations.size());
    follow_rotations(deformations, rotations);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        const Mat3 stretch = transpose(to_matrix(rotations[i])) * deformations[i];
        EXPECT_NEAR(dot(rotations[i], rotations[i]), 1, 1e-14);
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < r; ++c) EXPECT_NEAR(stretch(r, c), stretch(c, r), 1e-9) << i;
        }
        // The nearest rotation of those that make it symmetric: no eigenvalue but the least may be negative.
        const Vec3 values = eigen_symmetric(0.5 * (stretch + transpose(stretch))).values;
        EXPECT_GT(values.y + values.x, -1e-9) << i;
    }
}

TEST(RotationPart, FollowsAnElementThroughItsFlatStateWithoutAJump) {
    Quat rotation;
    for (double thickness = 1; thickness > -0.9; thickness -= 0.05) {
        const Quat before = rotation;
        follow_rotation(Mat3::diagonal({1, thickness, 1.2}), rotation);
        EXPECT_GT(std::fabs(dot(before, rotation)), 0.999) << thickness;
    }
}

TEST(RotationPart, OneIsFoundAsAmongOthers) {
    const std::vector<Mat3> deformations = random_deformations(23, 1.5, 2);  // some of them inverted
    std::vector<Quat> together(deformations.size());
    follow_rotations(deformations, together);
    for (std::size_t i = 0; i < deformations.size(); ++i) {
        Quat alone;
        follow_rotation(deformations[i], alone);
        EXPECT_EQ(alone, together[i]) << i;
    }
}

TEST(RotationPart, KeepsItsLastValueWhereTheDeformationIsNoNumber) {
    const double nan = std::nan("");
    Quat rotation = from_axis_angle({0, 1, 0}, 0.3);
    const Quat before = rotation;
    follow_rotation({{nan, 0, 0}, {0, 1, 0}, {0, 0, 1}}, rotation);
    EXPECT_EQ(rotation, before);
}

TEST(RotationPart, AnyWidthGivesTheSameBits) {
    const std::vector<Mat3> deformations = random_deformations(23, 1.5, 3);
    const auto rotations = [&](const RotationKernels& kernels) {
        std::vector<Quat> all(deformations.size());
        kernels.follow(&deformations[0].x.x, &all[0].x, all.size());
        return all;
    };
    const std::vector<Quat> expected = rotations(*kernels_of<RotationKernels>(4));
    int widths = 0;
    for (const int lanes : {8, 16}) {
        const RotationKernels* kernels = kernels_of<RotationKernels>(lanes);
        if (kernels == nullptr) continue;
        ++widths;
        EXPECT_EQ(rotations(*kernels), expected) << lanes;
    }
    if (widths == 0) GTEST_SKIP() << "this processor has no registers wider than four floats";
}

}  // namespace
}  // namespace embody
