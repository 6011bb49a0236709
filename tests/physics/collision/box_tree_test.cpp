// SPDX-License-Identifier: MIT
#include "physics/collision/broad_phase/box_tree.h"

#include <gtest/gtest.h>

#include <bit>

namespace embody::physics::collision {
namespace {

MovingBox box_at(double x) { return MovingBox(FloatBox(Bounds{{x, 0, 0}, {x + 0.5, 1, 1}})); }

// As a hand does that carries a heap of grains about while the simulation stands.
TEST(BoxTree, BoxesPutBackWithoutAQueryTakeNoMoreRoom) {
    constexpr std::uint32_t count = 1000;
    BoxTree tree;
    for (std::uint32_t i = 0; i < count; ++i) tree.insert(i, box_at(i));
    tree.refresh();
    for (int iteration = 1; iteration <= 200; ++iteration) {
        for (std::uint32_t i = 0; i < count; ++i) {
            tree.remove(i);
            tree.insert(i, box_at(i + iteration));
        }
        ASSERT_LT(tree.leaf_count() * BoxNode::lanes, 5 * count) << "round " << iteration;
    }

    // All are there, where they were put last, and count as changed.
    tree.refresh();
    EXPECT_TRUE(tree.are_all_changed());
    std::uint32_t found = 0;
    tree.query(box_at(500), [&](std::uint32_t node, std::uint32_t mask) {
        found += static_cast<std::uint32_t>(std::popcount(mask));
        EXPECT_EQ(tree.value(node, static_cast<std::uint32_t>(std::countr_zero(mask))), 300u);
    });
    EXPECT_EQ(found, 1u);
}

}  // namespace
}  // namespace embody::physics::collision
