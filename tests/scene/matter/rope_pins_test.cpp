// SPDX-License-Identifier: MIT
// Degrees of freedom that pins of ropes hold: directions and twist, at bodies and other ropes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using physics::CapsuleShape;
using physics::CylinderShape;
using physics::ShapeDefinition;

constexpr double pi = 3.14159265358979323846;
constexpr EntityIndex thing = 2, other = 3;

// A floor and a rope of 1 m that hangs from 3 m down, with a disc of 2 kg and 0.1 m at its lower end.
Document disc_on_a_rope(bool clamped) {
    Document document = samples::floor_and_box(3);
    Entity& rope = document.entities[1];
    rope.name = "Wire";
    rope.geometry = ShapeDefinition{CapsuleShape{0.005, 0.5}};
    rope.pose.position = {0, 2.5, 0};
    rope.attributes = {{"kind", to_value(attributes::PhysicalKind::rope)},
                       {"mass", 0.02},
                       {"axial_stiffness", 1e6},
                       {"rope_segments", 20.0},
                       {"bend_rigidity", 0.01}};
    rope.pins = {{{0, 0.5, 0}, 0.0, {}, clamped}, {{0, -0.5, 0}, 0.0, other, clamped}};
    Entity disc = samples::add(document, "Disc", ShapeDefinition{CylinderShape{0.1, 0.02}}, {0, 1.98, 0});
    disc.attributes = {{"kind", to_value(attributes::PhysicalKind::rigid)}, {"mass", 2.0}};
    disc.angular_velocity = {0, 1, 0};
    document.entities.back() = disc;
    return document;
}

TEST(RopePins, DiscOnAClampedRopeIsATorsionPendulum) {
    // T = 2π √(I L / GJ), I = m r²/2.
    Document document = disc_on_a_rope(true);
    ASSERT_EQ(document.entities.back().index, other);
    const double seconds = 1.5;
    document.entities[1].attributes["twist_rigidity"] = 0.01 * 4 * pi * pi / (seconds * seconds);
    const auto read = document_from_json(document_to_json(document));
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(read.value().entities[1].pins, document.entities[1].pins);
    const auto simulation = samples::make(read.value());
    ASSERT_TRUE(simulation);
    const auto rope = simulation->world().deformables().front();
    double crossed = 0, before = 0, period = 0;
    for (int i = 1; i < 240; ++i) {
        simulation->step();
        const auto twists = simulation->world().rope_twists(rope);
        ASSERT_EQ(twists.size(), 1u);
        const double angle = twists[0].angle, time = i / 60.0;
        if (before > 0 && angle <= 0) {
            const double at = time - angle / (angle - before) / 60;
            if (crossed > 0) period = at - crossed;
            crossed = at;
        }
        before = angle;
    }
    EXPECT_NEAR(period, seconds, 0.02 * seconds);
}

TEST(RopePins, DiscOnARopeThatIsNotClampedTurnsOn) {
    const auto simulation = samples::make(disc_on_a_rope(false));
    ASSERT_TRUE(simulation);
    samples::step(*simulation, 120);
    EXPECT_TRUE(simulation->world().rope_twists(simulation->world().deformables().front()).empty());
    const Vec3 ahead = rotate(simulation->pose(other).rotation, {1, 0, 0});
    EXPECT_NEAR(std::atan2(-ahead.z, ahead.x), 2, 0.1) << "1 rad/s for 2 s";
}

TEST(RopePins, WhatIsTwistedWakesWhatHangsOnIt) {
    // It hangs at rest and sleeps; then a motor turns the other end, more slowly than the speed that wakes it.
    Document document = disc_on_a_rope(true);
    document.entities[1].attributes["twist_rigidity"] = 0.5;
    document.entities[1].attributes["damping_rayleigh"] = 0.05;
    document.entities.back().angular_velocity = {};
    Entity motor = samples::add(document, "Motor", ShapeDefinition{CylinderShape{0.02, 0.02}}, {0, 3.02, 0});
    motor.attributes = {{"kinematic", true}};
    document.entities.back() = motor;
    document.entities[1].pins[0].to = motor.index;
    const auto simulation = samples::make(document);
    ASSERT_TRUE(simulation);
    samples::step(*simulation, 600);
    ASSERT_EQ(simulation->sleep_state(other), physics::SleepState::asleep);
    ASSERT_TRUE(simulation->set_velocity(motor.index, {}, {0, 0.5, 0}).ok());
    samples::step(*simulation, 240);
    // Dragged along by half a turn in all: 2 rad.
    const Vec3 ahead = rotate(simulation->pose(other).rotation, {1, 0, 0});
    EXPECT_NEAR(std::atan2(-ahead.z, ahead.x), 2, 0.3);
}

// A slack rope of 2 m that lies along X, low over the floor.
Document slack_rope(double height) {
    Document document = samples::floor_and_box(height);
    Entity& rope = document.entities[1];
    rope.geometry = ShapeDefinition{CapsuleShape{0.01, 1}};
    rope.pose.rotation = from_axis_angle({0, 0, 1}, pi / 2);
    rope.attributes = {{"kind", to_value(attributes::PhysicalKind::rope)}, {"mass", 2.0}, {"slack", 0.3}};
    rope.pins = {{{0, 1, 0}, 0.0, {}}, {{0, -1, 0}, 0.0, {}}};
    return document;
}

std::vector<Vec3> nodes_of(const Simulation& simulation) {
    std::vector<Vec3> nodes;
    simulation.points(thing)->read(nodes);
    return nodes;
}

TEST(SlackRope, BeginsAndStaysAboveTheFloor) {
    const auto simulation = samples::make(slack_rope(0.1));
    ASSERT_TRUE(simulation);
    for (int i = 0; i < 120; ++i) {
        for (const Vec3 node : nodes_of(*simulation)) ASSERT_GT(node.y, 0.005) << "after " << i << " steps";
        simulation->step();
        double fastest = 0;
        for (const Vec3 v : simulation->world().node_velocities(simulation->world().deformables().front()))
            fastest = std::max(fastest, length(v));
        ASSERT_LT(fastest, 3) << "nothing throws it";
    }
}

TEST(SlackRope, KeepsWhatIsPinnedInItsMiddle) {
    Document document = slack_rope(3);
    document.entities[1].pins.push_back({{0, 0.2, 0}, 0.0, {}});
    const auto simulation = samples::make(document);
    ASSERT_TRUE(simulation);
    const std::vector<Vec3> at_first = nodes_of(*simulation);
    const auto middle = std::ranges::min(at_first, {}, [](Vec3 p) { return std::fabs(p.x + 0.2); });
    const auto is_there = [&] {
        double nearest = 1;
        for (const Vec3 node : nodes_of(*simulation)) nearest = std::min(nearest, distance(node, {-0.2, 3, 0}));
        return nearest < 1e-9;
    };
    EXPECT_TRUE(is_there()) << middle.x << ' ' << middle.y;
    samples::step(*simulation, 120);
    EXPECT_TRUE(is_there());
    double low_left = 3, low_right = 3;
    for (const Vec3 node : nodes_of(*simulation))
        (node.x < -0.2 ? low_left : low_right) = std::min(node.x < -0.2 ? low_left : low_right, node.y);
    EXPECT_LT(low_left, 2.9);
    EXPECT_LT(low_right, 2.9);
}

TEST(SlackRope, GoesAroundWhatStandsInItsWay) {
    // A box below it, and made after it.
    Document document = slack_rope(1);
    Entity& box = samples::add(document, "Box", ShapeDefinition{physics::BoxShape{{0.2, 0.45, 0.05}}}, {0, 0.5, 0});
    box.attributes = {{"kind", to_value(attributes::PhysicalKind::static_body)}};
    const auto simulation = samples::make(document);
    ASSERT_TRUE(simulation);
    for (const Vec3 node : nodes_of(*simulation)) {
        const bool is_inside = std::fabs(node.x) < 0.2 && node.y < 0.95 && std::fabs(node.z) < 0.05;
        EXPECT_FALSE(is_inside) << node.x << ' ' << node.y << ' ' << node.z;
    }
}

}  // namespace
}  // namespace embody::scene
