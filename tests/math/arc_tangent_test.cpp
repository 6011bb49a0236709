// SPDX-License-Identifier: MIT
#include "math/arc_tangent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "foundation/random.h"

namespace embody {
namespace {

TEST(ArcTangent, AgreesWithTheLibrarysAllAround) {
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const double angle = random.between(-std::numbers::pi, std::numbers::pi), size = random.between(1e-9, 1e9);
        const double y = size * std::sin(angle), x = size * std::cos(angle);
        EXPECT_NEAR(arc_tangent(y, x), std::atan2(y, x), 1e-15);
    }
}

TEST(ArcTangent, IsExactOnTheAxes) {
    constexpr double pi = std::numbers::pi;
    EXPECT_EQ(arc_tangent(0, 0), 0);
    EXPECT_EQ(arc_tangent(0, 2), 0);
    EXPECT_EQ(arc_tangent(3, 0), pi / 2);
    EXPECT_EQ(arc_tangent(-3, 0), -pi / 2);
    EXPECT_EQ(arc_tangent(0, -1), pi);
    EXPECT_DOUBLE_EQ(arc_tangent(1, 1), pi / 4);
    EXPECT_NEAR(arc_tangent(1e-200, 1), 1e-200, 1e-215);
}

}  // namespace
}  // namespace embody
