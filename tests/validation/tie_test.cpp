// SPDX-License-Identifier: MIT
// Sheets and ropes that are tied to other sheets, ropes and solids.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

/// A heavy body that nothing but what hangs on it moves: its momentum tells what it carries.
struct Frame {
    BodyHandle body;
    Vec3 place{0, 5, 0};
    double mass = 1e5;

    explicit Frame(World& world) {
        BodyDefinition definition{.kind = BodyKind::dynamic_body,
                                  .shape = world.create_shape(SphereShape{0.01}).value(),
                                  .position = place,
                                  .gravity_factor = 0};
        definition.mass.mass = mass;
        body = world.create_body(definition).value();
    }
    void hold(DeformableDefinition& definition, std::uint32_t node) const {
        definition.attachments.push_back(
            {node, body, transform_point(definition.pose, definition.nodes[node]) - place});
    }
    // Mean force on it over a while, N, downwards.
    double load(World& world, double seconds) const {
        const double before = world.linear_velocity(body).y;
        run(world, seconds);
        return -mass * (world.linear_velocity(body).y - before) / seconds;
    }
};

// Ties all nodes of it that lie within 1 mm of a node of the other.
void tie(DeformableDefinition& definition, const World& world, DeformableHandle other) {
    const auto places = world.node_positions(other);
    for (std::uint32_t i = 0; i < definition.nodes.size(); ++i) {
        for (std::uint32_t k = 0; k < places.size(); ++k) {
            if (length(transform_point(definition.pose, definition.nodes[i]) - places[k]) < 1e-3)
                definition.ties.push_back({i, other, {k, 0, 0}, {1, 0, 0}});
        }
    }
    EXPECT_FALSE(definition.ties.empty());
}

double widest_gap(const World& world, DeformableHandle own) {
    double widest = 0;
    for (const Tie& tie : world.deformable(own)->ties) {
        Vec3 apart = world.node_positions(own)[tie.node];
        for (std::size_t k = 0; k < 3; ++k)
            apart -= tie.weight[k] * world.node_positions(tie.other)[tie.other_nodes[k]];
        widest = std::max(widest, length(apart));
    }
    return widest;
}

DeformableDefinition line(Vec3 from, Vec3 to, double step = 0.05) {
    auto rope = rope_between(from, to, step, {.axial_stiffness = 1e4, .rayleigh_damping = 0.02});
    rope.contact_radius = 4e-3;
    return rope;
}

DeformableDefinition sheet(double width, double height, Vec3 center, double density) {
    auto cloth = cloth_rectangle(width, height, 0.05, {.area_density = density, .rayleigh_damping = 0.02});
    cloth.pose = {center, from_axis_angle({1, 0, 0}, pi / 2)};  // upright
    return cloth;
}

// A rope between two posts with a banner, whose upper edge is tied to it along its whole length.
TEST(Tie, ABannerOnARopeIsCarriedByTheRopesEnds) {
    for (const double density : {0.05, 0.3, 3.0}) {
        const auto world = make_world({.air_density = 0, .sleeping = false});
        const Frame frame(*world);
        auto rope = line({-0.5, 1, 0}, {0.5, 1, 0});
        frame.hold(rope, 0);
        frame.hold(rope, static_cast<std::uint32_t>(rope.nodes.size() - 1));
        const DeformableHandle held = world->create_deformable(rope).value();
        auto banner = sheet(0.6, 0.4, {0, 0.8, 0}, density);
        for (std::uint32_t i = 0; i < banner.nodes.size(); ++i) {
            const Vec3 at = transform_point(banner.pose, banner.nodes[i]);
            if (std::fabs(at.y - 1) > 1e-6) continue;
            const double along = (at.x + 0.5) / 0.05, share = along - std::floor(along);
            const auto node = static_cast<std::uint32_t>(along);
            banner.ties.push_back({i, held, {node, node + 1, 0}, {1 - share, share, 0}});
        }
        ASSERT_GT(banner.ties.size(), 8u);
        const DeformableHandle cloth = world->create_deformable(banner).value();
        run(*world, 5);
        const double weight = gravity * (world->mass(held) + world->mass(cloth));
        EXPECT_NEAR(frame.load(*world, 2) / weight, 1, 0.02) << density;
        EXPECT_LT(widest_gap(*world, cloth), 1e-3) << density;
    }
}

// All rows of a sheet's upper half are drawn onto one line through each other, which no contact may prevent.
TEST(Tie, RowsThatAreTiedToOneLineGatherThere) {
    const auto world = make_world({.air_density = 0});
    auto rope = line({-1, 3, 0}, {1, 3, 0}, 0.1);
    rope.pinned = {0, static_cast<std::uint32_t>(rope.nodes.size() - 1)};
    const DeformableHandle held = world->create_deformable(rope).value();
    auto towel = sheet(0.5, 0.5, {0, 2.75, 0}, 0.3);
    for (std::uint32_t i = 0; i < towel.nodes.size(); ++i) {
        const Vec3 at = transform_point(towel.pose, towel.nodes[i]);
        if (length(at - Vec3{0, 3, 0}) < 0.3) towel.ties.push_back(*world->nearest_tie(i, held, at));
    }
    ASSERT_GT(towel.ties.size(), 50u);
    const DeformableHandle cloth = world->create_deformable(towel).value();
    ASSERT_GT(widest_gap(*world, cloth), 0.25);
    run(*world, 3);
    EXPECT_LT(widest_gap(*world, cloth), 5e-3);
}

// A rope hung from the middle of another, with a ball at its end from a thousandth to a thousand times its mass.
TEST(Tie, ARopeHangsOnARope) {
    for (const double ball_mass : {1e-4, 0.05, 1.0, 70.0}) {
        const auto world = make_world({.air_density = 0, .sleeping = false});
        const Frame frame(*world);
        auto upper = line({-0.5, 1, 0}, {0.5, 1, 0});
        frame.hold(upper, 0);
        frame.hold(upper, static_cast<std::uint32_t>(upper.nodes.size() - 1));
        const DeformableHandle taut = world->create_deformable(upper).value();
        auto lower = line({0, 1, 0}, {0, 0.5, 0});
        tie(lower, *world, taut);
        BodyDefinition ball{.kind = BodyKind::dynamic_body,
                            .shape = world->create_shape(SphereShape{0.03}).value(),
                            .position = {0, 0.5, 0}};
        ball.mass.mass = ball_mass;
        const BodyHandle body = world->create_body(ball).value();
        lower.attachments = {{static_cast<std::uint32_t>(lower.nodes.size() - 1), body, {}}};
        const DeformableHandle rope = world->create_deformable(lower).value();
        const double start = energy(*world), weight = gravity * (world->mass(taut) + world->mass(rope) + ball_mass);
        double highest = start;
        for (int i = 0; i < 360; ++i) {
            world->step();
            highest = std::max(highest, energy(*world));
        }
        EXPECT_LT(highest - start, 1e-4 * weight) << ball_mass;
        EXPECT_NEAR(frame.load(*world, 2) / weight, 1, 0.02) << ball_mass;
        EXPECT_LT(widest_gap(*world, rope), 1e-3) << ball_mass;
    }
}

// It bears less than the ball weighs: it breaks, the ball falls freely with what is left at it, and the tie keeps the
// rest.
TEST(Tie, ATiedRopeBreaksUnderTooMuch) {
    const auto world = make_world({.air_density = 0, .sleeping = false});
    const Frame frame(*world);
    auto upper = line({-0.5, 3, 0}, {0.5, 3, 0});
    frame.hold(upper, 0);
    frame.hold(upper, static_cast<std::uint32_t>(upper.nodes.size() - 1));
    const DeformableHandle taut = world->create_deformable(upper).value();
    auto lower = line({0, 3, 0}, {0, 2.5, 0});
    std::get<Rope>(lower.matter).break_tension = 5;
    tie(lower, *world, taut);
    BodyDefinition ball{.kind = BodyKind::dynamic_body,
                        .shape = world->create_shape(SphereShape{0.03}).value(),
                        .position = {0, 2.5, 0}};
    ball.mass.mass = 1;
    const BodyHandle body = world->create_body(ball).value();
    lower.attachments = {{static_cast<std::uint32_t>(lower.nodes.size() - 1), body, {}}};
    const DeformableHandle rope = world->create_deformable(lower).value();
    const double most = energy(*world) + 1e-3;
    int breaks = 0;
    for (int k = 0; k < 30; ++k) {
        world->step();
        breaks += static_cast<int>(world->rope_break_events().size());
        EXPECT_LT(energy(*world), most) << k;
    }
    ASSERT_GE(breaks, 1);
    const double speed = world->linear_velocity(body).y;
    run(*world, 0.25);
    EXPECT_NEAR(world->linear_velocity(body).y, speed - gravity * 0.25, 0.02 * gravity * 0.25);
    EXPECT_LT(energy(*world), most);
    EXPECT_LT(widest_gap(*world, rope), 1e-3);
}

TEST(Tie, ASheetHangsOnASheet) {
    const auto world = make_world({.air_density = 0, .sleeping = false});
    const Frame frame(*world);
    auto upper = sheet(0.5, 0.3, {0, 1.15, 0}, 0.2);
    for (std::uint32_t i = 0; i < upper.nodes.size(); ++i) {
        if (transform_point(upper.pose, upper.nodes[i]).y > 1.3 - 1e-6) frame.hold(upper, i);
    }
    const DeformableHandle first = world->create_deformable(upper).value();
    auto lower = sheet(0.5, 0.3, {0, 0.85, 0}, 0.6);
    tie(lower, *world, first);
    const DeformableHandle second = world->create_deformable(lower).value();
    run(*world, 4);
    EXPECT_NEAR(frame.load(*world, 2) / (gravity * (world->mass(first) + world->mass(second))), 1, 0.02);
    EXPECT_LT(widest_gap(*world, second), 1e-3);
}

TEST(Tie, KeepsTheMomentum) {
    const auto world = make_world({.gravity = {}, .air_density = 0, .sleeping = false});
    auto cloth = sheet(0.4, 0.4, {0, 0.8, 0}, 0.3);
    cloth.linear_velocity = {0.5, 0, 0.3};
    cloth.angular_velocity = {0, 2, 1};
    const DeformableHandle flag = world->create_deformable(cloth).value();
    auto rope = line({0.2, 1, 0}, {1.2, 1, 0});
    rope.linear_velocity = {0, 1, -0.5};
    tie(rope, *world, flag);
    const DeformableHandle string = world->create_deformable(rope).value();
    const Vec3 before = world->conserved().linear_momentum;
    const double energy_before = energy(*world);
    run(*world, 2);
    EXPECT_LT(length(world->conserved().linear_momentum - before), 1e-6 * length(before));
    EXPECT_LT(energy(*world), energy_before);
    EXPECT_LT(widest_gap(*world, string), 5e-3);
}

// A swing: a rope from both sides of a sheet that carries a load.
TEST(Tie, ASwingSeatCarriesABall) {
    const auto world = make_world({.air_density = 0, .sleeping = false});
    const Frame frame(*world);
    auto cloth = cloth_rectangle(0.4, 0.2, 0.05, {.area_density = 0.5, .stretch_stiffness = 5e3});
    cloth.pose.position = {0, 0.5, 0};
    const DeformableHandle seat = world->create_deformable(cloth).value();
    for (const double x : {-0.2, 0.2}) {
        for (const double z : {-0.1, 0.1}) {
            auto rope = line({x, 0.5, z}, {x, 1.3, z});
            tie(rope, *world, seat);
            frame.hold(rope, static_cast<std::uint32_t>(rope.nodes.size() - 1));
            ASSERT_TRUE(world->create_deformable(rope).ok());
        }
    }
    BodyDefinition ball{.kind = BodyKind::dynamic_body,
                        .shape = world->create_shape(SphereShape{0.06}).value(),
                        .position = {0, 0.57, 0}};
    ball.mass.mass = 5;
    const BodyHandle body = world->create_body(ball).value();
    run(*world, 6);
    double mass = 5;
    for (const DeformableHandle each : world->deformables()) mass += world->mass(each);
    EXPECT_NEAR(frame.load(*world, 2) / (gravity * mass), 1, 0.02);
    EXPECT_GT(world->pose(body).position.y, 0.2) << "it has not fallen through";
}

DeformableDefinition block(double size, double density, double youngs_modulus) {
    SoftSolid matter{.density = density, .youngs_modulus = youngs_modulus, .rayleigh_damping = 0.02};
    DeformableDefinition solid = tetrahedral_brick({size, size, size}, {2, 2, 2}, matter);
    solid.pose.position = {0, 1, 0};
    return solid;
}

// Of foam and of lead, soft and stiff, hung up by the middle of its upper side.
TEST(Tie, ASolidHangsOnARope) {
    for (const double density : {30.0, 1000.0, 10000.0}) {
        for (const double modulus : {3e4, 1e7}) {
            const auto world = make_world({.air_density = 0, .sleeping = false});
            const Frame frame(*world);
            const DeformableHandle solid = world->create_deformable(block(0.15, density, modulus)).value();
            const auto places = world->node_positions(solid);
            const auto top =
                static_cast<std::uint32_t>(std::ranges::min_element(places, {},
                                                                    [](Vec3 p) {
                                                                        return length(p - Vec3{0.075, 1.15, 0.075});
                                                                    }) -
                                           places.begin());
            auto rope = line(places[top], places[top] + Vec3{0, 0.5, 0});
            rope.ties = {{0, solid, {top, 0, 0}, {1, 0, 0}}};
            frame.hold(rope, static_cast<std::uint32_t>(rope.nodes.size() - 1));
            const DeformableHandle string = world->create_deformable(rope).value();
            const double start = energy(*world);
            const double weight = gravity * (world->mass(solid) + world->mass(string));
            double highest = start;
            for (int i = 0; i < 360; ++i) {
                world->step();
                highest = std::max(highest, energy(*world));
            }
            EXPECT_LT(highest - start, 1e-3 * weight) << density << " kg/m3, " << modulus << " Pa";
            EXPECT_NEAR(frame.load(*world, 2) / weight, 1, 0.02) << density << " kg/m3, " << modulus << " Pa";
            EXPECT_LT(widest_gap(*world, string), 2e-3) << density << " kg/m3, " << modulus << " Pa";
        }
    }
}

TEST(Tie, IsUndoneAndGoesWithTheOther) {
    const auto world = make_world({.air_density = 0});
    auto upper = line({-0.5, 1, 0}, {0.5, 1, 0});
    upper.pinned = {0, static_cast<std::uint32_t>(upper.nodes.size() - 1)};
    const DeformableHandle taut = world->create_deformable(upper).value();
    std::vector<DeformableHandle> ropes;
    for (const double x : {-0.25, 0.25}) {
        auto lower = line({x, 1, 0}, {x, 0.5, 0});
        tie(lower, *world, taut);
        lower.collision_mask = 0;  // or it hooks on to the other with its end
        ropes.push_back(world->create_deformable(lower).value());
    }
    run(*world, 1);
    ASSERT_TRUE(world->set_attachments(ropes[0], {}));
    run(*world, 1);
    EXPECT_LT(world->center_of_mass(ropes[0]).y, -3);
    EXPECT_GT(world->center_of_mass(ropes[1]).y, 0.6);
    ASSERT_TRUE(world->destroy_deformable(taut));
    run(*world, 1);
    EXPECT_LT(world->center_of_mass(ropes[1]).y, -3);
    Tie self{0, ropes[1], {1, 0, 0}, {1, 0, 0}};
    EXPECT_FALSE(world->set_attachments(ropes[1], {}, {}, {self}).ok());
    self.other = ropes[0];
    self.other_nodes[0] = 99;
    EXPECT_FALSE(world->set_attachments(ropes[1], {}, {}, {self}).ok());
    self.other_nodes[0] = 1;
    self.weight[0] = 0.5;
    EXPECT_FALSE(world->set_attachments(ropes[1], {}, {}, {self}).ok());
}

TEST(Tie, WhatIsTiedSleepsAndWakesTogether) {
    const auto world = make_world({});
    auto upper = line({-0.5, 1, 0}, {0.5, 1, 0});
    upper.pinned = {0, static_cast<std::uint32_t>(upper.nodes.size() - 1)};
    const DeformableHandle taut = world->create_deformable(upper).value();
    auto lower = line({0, 1, 0}, {0, 0.5, 0});
    tie(lower, *world, taut);
    const DeformableHandle rope = world->create_deformable(lower).value();
    run(*world, 20);
    ASSERT_TRUE(world->is_asleep(taut));
    ASSERT_TRUE(world->is_asleep(rope));
    ASSERT_TRUE(world->wake(rope));
    world->step();
    EXPECT_FALSE(world->is_asleep(taut));
}

TEST(Tie, SameBitsForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 4}) {
        const auto world = make_world({.workers = workers});
        auto rope = line({-0.5, 1, 0}, {0.5, 1, 0});
        rope.pinned = {0};
        const DeformableHandle held = world->create_deformable(rope).value();
        auto banner = cloth_rectangle(1, 1, 0.03, {.area_density = 0.3});  // more than 1,000 nodes
        banner.pose.position = {0, 1, 0.5};
        tie(banner, *world, held);
        ASSERT_TRUE(world->create_deformable(banner).ok());
        run(*world, 0.15);
        hashes.push_back(world->state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace embody::physics
