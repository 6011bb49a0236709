// SPDX-License-Identifier: MIT
// Sheets of any stiffness that a definition may have hang and fall as those do that cannot stretch
// (docs/physics/cloth.md, "Elasticity").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// A square metre that hangs by two corners, which falls from level.
TEST(StiffCloth, IsTameHoweverStiff) {
    double most = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        Random random(seed);
        const auto scaled = [&](double low, double high) { return low * std::pow(high / low, random.unit()); };
        const auto world = make_world({});
        const double stretch = scaled(1e6, 1e9);
        DeformableDefinition sheet = cloth_rectangle(1, 1, random.between(0.03, 0.1),
                                                     {.area_density = scaled(0.05, 5),
                                                      .stretch_stiffness = stretch,
                                                      .shear_stiffness = stretch * scaled(0.01, 1),
                                                      .rayleigh_damping = random.between(0, 0.02)});
        for (std::uint32_t i = 0; i < sheet.nodes.size(); ++i) {
            const Vec3 node = sheet.nodes[i];
            if (std::fabs(node.x) > 0.499 && node.z < -0.499) sheet.pinned.push_back(i);
        }
        ASSERT_EQ(sheet.pinned.size(), 2u);
        sheet.pose.position = {0, 2, 0};
        const DeformableHandle handle = world->create_deformable(sheet).value();
        const double first = energy(*world);
        double highest = first;
        for (int step = 0; step < 180; ++step) {
            world->step();
            highest = std::max(highest, energy(*world));
            ASSERT_EQ(world->last_report().limits, 0u) << seed << " at step " << step;
        }
        // A substep of what cannot stretch is too coarse for its wrinkles.
        EXPECT_LT(highest, 1.2 * first) << seed;
        most = std::max(most, highest / first - 1);
        // The farthest corner is a diagonal away from a pin at most.
        double lowest = 2;
        for (const Vec3 node : world->node_positions(handle)) lowest = std::min(lowest, node.y);
        EXPECT_GT(lowest, 2 - 1.005 * std::sqrt(2.0)) << seed;
        EXPECT_LT(lowest, 1.1) << seed;
    }
    RecordProperty("largest gain, of the first energy", std::to_string(most));
}

}  // namespace
}  // namespace embody::physics
