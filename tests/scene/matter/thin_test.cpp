// SPDX-License-Identifier: MIT
// Entities of kind cloth and rope: made, blown, cut, held, changed while they move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/embody/entity_definitions.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using nlohmann::json;
using physics::BoxShape;
using physics::CapsuleShape;
using physics::ShapeDefinition;
using samples::make;
using samples::points_of;
using samples::step;
using samples::thing;

/// A floor and a cloth of 1 × 1 m that lies level at this height.
Document a_cloth(double height) {
    Document document = samples::floor_and_box(height);
    Entity& cloth = document.entities[1];
    cloth.name = "Cloth";
    cloth.geometry = ShapeDefinition{BoxShape{{0.5, 0.001, 0.5}}};
    cloth.attributes = {{"kind", to_value(PhysicalKind::cloth)}, {"cloth_nodes", 300.0}};
    return document;
}

/// A floor and a rope of 2 m between two ends that it is pinned at, this high; its mass is 2 kg.
Document a_rope(double height, double slack) {
    Document document = samples::floor_and_box(height);
    Entity& rope = document.entities[1];
    rope.name = "Rope";
    rope.geometry = ShapeDefinition{CapsuleShape{0.01, 1}};
    rope.pose.rotation = from_axis_angle({0, 0, 1}, std::acos(-1.0) / 2);
    rope.attributes = {
        {"kind", to_value(PhysicalKind::rope)}, {"mass", 2.0}, {"slack", slack}, {"axial_stiffness", 1e5}};
    rope.pins = {{{0, 1, 0}, 0.0, {}}, {{0, -1, 0}, 0.0, {}}};
    return document;
}

TEST(ClothEntity, WeighsByItsAreaAndFallsAsAnythingDoes) {
    Document document = a_cloth(5);
    document.settings.air_density = 0;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const MovingPoints* points = simulation->points(thing);
    ASSERT_TRUE(points);
    EXPECT_NEAR(points->mass(), 0.2, 1e-9) << "0.2 kg a square metre, whatever its thickness";
    EXPECT_TRUE(simulation->notes().empty());
    const auto set = simulation->attributes(thing);
    ASSERT_TRUE(set);
    EXPECT_NEAR(set->number("thickness", 0), 0.002, 1e-12);
    EXPECT_NEAR(set->number("mass", 0), 0.2, 1e-9);
    step(*simulation, 30);
    // The initial velocity is that of half a step of gravity.
    const double expected = 5 - 9.81 / 8 - 9.81 / 120 / 2;
    EXPECT_NEAR(points->center_of_mass().y, expected, 1e-3);
    EXPECT_NEAR(simulation->pose(thing).position.y, expected, 1e-3);
}

// Terminal speed of a level sheet: ρ/2 C v² = w g.
TEST(ClothEntity, FallsThroughAirAtTheSpeedAtWhichItCarries) {
    Document document = a_cloth(60);
    document.entities[1].attributes["bend_stiffness"] = 1.0;
    document.entities[1].attributes["drag_coefficient"] = 1.5;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 480);  // eight widths on, where the vortices at its hems are old
    const double speed = std::sqrt(2 * 0.2 * 9.81 / (1.2 * 1.5));
    EXPECT_NEAR(simulation->points(thing)->linear_velocity().y, -speed, 0.05 * speed);
}

TEST(ClothEntity, LiesOverABoxAndHangsDownAtItsSides) {
    Document document = a_cloth(0.52);
    Entity table = document.entities[0];
    table.index = 3;
    table.geometry = ShapeDefinition{BoxShape{{0.3, 0.25, 0.3}}};
    table.pose.position = {0, 0.25, 0};
    document.entities.push_back(table);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 240);
    double highest = 0, lowest = 1;
    for (const Vec3 node : points_of(*simulation)) {
        highest = std::max(highest, node.y);
        lowest = std::min(lowest, node.y);
        const bool is_inside = std::fabs(node.x) < 0.29 && std::fabs(node.z) < 0.29;
        if (is_inside) {
            EXPECT_GT(node.y, 0.499);
        }
    }
    EXPECT_LT(highest, 0.53);
    EXPECT_LT(lowest, 0.4);
    EXPECT_GT(lowest, 0.1) << "of what hangs over, 20 cm at the sides and 28 at the corners";
    // A ray from above hits it, and so does one from below, under its edge.
    const auto hit = simulation->cast_ray({0, 3, 0}, {0, -1, 0}, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->entity, thing);
    EXPECT_GT(hit->normal.y, 0.9);
}

TEST(ClothEntity, WindBlowsItAsideAndGustsKeepItAwake) {
    Document document = a_cloth(3);
    Entity& cloth = document.entities[1];
    cloth.pose.rotation = from_axis_angle({1, 0, 0}, std::acos(-1.0) / 2);
    cloth.pins = {{{-0.5, 0, -0.5}, 0.0, {}}, {{0.5, 0, -0.5}, 0.0, {}}};
    document.settings.wind = {0, 0, 4};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const double at_first = simulation->points(thing)->center_of_mass().z;
    step(*simulation, 180);
    EXPECT_GT(simulation->points(thing)->center_of_mass().z, at_first + 0.1);
    const json saved = document_to_json(document);
    EXPECT_EQ(saved["settings"]["wind"], (json{0, 0, 4}));
    document.settings.gustiness = 0.4;
    ASSERT_TRUE(simulation->set_settings(document.settings).ok());
    step(*simulation, 180);
    EXPECT_EQ(simulation->sleep_state(thing), physics::SleepState::active);
}

TEST(ClothEntity, WhatIsThickStaysRigidAndSaysWhy) {
    Document document = a_cloth(0.5);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.2, 0.2, 0.2}}};
    auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_FALSE(simulation->points(thing));
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("because it is no sheet: it is 0.4 m thick"), std::string::npos)
        << simulation->notes()[0];
    document.entities[1].attributes["kind"] = to_value(PhysicalKind::rope);
    simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("no rope"), std::string::npos) << simulation->notes()[0];
}

// A box this thick is no sheet; its mass is that of cloth of its face, not of 64 litres of something solid.
TEST(ClothEntity, WhatStaysRigidWeighsByItsAreaOrLengthAllTheSame) {
    Document document = a_cloth(0.5);
    Entity& entity = document.entities[1];
    entity.geometry = ShapeDefinition{BoxShape{{0.2, 0.2, 0.2}}};
    entity.attributes["area_density"] = 0.3;
    auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->world().mass(simulation->body(thing)), 0.3 * 0.16, 1e-9);
    EXPECT_NEAR(simulation->attributes(thing)->number("mass", 0), 0.3 * 0.16, 1e-9);
    entity.attributes = {{"kind", to_value(PhysicalKind::rope)}, {"linear_density", 0.5}};
    simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->world().mass(simulation->body(thing)), 0.5 * 0.4, 1e-9);

    // A sheet that a joint holds.
    Document held = a_cloth(0.5);
    SceneJoint joint;
    joint.index = 1;
    joint.entity_b = thing;
    held.joints.push_back(joint);
    simulation = make(held);
    ASSERT_TRUE(simulation);
    ASSERT_FALSE(simulation->points(thing));
    EXPECT_NEAR(simulation->world().mass(simulation->body(thing)), 0.2, 1e-9);
}

TEST(ClothEntity, OfEveryShapeTheAttributesAreNumbers) {
    for (const Entity& primitive : samples::everything().entities) {
        const auto* shape = std::get_if<ShapeDefinition>(&primitive.geometry);
        if (!shape) continue;
        for (const PhysicalKind kind : {PhysicalKind::cloth, PhysicalKind::rope, PhysicalKind::soft,
                                        PhysicalKind::granular, PhysicalKind::fluid, PhysicalKind::rigid}) {
            Entity entity;
            entity.geometry = *shape;
            entity.attributes["kind"] = to_value(kind);
            const auto set = EntityDefinitions(nullptr).attributes.acting(entity);
            ASSERT_TRUE(set) << to_text(kind);
            for (const attributes::AttributeEntry& entry : set->entries()) {
                const auto* number = std::get_if<double>(&entry.value);
                EXPECT_FALSE(number && std::isnan(*number))
                    << to_text(kind) << " " << physics::shape_name(*shape) << ": " << entry.name;
            }
        }
    }
    // The mass of triangles is by the face of their box.
    Entity sheet;
    sheet.geometry =
        ShapeDefinition{physics::MeshShape{{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}}, {{0, 2, 1}, {0, 3, 2}}}};
    sheet.attributes["kind"] = to_value(PhysicalKind::cloth);
    EXPECT_NEAR(EntityDefinitions(nullptr).attributes.acting(sheet)->number("mass", 0), 0.4, 1e-9);
}

TEST(ClothEntity, KindChangesWhileItMovesInAllDirections) {
    Document document = a_cloth(5);
    document.settings.air_density = 0;
    document.entities[1].attributes["kind"] = to_value(PhysicalKind::rigid);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    double time = 0;
    for (const PhysicalKind kind :
         {PhysicalKind::cloth, PhysicalKind::soft, PhysicalKind::cloth, PhysicalKind::rope, PhysicalKind::cloth,
          PhysicalKind::static_body, PhysicalKind::cloth, PhysicalKind::rigid}) {
        Entity changed = document.entities[1];
        changed.attributes["kind"] = to_value(kind);
        const auto updated = simulation->update(changed, true);
        ASSERT_TRUE(updated) << to_text(kind) << ": " << updated.error().message();
        // It is too thin to be soft and no rope: then it is rigid, with a note.
        const bool has_points = simulation->points(thing) != nullptr;
        if (kind == PhysicalKind::cloth) {
            EXPECT_TRUE(has_points);
        }
        if (kind == PhysicalKind::static_body || kind == PhysicalKind::rigid) {
            EXPECT_FALSE(has_points);
        }
        step(*simulation, 3);
        time += 0.05;
    }
    // Two thousand grains with its thickness as diameter do not fill it.
    Entity grains = document.entities[1];
    grains.attributes["kind"] = to_value(PhysicalKind::granular);
    const auto refused = simulation->update(grains, true);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message().find("grain_budget"), std::string::npos) << refused.error().message();
    EXPECT_LT(simulation->pose(thing).position.y, 5);
    EXPECT_GT(simulation->pose(thing).position.y, 5 - 9.81 / 2 * time * time - 0.1);
}

// Sag f of a rope that is longer than its span d by a small fraction s: s = 8/3 (f/d)².
TEST(RopeEntity, HangsAsDeepAsItsSlackSays) {
    const auto simulation = make(a_rope(3, 0.1));
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->points(thing)->mass(), 2, 1e-9);
    const auto lowest = [&] {
        double low = 10;
        for (const Vec3 node : points_of(*simulation)) low = std::min(low, node.y);
        return low;
    };
    const double sag = 2 * std::sqrt(0.1 * 3 / 8);
    EXPECT_NEAR(lowest(), 3 - sag, 0.05) << "as it begins";
    step(*simulation, 300);
    EXPECT_NEAR(lowest(), 3 - sag, 0.05) << "as it stays";

    // Each end carries half of its weight upwards, and w d²/8f along.
    const auto handle = simulation->world().deformables().front();
    const auto tensions = simulation->world().rope_tensions(handle);
    const double along = 2 * 9.81 / 2.2 * 4 / (8 * sag);
    EXPECT_NEAR(tensions.front(), std::hypot(9.81, along), 0.5);
    EXPECT_NEAR(*std::ranges::min_element(tensions), along, 0.5);
    Entity tighter = a_rope(3, 0.02).entities[1];
    ASSERT_TRUE(simulation->update(tighter, true));
    step(*simulation, 300);
    EXPECT_NEAR(lowest(), 3 - 2 * std::sqrt(0.02 * 3 / 8), 0.05) << "wound in while it hangs";
}

TEST(RopeEntity, IsHitByRaysAndFallingBodies) {
    Document document = a_rope(2, 0);
    Entity ball = document.entities[1];
    ball.index = 3;
    ball.name = "Ball";
    ball.geometry = ShapeDefinition{physics::SphereShape{0.1}};
    ball.attributes = {{"mass", 1.0}};
    ball.pins.clear();
    ball.pose = {{0, 2.4, 0}, {}};
    document.entities.push_back(ball);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const auto hit = simulation->cast_ray({0.5, 3, 0.002}, {0, -1, 0}, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->entity, thing);
    EXPECT_NEAR(hit->position.y, 2.01, 1e-3);
    EXPECT_NEAR(simulation->points(3) ? 0 : *simulation->drop_distance(thing, 10), 1.99, 0.01);
    double lowest = 3;
    for (int i = 0; i < 40; ++i) {
        simulation->step();
        for (const Vec3 node : points_of(*simulation)) lowest = std::min(lowest, node.y);
    }
    EXPECT_LT(lowest, 1.97) << "the ball hits the rope in its middle";
}

using ThinSession = samples::LiveSession;

TEST_F(ThinSession, ABrokenRopeIsToldOnceAndReset) {
    Document document = a_rope(3, 0.1);
    document.entities[1].attributes["break_tension"] = 12.0;  // its ends carry 15 N
    open(document);
    (void)session_->take_events();
    run("simulation.step", {{"count", 30}});
    std::vector<json> broke;
    bool is_said = false;
    for (const json& event : session_->take_events().messages) {
        if (event["event"] == "rope_broke") broke.push_back(event);
        if (event["event"] == "message")
            is_said = is_said || event["text"].get<std::string>().find("Rope broke at a tension of") == 0;
    }
    ASSERT_GE(broke.size(), 1u);
    EXPECT_EQ(broke[0]["index"], thing);
    EXPECT_GT(broke[0]["tension"], 12.0);
    EXPECT_TRUE(is_said);
    const json mesh = run("entity.simulation_mesh", {{"index", thing}})["mesh"];
    EXPECT_EQ(mesh["broken"].size(), broke.size());
    EXPECT_EQ(mesh["nodes"].size(), 3u * 51);
    run("simulation.reset");
    EXPECT_TRUE(run("entity.simulation_mesh", {{"index", thing}})["mesh"]["broken"].empty());
}

TEST_F(ThinSession, ClothTellsItsMeshIsUndoneSavedAndTakenUp) {
    open(a_cloth(1));
    const json mesh = run("entity.simulation_mesh", {{"index", thing}})["mesh"];
    ASSERT_TRUE(mesh.is_object());
    EXPECT_EQ(mesh["triangles"].size() % 3, 0u);
    EXPECT_FALSE(mesh.contains("tetrahedra"));
    run("entity.set_attribute", {{"indices", {thing}}, {"name", "cloth_nodes"}, {"value", 100}});
    EXPECT_LT(run("entity.simulation_mesh", {{"index", thing}})["mesh"]["nodes"].size(), mesh["nodes"].size());
    run("edit.undo");
    EXPECT_EQ(run("entity.simulation_mesh", {{"index", thing}})["mesh"], mesh);
    run("scene.settings", {{"wind", {1, 0, 0}}, {"gustiness", 0.2}});
    EXPECT_EQ(session_->document().settings.wind, (Vec3{1, 0, 0}));
    run("edit.undo");
    EXPECT_EQ(session_->document().settings.wind, Vec3{});
    EXPECT_FALSE(session_->execute("scene.settings", {{"gustiness", -1}}).ok());
    EXPECT_TRUE(document_from_json(document_to_json(session_->document())).ok());

    run("simulation.play");
    for (int i = 0; i < 90; ++i) session_->step();
    run("simulation.grab", {{"index", thing}, {"point", {0.4, 0, 0.4}}, {"target", {0.4, 1.5, 0.4}}});
    for (int i = 0; i < 120; ++i) session_->step();
    std::vector<Vec3> nodes;
    state(thing).points->read(nodes);
    const double highest = std::ranges::max(nodes, {}, [](Vec3 node) { return node.y; }).y;
    EXPECT_GT(highest, 1.0) << "the hand has a corner of it";
    run("simulation.release");
    for (int i = 0; i < 120; ++i) session_->step();
    state(thing).points->read(nodes);
    EXPECT_LT(std::ranges::max(nodes, {}, [](Vec3 node) { return node.y; }).y, 0.3);
}

}  // namespace
}  // namespace embody::scene
