// SPDX-License-Identifier: MIT
// Entities of kind granular: filled, poured, changed and removed.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "physics/definitions/grain_material.h"
#include "scene/embody/grain_filling.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"
#include "scene/session/session.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using physics::BoxShape;
using physics::ShapeDefinition;
using samples::make;
using samples::points_of;
using samples::step;

constexpr EntityIndex sand = samples::thing;

/// A floor and a box of sand, 20 × 12 × 20 cm, that stands on it.
Document box_of_sand(double budget = 300) {
    Document document = samples::floor_and_box(0.061);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.1, 0.06, 0.1}}};
    document.entities[1].attributes = {{"kind", to_value(attributes::PhysicalKind::granular)},
                                       {"grain_budget", budget}};
    return document;
}

double min_distance(const std::vector<Vec3>& points) {
    double smallest = 1e300;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, distance(points[i], points[j]));
    return smallest;
}

TEST(GrainFillingRefuses, ShapesThatHoldNone) {
    EXPECT_FALSE(fill_with_grains(physics::PlaneShape{}, 0.01, 100, 1).ok());
    const auto none = fill_with_grains(BoxShape{{0.1, 0.001, 0.1}}, 0.01, 100, 1);
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().where, "simulated_diameter");
    EXPECT_FALSE(fill_with_grains(BoxShape{{100, 100, 100}}, 1e-6, 1'000'000'000, 1).ok());
}

TEST(GrainFillingRefuses, ShapesThatTheBudgetDoesNotFill) {
    const BoxShape box{{0.1, 0.1, 0.1}};
    const auto all = fill_with_grains(box, 0.02, 100'000, 1);
    ASSERT_TRUE(all.ok());
    const std::size_t fitting = all.value().size();
    for (const std::size_t budget : {fitting, fitting * 3 / 4}) {
        const auto some = fill_with_grains(box, 0.02, budget, 1);
        ASSERT_TRUE(some.ok()) << some.error().message();
        EXPECT_EQ(some.value().size(), budget);
    }
    const auto half = fill_with_grains(box, 0.02, fitting / 2, 1);
    ASSERT_FALSE(half.ok());
    EXPECT_EQ(half.error().where, "grain_budget");
    EXPECT_NE(half.error().remedy.find("simulated_diameter"), std::string::npos);
    // Balls have a maximum size, so that 2,000 of them cannot fill a mountain.
    Document mountain = samples::floor_and_box(10'000);
    mountain.entities[1].geometry = ShapeDefinition{BoxShape{{10'000, 10'000, 10'000}}};
    mountain.entities[1].attributes["kind"] = to_value(attributes::PhysicalKind::granular);
    const auto made = Simulation::create(mountain, nullptr);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message().find("grain_budget"), std::string::npos) << made.error().message();
}

TEST(GrainFilling, FillsEachShapeWithoutOverlap) {
    const double d = 0.02;
    physics::CompoundShape compound;
    compound.children.push_back({physics::SphereShape{0.1}, {{0.3, 0, 0}, {}}});
    compound.children.push_back({BoxShape{{0.1, 0.1, 0.1}}, {}});
    const physics::HullShape hull{{{0.1, 0, 0}, {-0.1, 0, 0.1}, {-0.1, 0, -0.1}, {0, 0.3, 0}}};
    const double pi = std::acos(-1.0);
    const std::vector<std::pair<ShapeDefinition, double>> shapes = {
        {BoxShape{{0.15, 0.1, 0.2}}, 8 * 0.15 * 0.1 * 0.2},
        {physics::SphereShape{0.2}, 4 * pi / 3 * 0.008},
        {physics::CylinderShape{0.15, 0.1}, pi * 0.15 * 0.15 * 0.2},
        {physics::CapsuleShape{0.1, 0.1}, pi * 0.01 * 0.2 + 4 * pi / 3 * 0.001},
        {physics::ConeShape{0.2, 0.15}, pi / 3 * 0.04 * 0.3},
        {compound, 4 * pi / 3 * 0.001 + 0.008},
        {hull, 0.002}};
    for (const auto& [shape, volume] : shapes) {
        const auto filled = fill_with_grains(shape, d, 100'000, 7);
        ASSERT_TRUE(filled.ok()) << physics::shape_name(shape) << filled.error().message();
        EXPECT_GE(min_distance(filled.value()), d) << physics::shape_name(shape);
        const double fraction = static_cast<double>(filled.value().size()) * pi / 6 * d * d * d / volume;
        EXPECT_LT(fraction, 0.56) << physics::shape_name(shape);
        EXPECT_GT(fraction, 0.2) << physics::shape_name(shape);  // the rim that is too narrow for a whole ball is empty
        EXPECT_EQ(filled.value(), fill_with_grains(shape, d, 100'000, 7).value());
    }
}

TEST(Grains, AreAsManyAndAsHeavyAsTheAttributesSay) {
    const auto simulation = make(box_of_sand());
    ASSERT_TRUE(simulation);
    const MovingPoints* grains = simulation->points(sand);
    ASSERT_NE(grains, nullptr);
    const std::vector<Vec3> points = points_of(*simulation);
    EXPECT_LE(points.size(), 300u);
    EXPECT_GT(points.size(), 150u);
    for (const Vec3 p : points) {
        EXPECT_LE(std::fabs(p.x), 0.1 - grains->radius() + 1e-12);
        EXPECT_GE(p.y, 0.001 + grains->radius() - 1e-12);
    }
    const double litres = 0.2 * 0.12 * 0.2;
    EXPECT_NEAR(grains->mass(), 2650 * 0.55 * litres, 1e-6);
    const auto set = simulation->attributes(sand);
    ASSERT_TRUE(set.ok());
    EXPECT_NEAR(set.value().number("simulated_diameter", 0), 2 * grains->radius(), 1e-12);
    EXPECT_NE(set.value().find("simulated_diameter")->source.find("stands for"), std::string::npos);
    EXPECT_TRUE(simulation->body(sand).is_null());
}

TEST(Grains, CollapseComeToRestAndSleep) {
    const auto simulation = make(box_of_sand());
    ASSERT_TRUE(simulation);
    const Bounds before = simulation->bounds(sand);
    step(*simulation, 300);
    EXPECT_EQ(simulation->sleep_state(sand), physics::SleepState::asleep);
    const Bounds after = simulation->bounds(sand);
    EXPECT_GT(after.size().x, before.size().x * 1.2);
    EXPECT_LT(after.upper.y, before.upper.y);
    EXPECT_GT(after.lower.y, -0.002);
    EXPECT_EQ(simulation->pose(sand).position, box_of_sand().entities[1].pose.position);
}

TEST(Grains, AreTheSameBitForBitForAnyNumberOfWorkers) {
    std::vector<std::uint64_t> hashes;
    for (const int workers : {1, 2, 3, 8}) {
        Document document = box_of_sand(1500);
        document.settings.workers = workers;
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        step(*simulation, 60);
        hashes.push_back(simulation->world().state_hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(Grains, SmallOnesAreSolvedInFinerSteps) {
    Document document = box_of_sand(2000);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const double diameter = 2 * simulation->points(sand)->radius();
    const int needed = physics::substeps_for_grains(diameter, document.settings);
    EXPECT_GT(needed, document.settings.substeps);
    EXPECT_EQ(simulation->world().settings().substeps, needed);
    document.settings.gravity = {0, -1, 0};
    ASSERT_TRUE(simulation->set_settings(document.settings).ok());
    EXPECT_EQ(simulation->world().settings().gravity.y, -1);
    EXPECT_EQ(simulation->world().settings().substeps, physics::substeps_for_grains(diameter, document.settings));
}

TEST(Grains, ChangeWhileTheyRun) {
    const Document document = box_of_sand();
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 20);

    // Another friction: the same grains at the same places.
    const std::vector<Vec3> before = points_of(*simulation);
    Entity changed = document.entities[1];
    changed.attributes["friction_angle"] = 20.0;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_EQ(points_of(*simulation), before);
    const physics::BodyHandle grain = simulation->hold(sand, before.front()).value();
    EXPECT_LT(simulation->world().body(grain)->material.friction_dynamic, 0.6);

    // Another size: filled again.
    changed.attributes["simulated_diameter"] = 0.04;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_LT(points_of(*simulation).size(), before.size());

    // Another kind and back.
    Entity solid = changed;
    solid.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    ASSERT_TRUE(simulation->update(solid, true).ok());
    EXPECT_EQ(simulation->points(sand), nullptr);
    EXPECT_FALSE(simulation->body(sand).is_null());
    step(*simulation, 5);
    const double height = simulation->pose(sand).position.y;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_NEAR(simulation->points(sand)->center_of_mass().y, height, 0.03);
    step(*simulation, 5);

    ASSERT_TRUE(simulation->remove(sand).ok());
    EXPECT_FALSE(simulation->contains(sand));
    EXPECT_EQ(simulation->world().bodies().size(), 1u);
    step(*simulation, 5);
}

TEST(Grains, RefuseJointsAndWhatDoesNotFit) {
    Document document = box_of_sand();
    document.entities[1].attributes["simulated_diameter"] = 0.5;
    const auto none = Simulation::create(document, nullptr);
    ASSERT_FALSE(none.ok());
    EXPECT_NE(none.error().message().find("simulated_diameter"), std::string::npos) << none.error().message();

    document = box_of_sand();
    SceneJoint joint;
    joint.index = 1;
    joint.entity_b = sand;
    document.joints.push_back(joint);
    EXPECT_FALSE(Simulation::create(document, nullptr).ok());

    // A thing that a joint holds keeps its kind.
    document.entities[1].attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    Entity poured = document.entities[1];
    poured.attributes["kind"] = to_value(attributes::PhysicalKind::granular);
    EXPECT_FALSE(simulation->update(poured, true).ok());
    EXPECT_FALSE(simulation->body(sand).is_null());
    step(*simulation, 5);
}

TEST(Grains, AnswerActionsAsOneThing) {
    const auto simulation = make(box_of_sand());
    ASSERT_TRUE(simulation);
    MovingPoints& grains = const_cast<MovingPoints&>(*simulation->points(sand));
    ASSERT_TRUE(grains.apply_impulse({grains.mass() * 0.5, 0, 0}).ok());
    const physics::Conserved sums = simulation->world().conserved();
    EXPECT_NEAR(sums.linear_momentum.x, grains.mass() * 0.5, 1e-9);
    ASSERT_TRUE(simulation->set_velocity(sand, {0, 1, 0}, {0, 2, 0}).ok());
    EXPECT_NEAR(simulation->world().conserved().linear_momentum.y, grains.mass(), 1e-9);
    EXPECT_LT(length(simulation->world().conserved().linear_momentum - Vec3{0, grains.mass(), 0}), 1e-9);
    ASSERT_TRUE(grains.set_enabled(false).ok());
    EXPECT_EQ(simulation->world().conserved().kinetic_energy, 0);
}

struct OpenSession {
    std::unique_ptr<Session> session;
    nlohmann::json run(const std::string& command, const nlohmann::json& params = nlohmann::json::object()) {
        auto result = session->execute(command, params);
        EXPECT_TRUE(result.ok()) << command << ": " << (result.ok() ? "" : result.error().message());
        return result.ok() ? std::move(result).value() : nlohmann::json();
    }
    std::vector<Vec3> points(EntityIndex entity) {
        std::vector<EntityState> states;
        session->read_states(states);
        std::vector<Vec3> points;
        for (const EntityState& state : states)
            if (state.entity == entity && state.points) state.points->read(points);
        return points;
    }
};

TEST(GrainsInASession, FollowMovesUndoAndReset) {
    OpenSession open{std::move(Session::create(nullptr, {})).value()};
    const nlohmann::json box = {{"name", "Sand"},
                                {"shape", {{"type", "box"}, {"half_extents", {0.1, 0.05, 0.1}}}},
                                {"pose", {{"position", {0, 0.5, 0}}}}};
    const EntityIndex index = open.run("entity.add", {{"entity", box}})["index"];
    EXPECT_TRUE(open.points(index).empty());
    open.run("entity.set_attribute", {{"indices", {index}}, {"name", "grain_budget"}, {"value", 200}});
    open.run("entity.set_attribute", {{"indices", {index}}, {"name", "kind"}, {"value", "granular"}});
    const std::vector<Vec3> filled = open.points(index);
    ASSERT_FALSE(filled.empty());

    open.run("entity.transform", {{"poses", {{{"index", index}, {"position", {1, 0.5, 0}}}}}});
    std::vector<Vec3> moved = open.points(index);
    ASSERT_EQ(moved.size(), filled.size());
    for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_LT(distance(moved[i], filled[i] + Vec3{1, 0, 0}), 1e-9);
    open.run("edit.undo");
    for (std::size_t i = 0; i < filled.size(); ++i) EXPECT_LT(distance(open.points(index)[i], filled[i]), 1e-9);

    open.run("entity.drop_to_floor", {{"indices", {index}}});
    moved = open.points(index);
    EXPECT_NEAR(moved.front().y, filled.front().y - 0.45, 0.01);
    open.run("simulation.step", {{"count", 30}});
    EXPECT_NE(open.points(index), moved);
    open.run("simulation.reset");
    for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_LT(distance(open.points(index)[i], moved[i]), 1e-9);

    open.run("simulation.step", {{"count", 5}});
    open.run("simulation.grab", {{"index", index}, {"point", {0, 0.1, 0}}, {"target", {0, 1, 0}}});
    open.run("simulation.step", {{"count", 5}});
    open.run("simulation.release");
    open.run("entity.remove", {{"indices", {index}}});
    EXPECT_TRUE(open.points(index).empty());
    open.run("edit.undo");
    EXPECT_EQ(open.points(index).size(), filled.size());
}

}  // namespace
}  // namespace embody::scene
