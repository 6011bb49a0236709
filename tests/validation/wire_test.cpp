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

// A bend of curvature κ springs back by the yield curvature: to κ - κ_y, and to nothing below it.
TEST(Wire, SpringsBackByWhatItBearsElastically) {
    Random random(1);
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

// Bent at random places in random directions it keeps its form where it flies and turns.
TEST(Wire, ABentWireKeepsItsFormInFlight) {
    Random random(2);
    for (int i = 0; i < 8; ++i) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        DeformableDefinition definition = straight_wire(2);
        const std::size_t count = definition.nodes.size();
        definition.linear_velocity = {random.between(-3, 3), random.between(-3, 3), random.between(-3, 3)};
        const DeformableHandle wire = world->create_deformable(definition).value();
        std::vector<Vec3> places{{0, 0, 0}};
        Vec3 direction{1, 0, 0};
        for (std::size_t k = 1; k < count; ++k) {
            places.push_back(places.back() + segment * direction);
            if (k % 5 != 0) continue;
            direction = normalized(
                direction + Vec3{random.between(-0.6, 0.6), random.between(-0.6, 0.6), random.between(-0.6, 0.6)});
        }
        ASSERT_TRUE(world->set_nodes(wire, places, std::vector<Vec3>(count)).ok());
        run(*world, 1);  // what is too much springs back
        const std::vector<Vec3> form(world->node_positions(wire).begin(), world->node_positions(wire).end());
        EXPECT_GT(change_of_form(form, definition.nodes), 0.01) << i;
        const Vec3 spin{random.between(-6, 6), random.between(-6, 6), random.between(-6, 6)};
        const Vec3 center = world->center_of_mass(wire);
        std::vector<Vec3> velocities;
        for (const Vec3 place : form) velocities.push_back(cross(spin, place - center) + Vec3{1, 0, 0});
        ASSERT_TRUE(world->set_nodes(wire, form, velocities).ok());
        const Conserved start = world->conserved();
        const double first = energy(*world);
        for (int step = 0; step < 120; ++step) {
            world->step();
            EXPECT_LT(energy(*world), first + 0.01 * start.kinetic_energy) << i << " step " << step;
        }
        const Conserved end = world->conserved();
        EXPECT_LT(change_of_form(world->node_positions(wire), form), 0.02 * length_of_wire) << i;
        EXPECT_LT(length(end.linear_momentum - start.linear_momentum), 1e-6 * length(start.linear_momentum)) << i;
        EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 1e-6 * length(start.angular_momentum)) << i;
        EXPECT_GT(end.kinetic_energy, 0.8 * start.kinetic_energy) << i;
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
    std::vector<Vec3> places;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double along = segment * std::min<double>(k, 5), beside = segment * std::max<double>(k - 5.0, 0);
        places.push_back({along, 0, beside});
    }
    LastingDeformation lasting;
    lasting.bend.assign(count, {});
    // The clamp's second vector and the wire's direction at the corner tell the parts; the largest of any turn.
    ASSERT_TRUE(world->set_nodes(wire, places, std::vector<Vec3>(count)).ok());
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

// A load beyond the moment that the wire bears at the wall bends it there for good.
TEST(Wire, ACantileverBendsAtItsWallBeyondItsLimit) {
    const Rope rope = steel(2);
    const double most = rope.bend_rigidity * rope.bend_yield / length_of_wire;  // N at the tip: EI κ_y / L
    for (const double load : {0.5 * most, 1.5 * most}) {
        const auto world = make_world({.gravity = {}, .air_density = 0});
        DeformableDefinition definition = straight_wire(2);
        definition.pinned = {0};
        definition.clamps = {{0, {1, 0, 0}}};
        const auto tip = static_cast<std::uint32_t>(definition.nodes.size() - 1);
        const DeformableHandle wire = world->create_deformable(definition).value();
        for (int step = 0; step < 120; ++step) {
            // A force for one second, as velocity that it gives the tip.
            std::vector<Vec3> places(world->node_positions(wire).begin(), world->node_positions(wire).end());
            std::vector<Vec3> velocities(world->node_velocities(wire).begin(), world->node_velocities(wire).end());
            if (step < 60) velocities[tip].y -= load / 60 / (rope.linear_density * segment / 2);
            ASSERT_TRUE(world->set_nodes(wire, places, velocities).ok());
            world->step();
        }
        run(*world, 2);
        const double left = -world->node_positions(wire)[tip].y;
        if (load < most)
            EXPECT_LT(left, 0.002);
        else
            EXPECT_GT(left, 0.02);
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
