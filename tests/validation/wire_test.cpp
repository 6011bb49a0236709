// SPDX-License-Identifier: MIT
// Wires: bends that stay (docs/physics/ropes.md, "Wires").
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double length_of_wire = 0.4, segment = 0.02;  // m

Rope steel(double yield) {
    return {.diameter = 0.002,
            .linear_density = 0.025,
            .axial_stiffness = 1e5,
            .bend_rigidity = 0.157,
            .rayleigh_damping = 0.2,
            .bend_yield = yield};
}

DeformableDefinition straight_wire(double yield) {
    return rope_between({0, 0, 0}, {length_of_wire, 0, 0}, segment, steel(yield));
}

/// Nodes on an arc in the x-y plane.
std::vector<Vec3> arc(std::size_t nodes, double curvature) {
    std::vector<Vec3> places{{0, 0, 0}};
    for (std::size_t i = 1; i < nodes; ++i) {
        const double angle = curvature * segment * (static_cast<double>(i) - 0.5);
        places.push_back(places.back() + segment * Vec3{std::cos(angle), std::sin(angle), 0});
    }
    return places;
}

double curvature_at(std::span<const Vec3> places, std::size_t node) {
    const Vec3 before = normalized(places[node] - places[node - 1]),
               after = normalized(places[node + 1] - places[node]);
    return length(after - before) / segment;
}

/// Largest difference of the distance of any two nodes, m.
double change_of_form(std::span<const Vec3> now, std::span<const Vec3> then) {
    double most = 0;
    for (std::size_t i = 0; i < now.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k)
            most = std::max(most, std::fabs(length(now[i] - now[k]) - length(then[i] - then[k])));
    }
    return most;
}

bool set_form(World& world, DeformableHandle wire, const std::vector<Vec3>& places) {
    return world.set_nodes(wire, places, std::vector<Vec3>(places.size())).ok();
}

/// Without a shape: it touches nothing. Inertia as of a ball of 20 cm.
BodyHandle weight_at(World& world, Vec3 place, double mass) {
    return world
        .create_body(
            {.position = place,
             .mass = {.mass = mass, .center_of_mass = Vec3{}, .inertia = 0.4 * mass * 0.1 * 0.1 * Mat3::identity()},
             .allow_sleep = false})
        .value();
}

Vec3 random_vector(embody::Random& random, double most) {
    return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

/// Each fifth node is a corner in a random direction, of 17 to 52 degrees: far beyond a limit of a few 1/m.
std::vector<Vec3> bent_places(embody::Random& random, std::size_t count) {
    std::vector<Vec3> places{{0, 0, 0}};
    Vec3 direction{1, 0, 0};
    for (std::size_t k = 1; k < count; ++k) {
        places.push_back(places.back() + segment * direction);
        if (k % 5 != 0) continue;
        const Vec3 axis = normalized(cross(direction, random_vector(random, 1)), any_perpendicular(direction));
        direction = rotate(from_axis_angle(axis, random.between(0.3, 0.9)), direction);
    }
    return places;
}

/// Straight along x, and from the fifth node on along z.
std::vector<Vec3> hook_places(std::size_t count) {
    std::vector<Vec3> places;
    for (std::size_t k = 0; k < count; ++k) {
        const double number = static_cast<double>(k);
        places.push_back({segment * std::min(number, 5.0), 0, segment * std::max(number - 5, 0.0)});
    }
    return places;
}

// A bend of curvature κ springs back by the yield curvature: to κ - κ_y, and to nothing below it.
TEST(Wire, SpringsBackByWhatItBearsElastically) {
    embody::Random random(1);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        const double yield = random.between(1, 4), bent = random.between(0.5, 3) * yield;
        const DeformableHandle wire = world->create_deformable(straight_wire(yield)).value();
        const std::vector<Vec3> places = arc(world->node_positions(wire).size(), bent);
        ASSERT_TRUE(world->set_nodes(wire, places, std::vector<Vec3>(places.size())).ok());
        run(*world, 3);
        const std::span<const Vec3> now = world->node_positions(wire);
        const double stays = std::max(bent - yield, 0.0);
        for (std::size_t k = 2; k + 2 < now.size(); ++k)
            EXPECT_NEAR(curvature_at(now, k), stays, 0.05 * yield) << i << " node " << k << " bent " << bent / yield;
    }
}

// Bent at random places in random directions it keeps its form where it flies and turns, and gains no energy.
TEST(Wire, ABentWireKeepsItsFormInFlight) {
    embody::Random random(2);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        const DeformableDefinition definition = straight_wire(2);
        const DeformableHandle wire = world->create_deformable(definition).value();
        ASSERT_TRUE(set_form(*world, wire, bent_places(random, definition.nodes.size())));
        run(*world, 1);  // what is too much springs back
        const std::vector<Vec3> form(world->node_positions(wire).begin(), world->node_positions(wire).end());
        EXPECT_GT(change_of_form(form, definition.nodes), 0.01) << i;
        const Vec3 spin = random_vector(random, 6), velocity = random_vector(random, 3);
        const Vec3 center = world->center_of_mass(wire);
        std::vector<Vec3> velocities;
        for (const Vec3 place : form) velocities.push_back(cross(spin, place - center) + velocity);
        ASSERT_TRUE(world->set_nodes(wire, form, velocities).ok());
        const Conserved start = world->conserved();
        const double moving = start.kinetic_energy, first = energy(*world);
        for (int step = 0; step < 120; ++step) {
            world->step();
            EXPECT_LT(energy(*world), first + 0.001 * moving) << i << " step " << step;
        }
        const Conserved end = world->conserved();
        EXPECT_LT(change_of_form(world->node_positions(wire), form), 0.005 * length_of_wire) << i;
        EXPECT_LT(length(end.linear_momentum - start.linear_momentum), 1e-6 * length(start.linear_momentum)) << i;
        EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 1e-6 * length(start.angular_momentum)) << i;
        EXPECT_GT(end.kinetic_energy, 0.95 * moving) << i;
        RecordProperty("form_" + std::to_string(i), std::to_string(change_of_form(world->node_positions(wire), form)));
    }
}

// With next to no damping it swings in itself, and yields: all of that takes energy.
TEST(Wire, SwingsAndYieldsWithoutAGain) {
    embody::Random random(5);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}, .time_step = 1.0 / 240, .air_density = 0});
        Rope rope = steel(random.between(1, 4));
        rope.rayleigh_damping = random.between(0, 0.01);
        const DeformableDefinition definition = rope_between({0, 0, 0}, {length_of_wire, 0, 0}, segment, rope);
        const std::size_t count = definition.nodes.size();
        const DeformableHandle wire = world->create_deformable(definition).value();
        ASSERT_TRUE(set_form(*world, wire, bent_places(random, count)));
        world->step();
        // Also shaken, each node for itself.
        std::vector<Vec3> velocities;
        for (std::size_t k = 0; k < count; ++k) velocities.push_back(random_vector(random, 2));
        const std::vector<Vec3> form(world->node_positions(wire).begin(), world->node_positions(wire).end());
        ASSERT_TRUE(world->set_nodes(wire, form, velocities).ok());
        double last = energy(*world);
        for (int step = 0; step < 240; ++step) {
            world->step();
            const double now = energy(*world);
            EXPECT_LT(now, last + 0.002 * world->conserved().kinetic_energy) << i << " step " << step;
            last = now;
        }
    }
}

// A hook in a wall points sideways: it neither hangs down about its own axis nor straightens.
TEST(Wire, AHookInAWallStaysAsItPoints) {
    const auto world = make_world({.air_density = 0});
    DeformableDefinition definition = straight_wire(3);
    const auto count = static_cast<std::uint32_t>(definition.nodes.size());
    definition.pinned = {0};
    definition.clamps = {{0, {1, 0, 0}}};
    const DeformableHandle wire = world->create_deformable(definition).value();
    const std::vector<Vec3> places = hook_places(count);
    ASSERT_TRUE(set_form(*world, wire, places));
    run(*world, 4);
    const std::span<const Vec3> now = world->node_positions(wire);
    // It has sprung back by the limit at the corner and hangs by its weight.
    EXPECT_GT(now.back().z, 0.9 * places.back().z);
    EXPECT_GT(now.back().y, -0.03);
    for (int step = 0; step < 60; ++step) {
        const Vec3 before = world->node_positions(wire).back();
        world->step();
        EXPECT_LT(length(world->node_positions(wire).back() - before), 1e-4);
    }
}

// A weight at its end bends it: statically determinate, so the moment is the weight times the arm, and at most EI κ_y.
// What is left without the weight is what was beyond the curvature that the moment bears; at the wall, where nothing is
// unloaded as it goes down, beyond κ_y.
TEST(Wire, ACantileverKeepsWhatIsBeyondItsLimit) {
    embody::Random random(3);
    int yielded = 0;
    for (int i = 0; i < 6; ++i) {
        const auto world = make_world({.air_density = 0});
        Rope rope = steel(random.between(1, 3));
        rope.linear_density = 0.0025;  // next to nothing of the weight
        const double most = rope.bend_rigidity * rope.bend_yield,
                     mass = random.between(0.5, 1.2) * most / length_of_wire / gravity;
        DeformableDefinition definition = rope_between({0, 0, 0}, {length_of_wire, 0, 0}, segment, rope);
        definition.pinned = {0};
        definition.clamps = {{0, {1, 0, 0}}};
        const auto tip = static_cast<std::uint32_t>(definition.nodes.size() - 1);
        const BodyHandle ball = weight_at(*world, {length_of_wire, 0, 0}, mass);
        definition.attachments = {{tip, ball, {}}};
        const DeformableHandle wire = world->create_deformable(definition).value();
        run(*world, 12);
        const std::vector<Vec3> loaded(world->node_positions(wire).begin(), world->node_positions(wire).end());
        ASSERT_TRUE(world->destroy_body(ball).ok());
        run(*world, 6);
        const std::span<const Vec3> now = world->node_positions(wire);
        for (std::size_t k = 1; k < tip; ++k) {
            const double moment = mass * gravity * (loaded[tip].x - loaded[k].x);
            const double borne = moment / rope.bend_rigidity;
            EXPECT_LT(borne, 1.05 * rope.bend_yield) << i << " node " << k;
            EXPECT_NEAR(curvature_at(now, k), curvature_at(loaded, k) - borne, 0.05 * rope.bend_yield)
                << i << " node " << k;
        }
        const double root = 2 * length(normalized(loaded[1] - loaded[0]) - Vec3{1, 0, 0}) / segment;
        const double left = 2 * length(normalized(now[1] - now[0]) - Vec3{1, 0, 0}) / segment;
        EXPECT_NEAR(left, std::max(root - rope.bend_yield, 0.0), 0.1 * rope.bend_yield) << i;
        yielded += left > 0.5 * rope.bend_yield ? 1 : 0;
        RecordProperty("root_" + std::to_string(i),
                       std::to_string(root / rope.bend_yield) + " " + std::to_string(left / rope.bend_yield));
    }
    EXPECT_GE(yielded, 2);
    EXPECT_LE(yielded, 5);
}

// A hook on a body turns with it, also about the wire's own axis, and each has the moment of the other.
TEST(Wire, AHookTurnsTheBodyThatItTurnsWith) {
    embody::Random random(4);
    for (int i = 0; i < 4; ++i) {
        const auto world = make_world({.gravity = {}, .time_step = 1.0 / 240, .air_density = 0});
        DeformableDefinition definition = straight_wire(3);
        const auto count = static_cast<std::uint32_t>(definition.nodes.size());
        const BodyHandle ball = weight_at(*world, {}, 1);
        definition.attachments = {{0, ball, {}}};
        definition.clamps = {{0, {1, 0, 0}}};
        const DeformableHandle wire = world->create_deformable(definition).value();
        ASSERT_TRUE(set_form(*world, wire, hook_places(count)));
        run(*world, 1);
        const auto direction = [&] {
            const std::span<const Vec3> now = world->node_positions(wire);
            return rotate(conjugate(world->pose(ball).rotation), normalized(now[count - 1] - now[count - 6]));
        };
        const Vec3 points = direction();
        ASSERT_TRUE(world->set_velocity(ball, {}, random_vector(random, 10)).ok());
        const Conserved start = world->conserved();
        const double first = energy(*world);
        double most = 0;
        for (int step = 0; step < 480; ++step) {
            world->step();
            most = std::max(most, energy(*world));
        }
        const Conserved end = world->conserved();
        EXPECT_LT(most, first + 0.005 * start.kinetic_energy) << i;
        EXPECT_LT(length(direction() - points), 0.1) << i;
        EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 0.05 * length(start.angular_momentum)) << i;
        RecordProperty(
            "momentum_" + std::to_string(i),
            std::to_string(length(end.angular_momentum - start.angular_momentum) / length(start.angular_momentum)));
    }
}

// Bent between two clamps, of which one turns it about itself: it has the twist and comes to rest.
TEST(Wire, BetweenClampsItIsTwistedAndComesToRest) {
    embody::Random random(6);
    for (int i = 0; i < 4; ++i) {
        const auto world = make_world({.air_density = 0});
        DeformableDefinition definition = straight_wire(random.between(1, 4));
        const auto tip = static_cast<std::uint32_t>(definition.nodes.size() - 1);
        const double angle = random.between(0.2, 1);
        const BodyHandle axle =
            world->create_body({.kind = BodyKind::kinematic_body, .position = {length_of_wire, 0, 0}}).value();
        definition.pinned = {0};
        definition.attachments = {{tip, axle, {}}};
        definition.clamps = {{0, {1, 0, 0}}, {tip, {1, 0, 0}}};
        const DeformableHandle wire = world->create_deformable(definition).value();
        run(*world, 0.1);
        ASSERT_TRUE(world->set_velocity(axle, {}, {angle, 0, 0}).ok());
        run(*world, 1);
        ASSERT_TRUE(world->set_velocity(axle, {}, {}).ok());
        run(*world, 4);
        ASSERT_EQ(world->rope_twists(wire).size(), 1u);
        EXPECT_NEAR(world->rope_twists(wire)[0].angle, angle, 0.02) << i;
        const std::vector<Vec3> before(world->node_positions(wire).begin(), world->node_positions(wire).end());
        run(*world, 1);
        EXPECT_LT(change_of_form(world->node_positions(wire), before), 1e-4) << i;
    }
}

// Nothing of it says how it is turned about itself.
TEST(Wire, AStraightWireFliesOn) {
    embody::Random random(7);
    for (int i = 0; i < 20; ++i) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        const Vec3 end = random_vector(random, 1);
        DeformableDefinition definition = rope_between({}, end, random.between(0.01, 0.1), steel(2));
        definition.linear_velocity = {1, 2, 3};
        const DeformableHandle wire = world->create_deformable(definition).value();
        run(*world, 1);
        EXPECT_LT(length(world->center_of_mass(wire) - end / 2 - Vec3{1, 2, 3}), 1e-6) << i;
    }
}

TEST(Wire, IsTakenUpAgainAsItWas) {
    const auto world = make_world({.gravity = {}, .air_density = 0});
    const DeformableHandle wire = world->create_deformable(straight_wire(2)).value();
    const std::vector<Vec3> places = arc(world->node_positions(wire).size(), 6);
    ASSERT_TRUE(world->set_nodes(wire, places, std::vector<Vec3>(places.size())).ok());
    run(*world, 3);
    const std::vector<Vec3> kept(world->node_positions(wire).begin(), world->node_positions(wire).end());
    const auto again = make_world({.gravity = {}, .air_density = 0});
    const DeformableHandle same = again->create_deformable(straight_wire(2)).value();
    ASSERT_TRUE(again->set_nodes(same, kept, std::vector<Vec3>(kept.size())).ok());
    ASSERT_TRUE(again->set_lasting_deformation(same, world->lasting_deformation(wire)).ok());
    run(*again, 2);
    EXPECT_LT(change_of_form(again->node_positions(same), kept), 1e-3);
    LastingDeformation wrong = world->lasting_deformation(wire);
    wrong.bend.pop_back();
    ASSERT_FALSE(again->set_lasting_deformation(same, wrong).ok());
    EXPECT_EQ(again->set_lasting_deformation(same, wrong).error().where, "bend");
}

// Without a limit a wire is a rope to the bit.
TEST(Wire, ARopeHasNoFolds) {
    const auto world = make_world();
    const DeformableHandle rope =
        world->create_deformable(straight_wire(std::numeric_limits<double>::infinity())).value();
    run(*world, 0.5);
    EXPECT_TRUE(world->lasting_deformation(rope).bend.empty());
}

}  // namespace
}  // namespace embody::physics
