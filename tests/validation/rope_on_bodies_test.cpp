// SPDX-License-Identifier: MIT
// Bodies that hang on ropes, light and heavy, by points far from their middle.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

struct Bridge {
    std::unique_ptr<World> world = make_world({.sleeping = false});
    std::vector<BodyHandle> planks;

    // Planks `below` two ropes of 1.2 kg between fixed ends, which hold them at arms of that length and 0.44 m.
    Bridge(double plank_mass, int count, double below, double slack) {
        const BodyDefinition definition{.kind = BodyKind::dynamic_body,
                                        .shape = world->create_shape(BoxShape{{0.12, 0.02, 0.4}}).value()};
        for (int i = 0; i < count; ++i) {
            BodyDefinition plank = definition;
            plank.mass.mass = plank_mass;
            plank.position = {place(i, count), -below, 0};
            planks.push_back(world->create_body(plank).value());
        }
        for (const double side : {-0.44, 0.44}) {
            auto rope = rope_between(
                {-2, 0, side}, {2, 0, side}, 0.08,
                {.linear_density = 0.3, .axial_stiffness = 1e5, .rayleigh_damping = 0.002, .slack = slack});
            rope.contact_radius = 5e-3;
            const auto last = static_cast<std::uint32_t>(rope.nodes.size() - 1);
            rope.pinned = {0, last};
            for (int i = 0; i < count; ++i) {
                const auto node = static_cast<std::uint32_t>(std::lround((place(i, count) + 2) / 4 * last));
                const Vec3 anchor = rope.nodes[node] - Vec3{place(i, count), -below, 0};
                rope.attachments.push_back({node, planks[static_cast<std::size_t>(i)], anchor});
            }
            EXPECT_TRUE(world->create_deformable(rope).ok());
        }
    }
    static double place(int i, int count) { return -2 + 4.0 * (i + 1) / (count + 1); }
};

TEST(RopeOnBodies, NoMassAndNoArmMakesEnergy) {
    for (const double mass : {0.001, 0.1, 1.0, 1000.0}) {
        for (const double below : {0.0, 0.45}) {
            for (const double slack : {0.0, 0.03}) {
                const Bridge bridge(mass, 3, below, slack);
                const double start = energy(*bridge.world), weight = gravity * (3 * mass + 2 * 1.2);
                double highest = start;
                for (int i = 0; i < 90; ++i) {
                    bridge.world->step();
                    highest = std::max(highest, energy(*bridge.world));
                }
                // What lifting all by a tenth of a millimetre takes.
                EXPECT_LT(highest - start, 1e-4 * weight) << mass << " kg, arm " << below << " m, slack " << slack;
            }
        }
    }
}

// Rope that lies in planks which it is tied to beside: it cannot leave them, and nothing may build up.
TEST(RopeOnBodies, RopeThroughPlanksThatItHoldsMakesNoEnergy) {
    for (const double mass : {0.1, 1.0, 10.0}) {
        Bridge bridge(mass, 6, 0.015, 0.03);
        const double start = energy(*bridge.world), weight = gravity * (6 * mass + 2 * 1.2);
        double highest = start;
        for (int i = 0; i < 120; ++i) {
            bridge.world->step();
            highest = std::max(highest, energy(*bridge.world));
        }
        EXPECT_LT(highest - start, 1e-4 * weight) << mass;
    }
}

}  // namespace
}  // namespace embody::physics
