// SPDX-License-Identifier: MIT
#include "math/mat3.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "foundation/random.h"

namespace embody {
namespace {

void expect_near(const Mat3& a, const Mat3& b, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_LE(distance(a.column(i), b.column(i)), tolerance);
}
void expect_decomposes(const Mat3& m) {
    const SymmetricEigen e = eigen_symmetric(m);
    const double size = std::max({1e-300, std::abs(e.values.x), std::abs(e.values.y), std::abs(e.values.z)});
    EXPECT_LE(e.values.x, e.values.y);
    EXPECT_LE(e.values.y, e.values.z);
    EXPECT_NEAR(determinant(e.vectors), 1, 1e-13);
    expect_near(transpose(e.vectors) * e.vectors, Mat3::identity(), 1e-13);
    expect_near(e.vectors * Mat3::diagonal(e.values) * transpose(e.vectors), m, 1e-13 * size);
}

TEST(Mat3, SingularHasZeroInverse) {
    EXPECT_EQ(inverse_or_zero(Mat3::zero()), Mat3::zero());
    EXPECT_EQ(inverse_or_zero(Mat3{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}), Mat3::zero());
    EXPECT_EQ(solve(Mat3::zero(), {1, 2, 3}), Vec3{});
}

TEST(Mat3, InverseSkewAndOuterDoWhatTheySay) {
    const Mat3 m{{2, 1, 0}, {0, 3, -1}, {1, 0, 4}};
    expect_near(m * inverse_or_zero(m), Mat3::identity(), 1e-15);
    const Vec3 a{1, -2, 3}, b{4, 5, -6}, c{0.5, 7, 2};
    EXPECT_EQ(skew(a) * b, cross(a, b));
    EXPECT_EQ(outer(a, b) * c, a * dot(b, c));
    EXPECT_EQ(m(0, 1), 0);
    EXPECT_EQ(m(2, 1), -1);
}

TEST(EigenSymmetric, DegenerateMatrices) {
    expect_decomposes(Mat3::zero());
    expect_decomposes(Mat3::identity());
    expect_decomposes(Mat3::diagonal({3, 1, 2}));
    expect_decomposes(outer({1, 2, 3}, {1, 2, 3}));
    expect_decomposes(1e-20 * outer({1, 2, 3}, {1, 2, 3}));
}

TEST(EigenSymmetric, RandomMatricesOfAllScales) {
    Random random(9);
    for (int i = 0; i < 500; ++i) {
        Mat3 m;
        const double scale = std::pow(10, random.between(-12, 12));
        for (int r = 0; r < 3; ++r) {
            for (int c = r; c < 3; ++c) m(r, c) = m(c, r) = scale * random.between(-1, 1);
        }
        expect_decomposes(m);
    }
}

}  // namespace
}  // namespace embody
