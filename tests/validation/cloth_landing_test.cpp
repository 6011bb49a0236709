// SPDX-License-Identifier: MIT
// Sheets that land on things with corners, rims and thin walls: nothing is gained, and they come to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

// Thin walls, blocks and balls around one place, which do not move, and a sheet of random weight and mesh above them.
struct Landing {
    std::unique_ptr<World> world = make_world({});
    DeformableHandle sheet;

    explicit Landing(unsigned seed) {
        std::mt19937 random(seed);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        add_plane(*world, {});
        double top = 0;
        const int count = 1 + static_cast<int>(seed % 4);
        for (int i = 0; i < count; ++i) {
            const double height = between(0.1, 0.5);
            const Vec3 half{between(0.01, 0.2), height / 2, between(0.005, 0.05)};
            const ShapeHandle shape = i % 3 == 2 ? world->create_shape(SphereShape{half.y}).value()
                                                 : world->create_shape(BoxShape{half}).value();
            EXPECT_TRUE(world
                            ->create_body({.kind = BodyKind::static_body,
                                           .shape = shape,
                                           .position = {between(-0.2, 0.2), half.y, between(-0.2, 0.2)},
                                           .rotation = from_axis_angle({0, 1, 0}, between(0, std::numbers::pi))})
                            .ok());
            top = std::max(top, height);
        }
        auto cloth = cloth_rectangle(between(0.3, 1), between(0.3, 1), between(0.02, 0.05),
                                     {.area_density = std::exp(between(std::log(0.1), std::log(1.5)))});
        cloth.pose = {
            {0, top + between(0.01, 0.5), 0},
            from_axis_angle(normalized(Vec3{between(-1, 1), 3, between(-1, 1)}), between(0, std::numbers::pi))};
        sheet = world->create_deformable(cloth).value();
    }
};

TEST(ClothLanding, NothingIsGainedWhereASheetLands) {
    double largest = 0;
    for (unsigned seed = 0; seed < 24; ++seed) {
        const Landing scene(seed);
        const double start = energy(*scene.world);
        double lowest = start, gain = 0;
        for (int i = 0; i < 90; ++i) {
            scene.world->step();
            const double now = energy(*scene.world);
            ASSERT_TRUE(std::isfinite(now)) << seed << " " << i;
            gain = std::max(gain, (now - lowest) / start);
            lowest = std::min(lowest, now);
        }
        largest = std::max(largest, gain);
    }
    RecordProperty("largest gain, of the first energy", std::to_string(largest));
    EXPECT_LT(largest, 4e-3);
}

// A chair's back: a wall of 2 cm in nine pieces, and a towel thrown over it.
TEST(ClothLanding, ATowelOverAThinWallComesToRest) {
    const auto world = make_world({});
    add_plane(*world, {});
    CompoundShape wall;
    for (int row = 0; row < 3; ++row) {
        for (int column = -1; column < 2; ++column) {
            wall.children.push_back({BoxShape{{0.075, 0.1, 0.01}}, {{0.15 * column, 0.5 + 0.2 * row, 0}, {}}});
        }
    }
    ASSERT_TRUE(world->create_body({.kind = BodyKind::static_body, .shape = world->create_shape(wall).value()}).ok());
    auto towel = cloth_rectangle(0.7, 1.2, 0.04, {.area_density = 0.4});
    towel.material = friction(0.6);
    towel.pose.position = {0, 1.05, 0.1};
    towel.linear_velocity = {0, 0, -0.5};
    const DeformableHandle sheet = world->create_deformable(towel).value();
    int steps = 0;
    while (steps < 600 && !world->is_asleep(sheet)) {
        world->step();
        ++steps;
    }
    RecordProperty("s until it sleeps", std::to_string(steps / 60.0));
    EXPECT_TRUE(world->is_asleep(sheet));
    // It hangs on the wall, whose top is at 1 m, with both ends above the ground.
    double top = 0;
    for (const Vec3 node : world->node_positions(sheet)) {
        EXPECT_GT(node.y, 0.05);
        top = std::max(top, node.y);
    }
    EXPECT_GT(top, 1);
}

}  // namespace
}  // namespace embody::physics
