// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "foundation/random.h"
#include "math/transform.h"

namespace embody {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-14;

Vec3 random_vector(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }
Quat random_rotation(Random& random) {
    return normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)});
}

TEST(Vec3, WithoutLengthHasTheFallbackDirection) {
    EXPECT_EQ(normalized(Vec3{}), Vec3{});
    EXPECT_EQ(normalized(Vec3{}, {0, 1, 0}), (Vec3{0, 1, 0}));
    EXPECT_FALSE(is_finite(Vec3{0, std::numeric_limits<double>::quiet_NaN(), 0}));
}

TEST(Vec3, CrossIsRightHanded) { EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1})); }

TEST(Vec3, AnyPerpendicularIsUnitAndPerpendicular) {
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3 n = normalized(random_vector(random));
        EXPECT_NEAR(dot(any_perpendicular(n), n), 0, rounding);
        EXPECT_NEAR(length(any_perpendicular(n)), 1, rounding);
    }
}

TEST(Quat, WithoutDirectionIsTheIdentity) { EXPECT_EQ(normalized(Quat{0, 0, 0, 0}), Quat{}); }

TEST(Quat, QuarterTurnAboutYTakesZToX) {
    EXPECT_LE(distance(rotate(from_axis_angle({0, 1, 0}, pi / 2), {0, 0, 1}), {1, 0, 0}), rounding);
}

TEST(Quat, MatrixAndBackIsTheSameRotation) {
    Random random(2);
    for (int i = 0; i < 200; ++i) {
        // Rotations by half a turn use the other branches of Shepperd's method.
        const Quat q = i % 4 == 0 ? from_axis_angle(normalized(random_vector(random)), pi) : random_rotation(random);
        const Mat3 m = to_matrix(q);
        EXPECT_NEAR(determinant(m), 1, rounding);
        EXPECT_NEAR(std::abs(dot(to_quat(m), q)), 1, rounding);
        const Vec3 v = random_vector(random);
        EXPECT_LE(distance(m * v, rotate(q, v)), rounding);
        EXPECT_LE(distance(rotate_inverse(q, rotate(q, v)), v), rounding);
    }
}

TEST(Quat, FromTwoVectorsTakesOneToTheOther) {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = normalized(random_vector(random));
        const Vec3 b = i == 0 ? -a : i == 1 ? a : normalized(random_vector(random));
        EXPECT_LE(distance(rotate(from_two_vectors(a, b), a), b), 1e-9);
    }
}

TEST(Transform, ProductIsFirstTheSecondThenTheFirst) {
    Random random(4);
    const Transform a{random_vector(random), random_rotation(random)},
        b{random_vector(random), random_rotation(random)};
    const Vec3 p = random_vector(random);
    EXPECT_LE(distance(transform_point(a * b, p), transform_point(a, transform_point(b, p))), rounding);
    EXPECT_LE(distance(transform_point(inverse(a) * a, p), p), rounding);
    EXPECT_LE(distance(inverse_transform_point(a, transform_point(a, p)), p), rounding);
}

}  // namespace
}  // namespace embody
