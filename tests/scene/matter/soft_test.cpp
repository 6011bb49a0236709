// SPDX-License-Identifier: MIT
// Entities of kind soft: made, changed while they move, held, removed.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "attributes/physical_kind.h"
#include "geometry/mass_properties.h"
#include "scene/embody/form_cache.h"
#include "scene/embody/shape_surface.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/matter/soft_nodes.h"
#include "scene/sample_documents.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using nlohmann::json;
using physics::BoxShape;
using physics::ShapeDefinition;
using samples::make;
using samples::points_of;
using samples::step;

constexpr EntityIndex cushion = samples::thing;

/// A floor and a cushion of 40 × 20 × 40 cm, a kilogram, with its middle at this height.
Document a_cushion(double height = 0.5) {
    Document document = samples::floor_and_box(height);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.2, 0.1, 0.2}}};
    document.entities[1].attributes = {{"kind", to_value(attributes::PhysicalKind::soft)},
                                       {"mass", 1.0},
                                       {"youngs_modulus", 2e4},
                                       {"damping_rayleigh", 0.02}};
    return document;
}

TEST(ShapeSurface, EnclosesWhatTheShapeDoes) {
    const double pi = 3.14159265358979;
    const std::pair<ShapeDefinition, double> shapes[] = {
        {BoxShape{{0.1, 0.2, 0.3}}, 8 * 0.006},
        {physics::SphereShape{0.5}, 4 * pi / 3 * 0.125},
        {physics::CylinderShape{0.5, 0.5}, pi * 0.25},
        {physics::CapsuleShape{0.2, 0.3}, pi * 0.04 * 0.6 + 4 * pi / 3 * 0.008},
        {physics::ConeShape{0.5, 0.5}, pi * 0.25 / 3},
        {physics::HullShape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 1.0 / 6}};
    for (const auto& [shape, volume] : shapes) {
        const auto surface = surface_of(shape);
        ASSERT_TRUE(surface) << physics::shape_name(shape) << ": " << surface.error().message();
        EXPECT_NEAR(geometry::integrate_polyhedron(*surface).volume / volume, 1, 0.03) << physics::shape_name(shape);
    }
    physics::CompoundShape two;
    two.children = {{BoxShape{{0.5, 0.5, 0.5}}, {{2, 0, 0}, {}}}, {physics::SphereShape{0.5}, {{-2, 0, 0}, {}}}};
    EXPECT_NEAR(geometry::integrate_polyhedron(surface_of(two).value()).volume, 1 + pi / 6, 0.02);
    EXPECT_FALSE(surface_of(physics::PlaneShape{}));
}

TEST(Soft, WeighsWhatItsMassSaysAndFallsAsAnythingDoes) {
    const auto simulation = make(a_cushion(5));
    ASSERT_TRUE(simulation);
    const MovingPoints* points = simulation->points(cushion);
    ASSERT_TRUE(points);
    EXPECT_TRUE(simulation->body(cushion).is_null());
    EXPECT_NEAR(points->mass(), 1, 1e-9);
    EXPECT_EQ(points->radius(), 0) << "nodes are not drawn themselves";
    EXPECT_GE(as_soft(points)->definition().nodes.size(), 100u);
    step(*simulation, 30);
    EXPECT_NEAR(points->center_of_mass().y, 5 - 9.81 / 8, 1e-3);
    EXPECT_NEAR(simulation->pose(cushion).position.y, 5 - 9.81 / 8, 1e-3) << "its frame goes with it";
    EXPECT_TRUE(simulation->notes().empty());
}

TEST(Soft, LiesOnTheFloorAndCarriesABall) {
    Document document = a_cushion(0.12);
    Entity ball = document.entities[1];
    ball.index = 3;
    ball.name = "Ball";
    ball.geometry = ShapeDefinition{physics::SphereShape{0.08}};
    ball.attributes = {{"mass", 2.0}};
    ball.pose.position = {0, 0.34, 0};
    document.entities.push_back(ball);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 120);
    const Bounds bounds = simulation->bounds(cushion);
    EXPECT_GT(bounds.lower.y, -0.01);
    EXPECT_LT(bounds.lower.y, 0.01);
    const double height = simulation->pose(3).position.y;
    EXPECT_GT(height, 0.15) << "the ball lies on it";
    EXPECT_LT(height, 0.28) << "and sinks in: 20 cm of cushion and a radius of 8 cm";
}

TEST(Soft, KindChangesWhileItMovesAndItGoesOn) {
    Document document = a_cushion(50);
    document.entities[1].linear_velocity = {3, 2, 0};
    document.entities[1].angular_velocity = {0, 1.5, 0};
    document.entities[1].attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    document.entities[1].attributes["angular_damping"] = 0.0;
    document.entities[1].attributes["drag_coefficient"] = 0.0;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const auto expected = [](double t) { return Vec3{3 * t, 50 + 2 * t - 9.81 / 2 * t * t, 0}; };
    const auto turned = [&simulation] {
        const Quat q = simulation->pose(cushion).rotation;
        return 2 * std::atan2(q.y, q.w);
    };
    step(*simulation, 20);
    Entity changed = document.entities[1];
    changed.attributes["kind"] = to_value(attributes::PhysicalKind::soft);
    ASSERT_TRUE(simulation->update(changed, true));
    ASSERT_TRUE(simulation->points(cushion));
    EXPECT_LT(distance(simulation->points(cushion)->center_of_mass(), expected(20.0 / 60)), 1e-3);
    step(*simulation, 20);
    EXPECT_LT(distance(simulation->points(cushion)->center_of_mass(), expected(40.0 / 60)), 5e-3);
    EXPECT_NEAR(turned(), 1.0, 0.02);
    changed.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    ASSERT_TRUE(simulation->update(changed, true));
    EXPECT_FALSE(simulation->points(cushion));
    step(*simulation, 20);
    EXPECT_LT(distance(simulation->pose(cushion).position, expected(1)), 1e-2);
    EXPECT_NEAR(turned(), 1.5, 0.03);
}

TEST(Soft, OtherAttributesTakeEffectWhereItIs) {
    const Document document = a_cushion(0.1);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 40);
    const std::vector<Vec3> before = points_of(*simulation);
    Entity changed = document.entities[1];
    changed.attributes["mass"] = 3.0;
    ASSERT_TRUE(simulation->update(changed, true));
    EXPECT_EQ(points_of(*simulation), before);
    EXPECT_NEAR(simulation->points(cushion)->mass(), 3, 1e-9);
    changed.attributes["mass"] = 1e6;
    EXPECT_FALSE(simulation->update(changed, true)) << "no matter is as dense as that";
    EXPECT_NEAR(simulation->points(cushion)->mass(), 3, 1e-9);
}

TEST(Soft, IsMovedThrownAndStopped) {
    const auto simulation = make(a_cushion(20));
    ASSERT_TRUE(simulation);
    const Transform to{{5, 8, 1}, from_axis_angle({0, 0, 1}, 1)};
    ASSERT_TRUE(simulation->set_pose(cushion, to));
    EXPECT_LT(distance(simulation->pose(cushion).position, to.position), 1e-9);
    ASSERT_TRUE(simulation->set_velocity(cushion, {1, 4, 0}, {}));
    step(*simulation, 6);
    EXPECT_NEAR(simulation->pose(cushion).position.x, 5.1, 1e-3);
    EXPECT_NEAR(*simulation->points(cushion)->drop_distance(100), simulation->bounds(cushion).lower.y, 0.01);
}

TEST(Soft, WhatCannotBeSoftStaysRigidAndSaysWhy) {
    Document document = a_cushion(0.5);
    // Two triangles: a sheet.
    document.entities[1].geometry = ShapeDefinition{
        physics::MeshShape{{{-0.2F, 0, -0.2F}, {0.2F, 0, -0.2F}, {0, 0.01F, 0.2F}, {0, 0.1F, 0}}, {{0, 2, 1}}}};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_FALSE(simulation->points(cushion));
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("Box is simulated as rigid, because its surface encloses nothing"),
              std::string::npos)
        << simulation->notes()[0];
}

TEST(Soft, IsMeshedOnceHoweverOftenTheSceneIsReset) {
    const auto forms = std::make_shared<FormCache>();
    Document document = a_cushion();
    std::vector<Vec3> nodes;
    for (int reset = 0; reset < 3; ++reset) {
        const auto made = Simulation::create(document, nullptr, forms);
        ASSERT_TRUE(made.ok());
        if (reset > 0) {
            EXPECT_EQ(points_of(*made.value()), nodes);
        }
        nodes = points_of(*made.value());
    }
    EXPECT_EQ(forms->made, 1u);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.2, 0.2, 0.2}}};
    ASSERT_TRUE(Simulation::create(document, nullptr, forms).ok());
    EXPECT_EQ(forms->made, 2u);
    EXPECT_EQ(forms->soft_meshes.size(), 2u) << "the one before may come back by undo";
}

TEST(Soft, IsComputedOnAsManyElementsAcrossAsItsResolutionSays) {
    const ShapeDefinition shapes[] = {BoxShape{{0.2, 0.1, 0.2}}, physics::CylinderShape{0.1, 0.2},
                                      physics::CapsuleShape{0.1, 0.1}, physics::SphereShape{0.1},
                                      physics::ConeShape{0.1, 0.1}};
    for (const ShapeDefinition& shape : shapes) {
        SCOPED_TRACE(physics::shape_name(shape));
        Document document = a_cushion();
        document.entities[1].geometry = shape;
        std::size_t before = 0;
        for (const double resolution : {1, 2, 3, 4}) {
            document.entities[1].attributes["soft_resolution"] = resolution;
            const auto simulation = make(document);
            ASSERT_TRUE(simulation && simulation->points(cushion)) << resolution;
            const std::size_t nodes = points_of(*simulation).size();
            EXPECT_GT(nodes, before) << resolution;
            EXPECT_NEAR(simulation->points(cushion)->mass(), 1, 1e-9);
            before = nodes;
        }
    }
    // Across the width of a box there are as many layers of corners and of middles.
    Document document = a_cushion();
    document.entities[1].attributes["soft_resolution"] = 4.0;
    std::set<double> heights;
    for (const Vec3 p : points_of(*make(document))) heights.insert(std::round(1e6 * p.y));
    EXPECT_EQ(heights.size(), 2 * 4 + 1u);
}

TEST(Soft, AResolutionThatTakesTooManyElementsIsRefusedWithARemedy) {
    for (const ShapeDefinition& shape :
         {ShapeDefinition{BoxShape{{1, 0.01, 1}}}, ShapeDefinition{physics::ConeShape{1, 0.02}}}) {
        Document document = a_cushion();
        document.entities[1].geometry = shape;
        document.entities[1].attributes["soft_resolution"] = 12.0;
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        EXPECT_FALSE(simulation->points(cushion));
        ASSERT_EQ(simulation->notes().size(), 1u);
        EXPECT_NE(simulation->notes()[0].find("its soft_resolution of 12 takes"), std::string::npos)
            << simulation->notes()[0];
    }
}

TEST(Soft, AChangeOfItsResolutionMakesItAnewAndIsUndone) {
    Document document = a_cushion();
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const std::vector<Vec3> first = points_of(*simulation);
    document.entities[1].attributes["soft_resolution"] = 4.0;
    ASSERT_TRUE(simulation->update(document.entities[1], true));
    EXPECT_GT(points_of(*simulation).size(), first.size());
    document.entities[1].attributes.erase("soft_resolution");
    ASSERT_TRUE(simulation->update(document.entities[1], true));
    EXPECT_EQ(points_of(*simulation).size(), first.size());
}

TEST(Soft, WhatIsFlatIsComputedCoarselyAndSaysSo) {
    Document document = a_cushion(0.02);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.3, 0.005, 0.3}}};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_TRUE(simulation->points(cushion));
    EXPECT_LT(as_soft(simulation->points(cushion))->definition().nodes.size(), 1000u);
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("5 times as wide as thick"), std::string::npos) << simulation->notes()[0];
    step(*simulation, 60);
    EXPECT_NEAR(simulation->points(cushion)->center_of_mass().y, 0.005, 0.005) << "it lies on the floor";
}

TEST(SoftPins, HoldItInTheWorldAndToOtherThings) {
    Document document = a_cushion(2);
    document.entities[1].pins = {{{0.2, 0.1, 0.2}, 0.05, {}}, {{-0.2, 0.1, 0.2}, 0.0, {}}};
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const auto& held = as_soft(simulation->points(cushion))->definition().pinned;
    ASSERT_GE(held.size(), 2u);
    const std::vector<Vec3> before = points_of(*simulation);
    step(*simulation, 60);
    const std::vector<Vec3> after = points_of(*simulation);
    for (const std::uint32_t node : held) EXPECT_EQ(after[node], before[node]);
    EXPECT_LT(simulation->points(cushion)->center_of_mass().y, 2) << "the rest hangs";
    EXPECT_GT(simulation->points(cushion)->center_of_mass().y, 1);

    // Pinned to the floor, it stays above the floor.
    document.entities[1].pins = {{{0, -0.1, 0}, 0.3, EntityIndex{1}}};
    document.settings.gravity = {0, 5, 0};
    const auto tied = make(document);
    ASSERT_TRUE(tied);
    step(*tied, 60);
    EXPECT_LT(tied->points(cushion)->center_of_mass().y, 2.5);
    document.entities[1].pins[0].to = 77;
    const auto to_nothing = Simulation::create(document, nullptr);
    ASSERT_FALSE(to_nothing.ok());
    EXPECT_NE(to_nothing.error().message().find("pins[0].to"), std::string::npos);
}

TEST(Soft, IsRigidAsLongAsAJointHoldsIt) {
    Document document = a_cushion();
    SceneJoint joint;
    joint.index = 1;
    joint.entity_b = cushion;
    document.joints.push_back(joint);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_FALSE(simulation->points(cushion));
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("a joint"), std::string::npos) << simulation->notes()[0];
    step(*simulation, 5);
    ASSERT_TRUE(simulation->remove_joint(1));
    EXPECT_TRUE(simulation->points(cushion)) << "soft again";
    EXPECT_TRUE(simulation->notes().empty());
    step(*simulation, 5);
    ASSERT_TRUE(simulation->add_joint(joint));
    EXPECT_FALSE(simulation->points(cushion));
    EXPECT_FALSE(simulation->joint(1).is_null());
}

class SoftSession : public samples::LiveSession {
protected:
    SoftSession() { open(a_cushion()); }
};

TEST_F(SoftSession, TellsItsMeshAndIsUndoneAndReset) {
    const json mesh = run("entity.simulation_mesh", {{"index", cushion}})["mesh"];
    ASSERT_TRUE(mesh.is_object());
    std::vector<Vec3> nodes;
    state(cushion).points->read(nodes);
    ASSERT_EQ(mesh["nodes"].size(), 3 * nodes.size());
    EXPECT_EQ(mesh["tetrahedra"].size() % 4, 0u);
    EXPECT_EQ(run("entity.simulation_mesh", {{"index", 1}})["mesh"], nullptr);

    run("simulation.step", {{"count", 20}});
    EXPECT_LT(state(cushion).pose.position.y, 0.5);
    run("entity.set_attribute", {{"indices", {cushion}}, {"name", "kind"}, {"value", "rigid"}});
    EXPECT_EQ(state(cushion).points, nullptr);
    run("edit.undo");
    EXPECT_NE(state(cushion).points, nullptr);
    EXPECT_LT(state(cushion).pose.position.y, 0.5) << "it goes on where it is";
    run("simulation.reset");
    EXPECT_NEAR(state(cushion).pose.position.y, 0.5, 1e-9);
    run("entity.remove", {{"indices", {cushion}}});
    run("edit.undo");
    EXPECT_NE(state(cushion).points, nullptr);
    run("entity.transform", {{"poses", {{{"index", cushion}, {"position", {1, 2, 3}}}}}});
    EXPECT_NEAR(state(cushion).pose.position.x, 1, 1e-9);
}

TEST_F(SoftSession, WhatIsPinnedToAThingThatGoesIsFreeAndUndoPinsItAgain) {
    const json pins = json::array({{{"position", {0, 0, 0}}, {"to", 1}}});
    run("entity.update", {{"index", cushion}, {"entity", {{"pins", pins}}}});
    EXPECT_EQ(session_->document().find(cushion)->pins.size(), 1u);
    run("entity.remove", {{"indices", {1}}});
    EXPECT_TRUE(session_->document().find(cushion)->pins.empty());
    run("edit.undo");
    EXPECT_EQ(session_->document().find(cushion)->pins, (std::vector<Pin>{{{0, 0, 0}, 0.01, EntityIndex{1}}}));
    const json nowhere = json::array({{{"to", 1}}});
    EXPECT_FALSE(session_->execute("entity.update", {{"index", cushion}, {"entity", {{"pins", nowhere}}}}).ok());
    const json saved = document_to_json(session_->document());
    EXPECT_TRUE(document_from_json(saved).ok());
}

TEST_F(SoftSession, AHandTakesItUpAndLetsItFall) {
    run("simulation.play");
    for (int i = 0; i < 60; ++i) session_->step();
    run("simulation.grab", {{"index", cushion}, {"point", {0.1, 0.2, 0.1}}, {"target", {0.1, 1.2, 0.1}}});
    for (int i = 0; i < 120; ++i) session_->step();
    EXPECT_GT(state(cushion).pose.position.y, 0.7);
    run("simulation.release");
    for (int i = 0; i < 60; ++i) session_->step();
    EXPECT_LT(state(cushion).pose.position.y, 0.3);
}

TEST_F(SoftSession, AThingIsPutDownOnIt) {
    run("entity.transform", {{"poses", {{{"index", cushion}, {"position", {0, 0.1, 0}}}}}});
    const json hit = run("scene.pick", {{"origin", {0, 3, 0}}, {"direction", {0, -1, 0}}})["hit"];
    ASSERT_TRUE(hit.is_object());
    EXPECT_EQ(hit["index"], cushion);
    EXPECT_NEAR(hit["position"][1].get<double>(), 0.2, 0.02);
    EXPECT_GT(hit["normal"][1].get<double>(), 0.9);
    const json ball = {{"shape", {{"type", "sphere"}, {"radius", 0.05}}}};
    const EntityIndex index =
        run("entity.add", {{"entity", ball}, {"drop", {{"origin", {0, 3, 0}}, {"direction", {0, -1, 0}}}}})["index"];
    EXPECT_NEAR(state(index).pose.position.y, 0.25, 0.03);
}

}  // namespace
}  // namespace embody::scene
