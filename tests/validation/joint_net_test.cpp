// SPDX-License-Identifier: MIT
// Nets of ball joints have closed loops, whose rows are redundant, and where one is taut no motion satisfies them: a
// flat net between fixed corners would need an infinite tension to carry its weight. Whatever the solve makes of it,
// joints without motors add no energy.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "foundation/random.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

enum class Held { corners, rim, upper_row, nowhere };

struct Net {
    const char* name;
    Held held;
    bool is_upright;
};

constexpr double spacing = 0.2, radius = 0.08;  // m

// Balls on a grid of `side` by `side`, each jointed to its neighbours halfway between them.
std::vector<BodyHandle> add_net(World& world, const Net& net, int side) {
    const ShapeHandle ball = world.create_shape(SphereShape{radius}).value();
    const Vec3 along{spacing, 0, 0}, across = net.is_upright ? Vec3{0, -spacing, 0} : Vec3{0, 0, spacing};
    const auto is_held = [&](int i, int j) {
        const bool ends_i = i == 0 || i == side - 1, ends_j = j == 0 || j == side - 1;
        if (net.held == Held::corners) return ends_i && ends_j;
        if (net.held == Held::rim) return ends_i || ends_j;
        return net.held == Held::upper_row && j == 0;
    };
    std::vector<BodyHandle> balls;
    const auto joint = [&](std::size_t a, std::size_t b, Vec3 step) {
        JointDefinition definition{.joint = BallJoint{}, .body_a = balls[a], .body_b = balls[b]};
        definition.frame_a.position = step / 2;
        definition.frame_b.position = -step / 2;
        ASSERT_TRUE(world.create_joint(definition).ok());
    };
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            balls.push_back(world
                                .create_body({.kind = is_held(i, j) ? BodyKind::static_body : BodyKind::dynamic_body,
                                              .shape = ball,
                                              .position = Vec3{0, 5, 0} + along * i + across * j})
                                .value());
            const std::size_t here = balls.size() - 1;
            if (i > 0) joint(here - static_cast<std::size_t>(side), here, along);
            if (j > 0) joint(here - 1, here, across);
        }
    }
    return balls;
}

class RandomNets : public testing::TestWithParam<Net> {};

TEST_P(RandomNets, GainNoEnergy) {
    const Net& net = GetParam();
    for (const int side : {3, 4, 5}) {
        for (const bool is_pushed : {false, true}) {
            SCOPED_TRACE(testing::Message() << side << (is_pushed ? ", one ball pushed" : ""));
            Random random(static_cast<std::uint64_t>(side));
            WorldSettings settings{.air_density = 0, .sleeping = false};
            if (net.held == Held::nowhere) settings.gravity = {};
            const auto world = make_world(settings);
            const std::vector<BodyHandle> balls = add_net(*world, net, side);
            const BodyHandle middle = balls[static_cast<std::size_t>(side / 2 * (side + 1))];
            const auto any = [&] { return random.between(-1, 1); };
            if (is_pushed) {
                const Vec3 velocity{any(), any(), any()}, spin{any(), any(), any()};
                ASSERT_TRUE(world->set_velocity(middle, velocity, spin).ok());
            }
            const double weight = world->mass(middle) * gravity * side * side;
            const double start = energy(*world), rounding = 1e-6 * weight * spacing * side;
            for (int step = 0; step < 12; ++step) {
                world->step();
                ASSERT_LT(energy(*world), start + rounding) << "after step " << step;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, RandomNets,
                         testing::Values(Net{"FlatByItsCorners", Held::corners, false},
                                         Net{"FlatByItsRim", Held::rim, false},
                                         Net{"HangingFromItsUpperRow", Held::upper_row, true},
                                         Net{"FreeInWeightlessness", Held::nowhere, false}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace embody::physics
