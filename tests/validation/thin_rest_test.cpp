// SPDX-License-Identifier: MIT
// Sheets and ropes between bodies and other sheets: no contact makes energy, and what is at rest stays and sleeps.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

double lowest(const World& world, DeformableHandle sheet) {
    double least = 1e9;
    for (const Vec3 node : world.node_positions(sheet)) least = std::min(least, node.y);
    return least;
}

DeformableDefinition towel(double width, double height) {
    auto sheet = cloth_rectangle(width, width, 0.05, {.area_density = 0.3, .rayleigh_damping = 0.02});
    sheet.pose.position = {0, height, 0};
    return sheet;
}

BodyHandle add_box(World& world, Vec3 half, Vec3 position, BodyKind kind, double mass = 1) {
    BodyDefinition box{.kind = kind, .shape = world.create_shape(BoxShape{half}).value(), .position = position};
    box.mass.mass = mass;
    return world.create_body(box).value();
}

// Their ends are held nearer to each other than both radii: nothing can part them there.
TEST(ThinRest, TwoRopesOfOneBallHoldItAsASwing) {
    for (const double apart : {0.0, 0.008}) {
        for (const double mass : {0.5, 1.0, 10.0}) {
            const auto world = make_world({});
            BodyDefinition definition{.kind = BodyKind::dynamic_body,
                                      .shape = world->create_shape(SphereShape{0.05}).value(),
                                      .position = {0, -1.05, 0}};
            definition.mass.mass = mass;
            const BodyHandle ball = world->create_body(definition).value();
            for (const double side : {-0.5, 0.5}) {
                auto rope = rope_between({side, 0, 0}, {side * apart, -1, 0}, 0.05,
                                         {.axial_stiffness = 1e5, .rayleigh_damping = 0.01});
                const auto last = static_cast<std::uint32_t>(rope.nodes.size() - 1);
                rope.pinned = {0};
                rope.contact_radius = 5e-3;
                rope.attachments = {{last, ball, {side * apart, 0.05, 0}}};
                ASSERT_TRUE(world->create_deformable(rope).ok());
            }
            double fastest = 0;
            for (int i = 0; i < 300; ++i) {
                world->step();
                fastest = std::max(fastest, length(world->linear_velocity(ball)));
            }
            EXPECT_LT(fastest, 1) << apart << " " << mass;
            EXPECT_LT(length(world->linear_velocity(ball)), 0.05) << apart << " " << mass;
            EXPECT_NEAR(world->pose(ball).position.y, -1.05, 0.01) << apart << " " << mass;
        }
    }
}

TEST(ThinRest, SheetsThatCollideGainNoEnergyHoweverWeakGravityIs) {
    for (const double g : {1e-6, 1e-4, 1e-3}) {
        for (const double density : {0.2, 20.0}) {
            const auto world = make_world({.gravity = {0, -g, 0}, .air_density = 0, .sleeping = false});
            auto one = cloth_rectangle(0.5, 0.5, 0.06, {.area_density = 0.2});
            auto two = cloth_rectangle(0.4, 0.4, 0.05, {.area_density = density});
            one.pose.position = {0, 0.1, 0};
            one.linear_velocity = {0.3, -2, 0};
            two.pose.position = {0.03, 0, 0.02};
            two.linear_velocity = {0, 0.2, 0.1};
            ASSERT_TRUE(world->create_deformable(one).ok());
            ASSERT_TRUE(world->create_deformable(two).ok());
            const double before = energy(*world);
            for (int i = 0; i < 60; ++i) {
                world->step();
                ASSERT_LT(energy(*world), before * (1 + 1e-4)) << g << " " << density << " step " << i;
            }
        }
    }
}

struct Stack {
    int sheets = 1;
    double radius = 1e-3, mass = 1;
};

TEST(ThinRest, ABoxOnTowelsRestsOnAllOfThemAndSleeps) {
    for (const Stack& stack : {Stack{1, 1e-3, 0.05}, Stack{1, 1e-3, 5}, Stack{2, 1e-3, 5}, Stack{2, 3e-3, 0.5}}) {
        const auto world = make_world({});
        add_plane(*world, friction(0.5));
        std::vector<DeformableHandle> sheets;
        for (int i = 0; i < stack.sheets; ++i) {
            auto sheet = towel(0.6, stack.radius * (1.2 + 2.1 * i));
            sheet.contact_radius = stack.radius;
            sheets.push_back(world->create_deformable(sheet).value());
        }
        const double top = stack.radius * (1.2 + 2.1 * stack.sheets);
        const BodyHandle box =
            add_box(*world, {0.05, 0.05, 0.05}, {0, top + 0.051, 0}, BodyKind::dynamic_body, stack.mass);
        run(*world, 6);
        EXPECT_NEAR(world->pose(box).position.y, 0.05 + 2 * stack.radius * stack.sheets,
                    0.3 * stack.radius * stack.sheets)
            << stack.sheets << " " << stack.mass;
        EXPECT_EQ(world->sleep_state(box), SleepState::asleep) << stack.sheets << " " << stack.mass;
        for (const DeformableHandle sheet : sheets) EXPECT_TRUE(world->is_asleep(sheet)) << stack.sheets;
    }
}

TEST(ThinRest, ARopeThatBreaksWhileItTouchesAnotherLeavesItAlone) {
    const auto world = make_world({});
    auto lower = rope_between({-0.5, 0, 0}, {0.5, 0, 0}, 0.1, {.axial_stiffness = 1e5, .rayleigh_damping = 0.01});
    lower.pinned = {0, static_cast<std::uint32_t>(lower.nodes.size() - 1)};
    lower.contact_radius = 0.01;
    const DeformableHandle stays = world->create_deformable(lower).value();
    auto upper = rope_between({0.05, 0.02, -1.15}, {0.05, 0.02, 0.05}, 0.1,
                              {.linear_density = 0.5, .axial_stiffness = 1e4, .break_tension = 30});
    upper.pinned = {0, static_cast<std::uint32_t>(upper.nodes.size() - 1)};
    upper.contact_radius = 0.01;
    upper.linear_velocity = {0, -1, 0};
    const DeformableHandle breaks = world->create_deformable(upper).value();
    std::size_t events = 0;
    for (int i = 0; i < 120; ++i) {
        world->step();
        events += world->rope_break_events().size();
        for (const DeformableHandle rope : {stays, breaks}) {
            for (const Vec3 node : world->node_positions(rope)) ASSERT_TRUE(is_finite(node)) << i;
        }
    }
    EXPECT_EQ(events, 1u);
    EXPECT_EQ(world->last_report().limits, 0u);
}

TEST(ThinRest, LayersWakeTogetherWhicheverIsOlder) {
    for (const bool is_upper_first : {false, true}) {
        const auto world = make_world({});
        add_plane(*world, friction(0.5));
        const BodyHandle hand = world
                                    ->create_body({.kind = BodyKind::kinematic_body,
                                                   .shape = world->create_shape(SphereShape{0.01}).value(),
                                                   .position = {0.3, 0.5, 0.3}})
                                    .value();
        auto lower = towel(0.6, 0.0012), upper = towel(0.5, 0.0033);
        const auto corner = std::ranges::min_element(upper.nodes, {}, [](Vec3 node) {
            return length(node - Vec3{0.25, 0, 0.25});
        });
        upper.attachments = {{static_cast<std::uint32_t>(corner - upper.nodes.begin()), hand,
                              *corner + Vec3{0, 0.003, 0} - Vec3{0.3, 0.5, 0.3}}};
        const DeformableHandle first = world->create_deformable(is_upper_first ? upper : lower).value();
        const DeformableHandle second = world->create_deformable(is_upper_first ? lower : upper).value();
        run(*world, 8);
        ASSERT_TRUE(world->is_asleep(first) && world->is_asleep(second)) << is_upper_first;
        ASSERT_TRUE(world->set_velocity(hand, {0, 0.01, 0}, {}).ok());
        world->step();
        EXPECT_FALSE(world->is_asleep(first) || world->is_asleep(second)) << is_upper_first;
        run(*world, 0.6);
        EXPECT_GT(lowest(*world, is_upper_first ? first : second), 2.5e-3) << is_upper_first;
    }
}

TEST(ThinRest, ClothFallsWhenItsTableIsTakenAway) {
    for (const bool is_moved : {false, true}) {
        const auto world = make_world({});
        const BodyHandle table = add_box(*world, {0.5, 0.05, 0.5}, {0, 0.95, 0}, BodyKind::static_body);
        const DeformableHandle cloth = world->create_deformable(towel(0.6, 1.002)).value();
        run(*world, 4);
        ASSERT_TRUE(world->is_asleep(cloth));
        if (is_moved) {
            ASSERT_TRUE(world->set_pose(table, {{5, 0, 0}, {}}).ok());
        } else {
            ASSERT_TRUE(world->destroy_body(table).ok());
            add_box(*world, {0.5, 0.05, 0.5}, {5, 0, 0}, BodyKind::static_body);  // in the same slot
        }
        run(*world, 0.5);
        EXPECT_LT(lowest(*world, cloth), 0.5) << is_moved;
    }
}

TEST(ThinRest, ClothGoesWithATableHoweverSlow) {
    for (const double speed : {-0.03, 0.03}) {
        const auto world = make_world({});
        const BodyHandle table = add_box(*world, {0.5, 0.05, 0.5}, {0, 0.95, 0}, BodyKind::kinematic_body);
        const DeformableHandle cloth = world->create_deformable(towel(0.6, 1.002)).value();
        run(*world, 4);
        ASSERT_TRUE(world->is_asleep(cloth));
        ASSERT_TRUE(world->set_velocity(table, {0, speed, 0}, {}).ok());
        run(*world, 2);
        EXPECT_NEAR(lowest(*world, cloth), 1.001 + 2 * speed, 1e-3) << speed;
    }
}

TEST(ThinRest, AHeavySheetLandsOnAnotherAsInStrongGravity) {
    for (const double factor : {1.0, 4.0}) {
        const auto world = make_world({.air_density = 0});
        auto lower = cloth_rectangle(0.5, 0.5, 0.05, {.area_density = 0.3});
        for (std::uint32_t i = 0; i < lower.nodes.size(); ++i) lower.pinned.push_back(i);
        ASSERT_TRUE(world->create_deformable(lower).ok());
        auto upper = cloth_rectangle(0.3, 0.3, 0.05, {.area_density = 0.3});
        upper.pose.position = {0, 0.05, 0};
        upper.gravity_factor = factor;
        const DeformableHandle sheet = world->create_deformable(upper).value();
        run(*world, 2);
        EXPECT_NEAR(lowest(*world, sheet), 2e-3, 5e-4) << factor;
    }
}

TEST(ThinRest, ACopyInTheSamePlaceParts) {
    const auto world = make_world({});
    add_plane(*world, friction(0.5));
    const DeformableHandle one = world->create_deformable(towel(0.4, 0.005)).value();
    const DeformableHandle two = world->create_deformable(towel(0.4, 0.005)).value();
    run(*world, 4);
    const auto x = world->node_positions(one), y = world->node_positions(two);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(length(x[i] - y[i]), 2e-3, 4e-4) << i;
}

TEST(ThinRest, ATwistedRopeStaysBetweenSheets) {
    const auto world = make_world({.sleeping = false});
    const BodyHandle hand = world
                                ->create_body({.kind = BodyKind::kinematic_body,
                                               .shape = world->create_shape(SphereShape{0.01}).value(),
                                               .position = {0.3, 0, 0},
                                               .collision_mask = 0})
                                .value();
    auto rope = rope_between({-0.3, 0, 0}, {0.3, 0, 0}, 0.02,
                             {.linear_density = 0.05,
                              .axial_stiffness = 1e4,
                              .bend_rigidity = 1e-3,
                              .twist_rigidity = 1e-2,
                              .rayleigh_damping = 0.01,
                              .slack = 0.05});
    const auto last = static_cast<std::uint32_t>(rope.nodes.size() - 1);
    rope.pinned = {0};
    rope.attachments = {{last, hand, {}}};
    rope.clamps = {{0, {1, 0, 0}}, {last, {1, 0, 0}}};
    rope.contact_radius = 4e-3;
    rope.material = {.friction_static = 0.3, .friction_dynamic = 0.3};
    const DeformableHandle line = world->create_deformable(rope).value();
    for (const double side : {-1, 1}) {
        auto wall = cloth_rectangle(0.8, 0.8, 0.04, {.area_density = 0.3});
        wall.contact_radius = 1e-3;
        for (std::uint32_t i = 0; i < wall.nodes.size(); ++i) wall.pinned.push_back(i);
        wall.pose.rotation = from_axis_angle({1, 0, 0}, pi / 2);
        wall.pose.position = {0, 0, side * 0.011};
        ASSERT_TRUE(world->create_deformable(wall).ok());
    }
    run(*world, 1);
    ASSERT_TRUE(world->set_velocity(hand, {}, {2, 0, 0}).ok());
    run(*world, 3);
    for (const Vec3 node : world->node_positions(line)) EXPECT_LT(std::fabs(node.z), 0.008);
}

}  // namespace
}  // namespace embody::physics
