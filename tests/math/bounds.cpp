// SPDX-License-Identifier: MIT
#include "math/bounds.h"

#include <gtest/gtest.h>

#include <numbers>

namespace embody {
namespace {

TEST(Bounds, EmptyUntilSomethingIsAdded) {
    Bounds box;
    EXPECT_TRUE(box.is_empty());
    EXPECT_FALSE(overlaps(box, {{-1, -1, -1}, {1, 1, 1}}));
    box.add(Bounds{});
    EXPECT_TRUE(box.is_empty());
    box.add(Vec3{1, 2, 3});
    EXPECT_FALSE(box.is_empty());
    EXPECT_EQ(box.size(), Vec3{});
}

TEST(Bounds, TouchingOverlapsAndApartDoesNot) {
    const Bounds a{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(overlaps(a, {{1, 1, 1}, {2, 2, 2}}));
    for (int axis = 0; axis < 3; ++axis) {
        Bounds b = a;
        b.lower[axis] += 1.001;
        b.upper[axis] += 1.001;
        EXPECT_FALSE(overlaps(a, b));
        EXPECT_TRUE(overlaps(a, enlarged(b, 0.01)));
    }
}

TEST(Bounds, ContainsItsOwnFaceButNothingBeyond) {
    const Bounds a{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(contains(a, a));
    EXPECT_TRUE(contains(a, Vec3{1, 0, 0.5}));
    EXPECT_FALSE(contains(a, Vec3{1.0001, 0, 0.5}));
    EXPECT_FALSE(contains(a, enlarged(a, 1e-9)));
}

TEST(Bounds, TurnedCubeNeedsItsDiagonal) {
    const Transform eighth{{10, 0, 0}, from_axis_angle({0, 1, 0}, std::numbers::pi / 4)};
    const Bounds box = transformed(eighth, {{-1, -1, -1}, {1, 1, 1}});
    EXPECT_NEAR(box.upper.x, 10 + std::numbers::sqrt2, 1e-14);
    EXPECT_NEAR(box.upper.y, 1, 1e-14);
    EXPECT_NEAR(box.lower.z, -std::numbers::sqrt2, 1e-14);
}

}  // namespace
}  // namespace embody
