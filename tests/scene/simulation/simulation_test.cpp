// SPDX-License-Identifier: MIT
#include "scene/simulation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "attributes/physical_kind.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

std::unique_ptr<Simulation> run(const Document& document, int steps) {
    auto made = Simulation::create(document, nullptr);
    if (!made.ok()) {
        ADD_FAILURE() << made.error().message();
        return nullptr;
    }
    for (int i = 0; i < steps; ++i) made.value()->step();
    return std::move(made).value();
}

Vec3 position(const Simulation& simulation, EntityIndex index) {
    return simulation.world().pose(simulation.body(index)).position;
}

void expect_refused(const Document& document, const std::string& says) {
    const auto made = Simulation::create(document, nullptr);
    ASSERT_FALSE(made.ok()) << says;
    EXPECT_NE(made.error().message().find(says), std::string::npos) << made.error().message();
}

TEST(SimulationRefuses, WhatNoWorldCanHold) {
    Document document = samples::floor_and_box();
    document.entities[1].geometry = ModelReference{"sweethome3d:chair"};
    expect_refused(document, "entity 2 (Box)");
    document = samples::floor_and_box();
    document.entities[1].attributes["mass"] = -1.0;
    expect_refused(document, "attributes.mass");
    document.entities[1].attributes = {{"no_such", 1.0}};
    expect_refused(document, "no_such");
    document = samples::floor_and_box();
    document.entities[1].pose.position.x = std::numeric_limits<double>::quiet_NaN();
    expect_refused(document, "position");
    document = samples::floor_and_box();
    document.entities[1].geometry = physics::ShapeDefinition{physics::SphereShape{-1}};
    expect_refused(document, "radius");
    document = samples::floor_and_box();
    document.settings.time_step = 0;
    expect_refused(document, "settings.time_step");
    document = samples::floor_and_box();
    SceneJoint joint;
    joint.index = 1;
    joint.entity_b = 99;
    document.joints.push_back(joint);
    expect_refused(document, "joint 1: entity_b");
}

TEST(Simulation, LetsABoxFallOnTheFloorAndSleep) {
    const auto simulation = run(samples::floor_and_box(1), 240);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(position(*simulation, 2).y, 0.25, 0.01);
    EXPECT_EQ(simulation->world().sleep_state(simulation->body(2)), physics::SleepState::asleep);
}

TEST(Simulation, TakesMassDensityAndInertiaFromTheAttributes) {
    Document document = samples::floor_and_box();
    Entity& box = document.entities[1];
    const auto mass = [&document] {
        const auto simulation = run(document, 0);
        return simulation ? simulation->world().mass(simulation->body(2)) : 0.0;
    };
    EXPECT_NEAR(mass(), 125, 1e-9);  // 1000 kg/m³ × (0.5 m)³
    box.attributes["density"] = 500.0;
    EXPECT_NEAR(mass(), 62.5, 1e-9);
    box.attributes["mass"] = 3.0;
    EXPECT_NEAR(mass(), 3, 1e-12);
    box.attributes["inertia"] = Mat3::diagonal({1, 2, 2.5});
    box.attributes["center_of_mass"] = Vec3{0.1, 0, 0};
    const auto simulation = run(document, 0);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->world().inertia(simulation->body(2))(1, 1), 2, 1e-12);
    EXPECT_LT(distance(simulation->world().center_of_mass(simulation->body(2)), {0.1, 1, 0}), 1e-12);
}

TEST(Simulation, AttributesOfAPrimitiveAgreeWithTheWorld) {
    const auto simulation = run(samples::floor_and_box(), 0);
    ASSERT_TRUE(simulation);
    const auto set = simulation->attributes(2);
    ASSERT_TRUE(set.ok());
    EXPECT_NEAR(set.value().number("mass", 0), 125, 1e-9);
    EXPECT_NEAR(set.value().number("volume", 0), 0.125, 1e-12);
    ASSERT_NE(set.value().find("inertia"), nullptr);
    const Mat3 inertia = std::get<Mat3>(set.value().find("inertia")->value);
    EXPECT_NEAR(inertia(0, 0), 125.0 / 6 * 0.25, 1e-9);
    EXPECT_EQ(kind_of(simulation->attributes(1).value()), attributes::PhysicalKind::static_body);
}

TEST(Simulation, RepeatsBitForBit) {
    Document document = samples::floor_and_box();
    for (int i = 0; i < 12; ++i)
        samples::add(document, "Ball", physics::SphereShape{0.2}, {0.05 * i, 2.0 + 0.5 * i, 0.03 * i});
    const auto first = run(document, 200);
    const auto second = run(document, 200);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->world().state_hash(), second->world().state_hash());
}

TEST(Simulation, EditsWhileRunning) {
    const auto simulation = run(samples::floor_and_box(1), 10);
    ASSERT_TRUE(simulation);
    Document document = samples::floor_and_box();
    Entity& ball = samples::add(document, "Ball", physics::SphereShape{0.2}, {2, 1, 0});
    ASSERT_TRUE(simulation->add(ball).ok());
    EXPECT_FALSE(simulation->add(ball).ok()) << "twice";
    EXPECT_EQ(simulation->entities().size(), 3u);
    EXPECT_EQ(simulation->entity(simulation->body(ball.index)), ball.index);

    // An update that keeps the motion changes the body where it is.
    const double y = position(*simulation, 2).y;
    Entity box = document.entities[1];
    box.attributes["mass"] = 7.0;
    ASSERT_TRUE(simulation->update(box, true).ok());
    EXPECT_EQ(position(*simulation, 2).y, y);
    EXPECT_NEAR(simulation->world().mass(simulation->body(2)), 7, 1e-12);
    EXPECT_LT(simulation->world().linear_velocity(simulation->body(2)).y, -1);
    box.attributes["mass"] = -7.0;
    EXPECT_FALSE(simulation->update(box, true).ok());
    EXPECT_NEAR(simulation->world().mass(simulation->body(2)), 7, 1e-12);
    ASSERT_TRUE(simulation->update(box, true).ok() == false);

    ASSERT_TRUE(simulation->remove(ball.index).ok());
    EXPECT_FALSE(simulation->remove(ball.index).ok());
    EXPECT_TRUE(simulation->body(ball.index).is_null());
}

TEST(Simulation, JointsHoldAndGoWithTheirEntities) {
    Document document = samples::floor_and_box(3);
    SceneJoint joint;
    joint.index = 4;
    joint.entity_b = 2;
    joint.definition.joint = physics::BallJoint{};
    joint.definition.frame_a.position = {0, 3, 0};
    document.joints.push_back(joint);
    const auto simulation = run(document, 120);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(position(*simulation, 2).y, 3, 0.01);
    EXPECT_FALSE(simulation->joint(4).is_null());
    ASSERT_TRUE(simulation->remove(2).ok());
    EXPECT_TRUE(simulation->joint(4).is_null());
    simulation->step();
}

}  // namespace
}  // namespace embody::scene
