// SPDX-License-Identifier: MIT
// Entities of kind fluid: they fill, flow, carry floating bodies, mix, are changed and removed.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/matter/fluid_filling.h"
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

using Words = std::map<std::string, attributes::AttributeValue>;

Entity& add_box(Document& document, const std::string& name, Vec3 half, Vec3 position, const Words& words) {
    Entity& entity = samples::add(document, name, BoxShape{half}, position);
    for (const auto& [word, value] : words) entity.attributes[word] = value;
    return entity;
}

/// A static tub without lid, inside 40 × 30 × 40 cm above height 0, walls of 5 cm.
Document tub() {
    Document document;
    const Words fixed{{"kind", to_value(attributes::PhysicalKind::static_body)}};
    add_box(document, "Bottom", {0.25, 0.025, 0.25}, {0, -0.025, 0}, fixed);
    for (const double side : {-1.0, 1.0}) {
        add_box(document, "Wall", {0.025, 0.15, 0.25}, {side * 0.225, 0.15, 0}, fixed);
        add_box(document, "Wall", {0.2, 0.15, 0.025}, {0, 0.15, side * 0.225}, fixed);
    }
    return document;
}

Words water(double particles) {
    return {{"kind", to_value(attributes::PhysicalKind::fluid)}, {"particle_budget", particles}};
}

/// 20 cm of water in the tub; the box is wider than the tub's inside, so that walls stand in it.
EntityIndex fill(Document& document, double particles = 4000) {
    return add_box(document, "Water", {0.22, 0.1, 0.22}, {0, 0.1, 0}, water(particles)).index;
}

double mean_height(const std::vector<Vec3>& points) {
    double sum = 0;
    for (const Vec3 p : points) sum += p.y;
    return sum / static_cast<double>(points.size());
}

TEST(Fluids, TooLargeForTheirParticlesAreRefused) {
    Document document;
    add_box(document, "Sea", {500, 500, 500}, {0, 500, 0}, water(20'000));
    const auto made = Simulation::create(document, nullptr);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message().find("Sea"), std::string::npos) << made.error().message();
    EXPECT_NE(made.error().message().find("particle_budget"), std::string::npos) << made.error().message();
}

TEST(Fluids, OfAnotherSizeBesideEachOtherHaveTheirOwnVolume) {
    Document document;
    const EntityIndex small = add_box(document, "Small", {0.2, 0.2, 0.2}, {0, 0.2, 0}, water(2000)).index;
    const EntityIndex large = add_box(document, "Large", {0.3, 0.3, 0.3}, {0.55, 0.3, 0}, water(2000)).index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->points(small)->mass(), 998 * 0.064, 0.05 * 998 * 0.064);
    EXPECT_NEAR(simulation->points(large)->mass(), 998 * 0.216, 0.05 * 998 * 0.216);

    // It can be disabled and enabled in the running scene.
    Entity changed = *simulation->definition(large);
    changed.enabled = false;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_EQ(simulation->world().fluids().size(), 1u);
    changed.enabled = true;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_NEAR(simulation->points(large)->mass(), 998 * 0.216, 0.05 * 998 * 0.216);
}

// The particles of the other's cell size that fill one layer have ten times its volume.
TEST(Fluids, ThinnerThanTheParticlesBesideThemKeepVolumeAndBudget) {
    Document document;
    add_box(document, "Cube", {0.0525, 0.0525, 0.0525}, {0.7, 0.1, 0}, water(1000));
    const EntityIndex sheet = add_box(document, "Sheet", {0.5, 0.001, 0.5}, {0, 0.2, 0}, water(2000)).index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_NEAR(simulation->points(sheet)->mass(), 998 * 0.002, 0.05 * 998 * 0.002);
    EXPECT_LE(points_of(*simulation, sheet).size(), 2000u);
}

TEST(Fluids, PutFarApartLoseNothingAndMixAgainWhenTheyMeet) {
    Document document;
    const EntityIndex left = add_box(document, "Left", {0.2, 0.1, 0.2}, {-0.3, 0.1, 0}, water(2000)).index;
    const EntityIndex right = add_box(document, "Right", {0.2, 0.1, 0.2}, {0.3, 0.1, 0}, water(2000)).index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->world().fluids().size(), 1u);
    const std::size_t count = points_of(*simulation, left).size();
    ASSERT_EQ(points_of(*simulation, right).size(), count);
    const auto put_right_at = [&](Vec3 place) {
        Transform pose = simulation->pose(right);
        pose.position = place;
        ASSERT_TRUE(simulation->set_pose(right, pose).ok());
        step(*simulation, 10);
        EXPECT_EQ(points_of(*simulation, left).size(), count);
        EXPECT_EQ(points_of(*simulation, right).size(), count);
        EXPECT_NEAR(simulation->points(left)->center_of_mass().x, -0.3, 0.1);
        EXPECT_NEAR(simulation->points(right)->center_of_mass().x, place.x, 0.1);
    };
    put_right_at({500, 5, 0});
    EXPECT_EQ(simulation->world().fluids().size(), 2u);
    put_right_at({0.3, 0, 0});
    EXPECT_EQ(simulation->world().fluids().size(), 1u);
    step(*simulation, 5);
    ASSERT_TRUE(simulation->remove(left).ok());
    EXPECT_EQ(points_of(*simulation, right).size(), count);
}

TEST(Fluids, ThatRunFarApartLoseNothing) {
    // Their common grid would have three million cells in the end, more than a fluid may have.
    Document document;
    std::vector<EntityIndex> thrown;
    for (const double side : {-1.0, 1.0})
        thrown.push_back(add_box(document, "Water", {0.02, 0.02, 0.02}, {0.03 * side, 0, 0}, water(500)).index);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->world().fluids().size(), 1u);
    const std::size_t count = points_of(*simulation, thrown[0]).size();
    for (const EntityIndex index : thrown)
        ASSERT_TRUE(simulation->set_velocity(index, {0, index == thrown[0] ? 20.0 : -20.0, 0}, {}).ok());
    step(*simulation, 40);
    EXPECT_EQ(simulation->world().fluids().size(), 2u);
    EXPECT_GT(simulation->points(thrown[0])->center_of_mass().y - simulation->points(thrown[1])->center_of_mass().y,
              25);
    for (const EntityIndex index : thrown) EXPECT_EQ(points_of(*simulation, index).size(), count);
}

TEST(Fluids, OfOneFluidKeepTheirVolumeWhenSwitchedOffAndOnInAnyOrder) {
    Document document;
    const EntityIndex small = add_box(document, "Small", {0.2, 0.2, 0.2}, {0, 0.2, 0}, water(2000)).index;
    const EntityIndex large = add_box(document, "Large", {0.25, 0.25, 0.25}, {0.5, 0.25, 0}, water(2000)).index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    ASSERT_EQ(simulation->world().fluids().size(), 1u);
    const double in_small = simulation->points(small)->mass(), in_large = simulation->points(large)->mass();
    const auto set_enabled = [&](EntityIndex index, bool enabled) {
        Entity changed = *simulation->definition(index);
        changed.enabled = enabled;
        ASSERT_TRUE(simulation->update(changed, true).ok());
    };
    for (const bool enabled : {false, true}) {
        for (const EntityIndex index : enabled ? std::vector{large, small} : std::vector{small, large})
            set_enabled(index, enabled);
        EXPECT_NEAR(simulation->points(small)->mass(), in_small, 1e-9 * in_small);
        EXPECT_NEAR(simulation->points(large)->mass(), in_large, 1e-9 * in_large);
    }
    EXPECT_EQ(simulation->world().fluids().size(), 1u);
}

TEST(FluidFilling, HasTheShapesVolume) {
    const double pi = std::acos(-1.0);
    const std::vector<std::pair<ShapeDefinition, double>> shapes = {
        {BoxShape{{0.15, 0.1, 0.2}}, 8 * 0.15 * 0.1 * 0.2},
        {physics::SphereShape{0.2}, 4 * pi / 3 * 0.008},
        {physics::CylinderShape{0.15, 0.1}, pi * 0.15 * 0.15 * 0.2},
        {physics::ConeShape{0.2, 0.15}, pi / 3 * 0.04 * 0.3},
        {BoxShape{{0.5, 0.001, 0.5}}, 0.002}};
    for (const auto& [shape, volume] : shapes) {
        const auto filled = fill_with_fluid(shape, std::cbrt(8 * volume / 8000), 9000);
        ASSERT_TRUE(filled.ok()) << physics::shape_name(shape) << filled.error().message();
        const double particle = std::pow(filled.value().cell_size, 3) / 8;
        EXPECT_NEAR(static_cast<double>(filled.value().places.size()) * particle / volume, 1, 0.02)
            << physics::shape_name(shape);
        EXPECT_LE(filled.value().places.size(), 9000u);
        EXPECT_GT(filled.value().places.size(), 3000u);
    }
    EXPECT_FALSE(fill_with_fluid(physics::PlaneShape{}, 0.01, 100).ok());
}

TEST(Fluids, FillATubLessItsWallsAndComeToRest) {
    Document document = tub();
    const EntityIndex index = fill(document);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const MovingPoints* its = simulation->points(index);
    ASSERT_NE(its, nullptr);
    EXPECT_TRUE(its->is_liquid());
    EXPECT_TRUE(simulation->body(index).is_null());
    for (const Vec3 p : points_of(*simulation, index)) EXPECT_LE(std::max(std::fabs(p.x), std::fabs(p.z)), 0.2);
    EXPECT_NEAR(its->mass(), 998 * 0.4 * 0.2 * 0.4, 0.05 * 32);
    const std::size_t count = points_of(*simulation, index).size();
    step(*simulation, 90);
    EXPECT_EQ(points_of(*simulation, index).size(), count);
    // The centre of a column of water is at half its height.
    const double height = its->mass() / (998 * 0.16);
    EXPECT_NEAR(mean_height(points_of(*simulation, index)), height / 2, 0.04 * height);

    // A ray from above hits the surface.
    const auto hit = simulation->cast_ray({0.01, 1, 0.02}, {0, -1, 0}, 2);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->entity, index);
    EXPECT_NEAR(hit->position.y, height, 0.03);
}

TEST(Fluids, ABoxFloatsAsDeepAsItsDensitySays) {
    Document document = tub();
    const EntityIndex index = fill(document, 4000);
    const EntityIndex toy = add_box(document, "Toy", {0.06, 0.06, 0.06}, {0, 0.25, 0}, {{"density", 500.0}}).index;
    const nlohmann::json file = document_to_json(document);
    const auto read = document_from_json(file);
    ASSERT_TRUE(read.ok());
    const auto simulation = make(read.value());
    ASSERT_TRUE(simulation);
    step(*simulation, 240);
    // Archimedes: half of it is under water, and the level rises by the displaced volume.
    const double level = (simulation->points(index)->mass() / 998 + 0.5 * 8 * 0.06 * 0.06 * 0.06) / 0.16;
    EXPECT_NEAR(simulation->pose(toy).position.y, level, 0.012);  // a third of a cell of 4 cm
}

TEST(Fluids, HoneyRunsSlowerThanWater) {
    std::vector<double> heights;
    for (const double viscosity : {0.001, 10.0}) {
        Document document = samples::floor_and_box();
        document.entities.resize(1);
        Entity& blob = add_box(document, "Blob", {0.06, 0.06, 0.06}, {0, 0.061, 0}, water(2000));
        blob.attributes["dynamic_viscosity"] = viscosity;
        const EntityIndex index = blob.index;
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        step(*simulation, 30);
        heights.push_back(mean_height(points_of(*simulation, index)));
    }
    EXPECT_LT(heights[0], 0.03);
    EXPECT_GT(heights[1], 1.5 * heights[0]);
}

TEST(Fluids, ASavedSceneRunsAsTheOneThatWasSaved) {
    Document document = tub();
    const EntityIndex index = fill(document, 1500);
    const auto first = make(document);
    const auto read = document_from_json(document_to_json(document));
    ASSERT_TRUE(read.ok());
    const auto second = make(read.value());
    ASSERT_TRUE(first && second);
    step(*first, 30);
    step(*second, 30);
    EXPECT_EQ(points_of(*first, index), points_of(*second, index));
}

TEST(Fluids, NearEachOtherAreOneOfAnyMatter) {
    for (const double viscosity : {0.001, 0.5}) {
        Document document = tub();
        const EntityIndex lower = add_box(document, "Lower", {0.2, 0.05, 0.2}, {0, 0.05, 0}, water(2000)).index;
        Entity& more = add_box(document, "Upper", {0.15, 0.05, 0.15}, {0, 0.16, 0}, water(2000));
        more.attributes["dynamic_viscosity"] = viscosity;
        const EntityIndex upper = more.index;
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        EXPECT_EQ(simulation->world().fluids().size(), 1u);
        const std::size_t count = points_of(*simulation, lower).size();
        const double mass = simulation->points(upper)->mass();
        EXPECT_NEAR(mass, 998 * 0.3 * 0.1 * 0.3, 0.04 * 9);
        step(*simulation, 120);
        double together = 0;
        for (const EntityIndex index : {lower, upper})
            together += simulation->points(index)->mass() * mean_height(points_of(*simulation, index));
        together /= simulation->points(lower)->mass() + mass;
        EXPECT_NEAR(together, (0.1 + 0.09 / 0.16 * 0.1) / 2, 0.006);

        // One is removed, the other stays unchanged.
        ASSERT_TRUE(simulation->remove(upper).ok());
        EXPECT_EQ(points_of(*simulation, lower).size(), count);
        EXPECT_EQ(simulation->world().fluids().size(), 1u);
        step(*simulation, 5);
        ASSERT_TRUE(simulation->remove(lower).ok());
        EXPECT_TRUE(simulation->world().fluids().empty());
        step(*simulation, 2);
    }
}

TEST(Fluids, ChangeWhileTheyRun) {
    Document document = tub();
    const EntityIndex index = fill(document, 1500);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    step(*simulation, 10);

    // Other matter: the same particles at the same places.
    const std::vector<Vec3> before = points_of(*simulation, index);
    const double mass = simulation->points(index)->mass();
    Entity changed = document.entities.back();
    changed.attributes["rest_density"] = 1400.0;
    changed.attributes["dynamic_viscosity"] = 5.0;
    const Result<void> updated = simulation->update(changed, true);
    ASSERT_TRUE(updated.ok()) << updated.error().message();
    EXPECT_EQ(points_of(*simulation, index), before);
    EXPECT_NEAR(simulation->points(index)->mass(), mass * 1400 / 998, 1e-9 * mass);

    // Another resolution: filled again.
    changed.attributes["particle_budget"] = 500.0;
    ASSERT_TRUE(simulation->update(changed, true).ok());
    EXPECT_LT(points_of(*simulation, index).size(), before.size());

    // Another kind and back. The solid does not keep the liquid out of its own place.
    Entity solid = changed;
    solid.attributes["kind"] = to_value(attributes::PhysicalKind::rigid);
    ASSERT_TRUE(simulation->update(solid, true).ok());
    EXPECT_EQ(simulation->points(index), nullptr);
    EXPECT_FALSE(simulation->body(index).is_null());
    step(*simulation, 2);
    ASSERT_TRUE(simulation->update(changed, true).ok());
    ASSERT_NE(simulation->points(index), nullptr);
    EXPECT_GT(points_of(*simulation, index).size(), 200u);
    step(*simulation, 5);

    // After a move it is at rest at the new place; disabled and enabled again, it has its old state.
    MovingPoints& its = const_cast<MovingPoints&>(*simulation->points(index));
    const Vec3 center = its.center_of_mass();
    Transform pose = simulation->pose(index);
    pose.position.y += 1;
    ASSERT_TRUE(simulation->set_pose(index, pose).ok());
    EXPECT_NEAR(its.center_of_mass().y, center.y + 1, 1e-4);
    ASSERT_TRUE(simulation->set_velocity(index, {0, 2, 0}, {}).ok());
    EXPECT_NEAR(its.linear_velocity().y, 2, 1e-6);
    const std::vector<Vec3> there = points_of(*simulation, index);
    ASSERT_TRUE(its.set_enabled(false).ok());
    step(*simulation, 3);
    EXPECT_EQ(points_of(*simulation, index), there);
    ASSERT_TRUE(its.set_enabled(true).ok());
    EXPECT_NEAR(its.linear_velocity().y, 2, 1e-6);
    ASSERT_TRUE(its.apply_impulse({its.mass(), 0, 0}).ok());
    EXPECT_NEAR(its.linear_velocity().x, 1, 1e-5);
    EXPECT_NEAR(simulation->drop_distance(index, 5).value_or(0), its.bounds().lower.y, 0.05);
}

TEST(Fluids, HeldByAJointAreRigidWithANote) {
    Document document = tub();
    const EntityIndex index = fill(document, 500);
    SceneJoint joint;
    joint.index = 1;
    joint.entity_b = index;
    document.joints.push_back(joint);
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    EXPECT_EQ(simulation->points(index), nullptr);
    ASSERT_EQ(simulation->notes().size(), 1u);
    ASSERT_TRUE(simulation->remove_joint(1).ok());
    EXPECT_TRUE(simulation->notes().empty());
    EXPECT_NE(simulation->points(index), nullptr);
}

TEST(Fluids, ThinnerThanTheirParticlesAreReported) {
    Document document;
    add_box(document, "Puddle", {0.5, 1e-6, 0.5}, {0, 0.01, 0}, water(2000));
    add_box(document, "Pool", {0.1, 0.1, 0.1}, {3, 0.2, 0}, water(2000));
    const auto simulation = make(document);
    ASSERT_EQ(simulation->notes().size(), 1u);
    EXPECT_NE(simulation->notes()[0].find("Puddle is 0.002 mm thick"), std::string::npos) << simulation->notes()[0];
}

TEST(Fluids, OfCellsSetAlikeAreOneThoughTheirBudgetsOverruleThem) {
    // A pool and a heap of water, both told cells of 2 cm; the pool's would take more particles than it may have.
    Random random(7);
    for (int i = 0; i < 6; ++i) {
        // The first one has its budget; the second one joins it with up to five times its own.
        const double excess = i % 2 == 0 ? random.between(5, 20) : random.between(1.5, 4.5), cell = 0.02;
        const Vec3 half{0.2, 0.08, 0.2};
        const double pool_particles = 64 * half.x * half.y * half.z / (cell * cell * cell);
        const auto add_water = [&](Document& document, const char* name, Vec3 size, double y, double budget) {
            Words words = water(std::floor(budget));
            words["fluid_cell_size"] = cell;
            add_box(document, name, size, {0, y, 0}, words);
        };
        const auto add_pool = [&](Document& document) {
            add_water(document, "Pool", half, half.y, pool_particles / excess);
        };
        const auto add_heap = [&](Document& document) { add_water(document, "Heap", {0.06, 0.04, 0.2}, 0.25, 20000); };
        Document document = tub();
        i % 2 == 0 ? add_pool(document) : add_heap(document);
        i % 2 == 0 ? add_heap(document) : add_pool(document);
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        EXPECT_EQ(simulation->world().fluids().size(), 1u) << excess;
        // The pool comes first: its cells are larger than told, and so are the heap's, which is one with it.
        std::string notes;
        for (const std::string& note : simulation->notes()) notes += note + "\n";
        if (i % 2 == 0) {
            EXPECT_NE(notes.find("Pool has cells of "), std::string::npos) << notes;
            EXPECT_NE(notes.find("particle_budget is "), std::string::npos) << notes;
            EXPECT_NE(notes.find("Heap has cells of "), std::string::npos) << notes;
            EXPECT_NE(notes.find("it is one with other liquid"), std::string::npos) << notes;
        }
    }
}

TEST(Fluids, ThatTheirBudgetKeepsApartAreReported) {
    Document document = tub();
    for (const double budget : {20000.0, 1000.0}) {
        Words words = water(budget);
        words["fluid_cell_size"] = 0.02;
        const bool is_pool = budget < 2000;
        add_box(document, is_pool ? "Pool" : "Heap", is_pool ? Vec3{0.2, 0.08, 0.2} : Vec3{0.06, 0.04, 0.2},
                {0, is_pool ? 0.08 : 0.25, 0}, words);
    }
    const auto simulation = make(document);
    ASSERT_EQ(simulation->world().fluids().size(), 2u);
    ASSERT_EQ(simulation->notes().size(), 1u);
    const std::string note = simulation->notes()[0];
    EXPECT_EQ(note.rfind("Pool has cells of ", 0), 0u) << note;
    EXPECT_NE(note.find("does not see other liquid"), std::string::npos) << note;
}

TEST(Fluids, OfOtherCellsThatOverlapAreReported) {
    const auto notes_of = [](double particles, double density, double apart) {
        Document document;
        add_box(document, "Water", {0.1, 0.1, 0.1}, {0, 0.2, 0}, water(2000));
        Words other = water(particles);
        other["rest_density"] = density;
        add_box(document, "Other", {0.1, 0.1, 0.1}, {apart, 0.2, 0}, other);
        return make(document)->notes();
    };
    ASSERT_EQ(notes_of(150, 998, 0.1).size(), 1u);
    EXPECT_EQ(notes_of(150, 998, 0.1)[0].rfind("Other is in Water", 0), 0u);
    EXPECT_TRUE(notes_of(150, 998, 0.25).empty());
    EXPECT_TRUE(notes_of(2000, 998, 0.1).empty()) << "the same matter mixes";
    EXPECT_TRUE(notes_of(2000, 900, 0.1).empty()) << "oil and water are one fluid";
}

// Whichever is told first, and however unlike their cells are.
TEST(Fluids, OilComesToLieOnWater) {
    for (const bool is_oil_first : {false, true}) {
        Document document = tub();
        EntityIndex oil = 0, pool = 0;
        for (const bool is_oil : {is_oil_first, !is_oil_first}) {
            Words words = water(is_oil ? 1500 : 3000);
            if (is_oil) {
                words["rest_density"] = 850.0;
                words["dynamic_viscosity"] = 0.05;
                oil = add_box(document, "Oil", {0.12, 0.02, 0.12}, {0, 0.2, 0}, words).index;
            } else {
                pool = add_box(document, "Water", {0.2, 0.08, 0.2}, {0, 0.08, 0}, words).index;
            }
        }
        const auto simulation = make(document);
        ASSERT_EQ(simulation->world().fluids().size(), 1u);
        // With the water's cells it may have up to 1.26 times its volume (FluidBody::max_cell_ratio).
        const double mass = 850 * 0.24 * 0.04 * 0.24;
        EXPECT_NEAR(simulation->points(oil)->mass(), mass, 0.26 * mass);
        step(*simulation, 480);
        // The oil, 14 mm thick, lies on water of 0.16 m.
        EXPECT_NEAR(mean_height(points_of(*simulation, pool)), 0.08, 0.004);
        EXPECT_NEAR(mean_height(points_of(*simulation, oil)), 0.167, 0.012);
    }
}

TEST(Fluids, AMugThatTiltsEmpties) {
    // A mug of twelve staves and a bottom, 8 cm wide and 10 cm high, turned by its velocity.
    Document document = samples::floor_and_box();
    document.entities.resize(1);
    physics::CompoundShape mug;
    const double pi = std::acos(-1.0);
    mug.children.push_back({physics::CylinderShape{0.045, 0.005}, {{0, 0.005, 0}, {}}});
    for (int i = 0; i < 12; ++i) {
        const double angle = pi / 6 * i;
        const Quat turn = from_axis_angle({0, 1, 0}, angle);
        mug.children.push_back({BoxShape{{0.0035, 0.05, 0.0125}}, {rotate(turn, {0.043, 0.05, 0}), turn}});
    }
    Entity& held = samples::add(document, "Mug", mug, {0, 0.2, 0});
    held.attributes = {{"kinematic", true}};
    const EntityIndex mug_index = held.index;
    Entity& drink = samples::add(document, "Water", physics::CylinderShape{0.04, 0.035}, {0, 0.246, 0});
    drink.attributes = water(1500);
    const EntityIndex index = drink.index;
    const auto simulation = make(document);
    ASSERT_TRUE(simulation);
    const std::size_t count = points_of(*simulation, index).size();
    const double mass = simulation->points(index)->mass();
    EXPECT_NEAR(mass, 998 * pi * 0.0385 * 0.0385 * 0.07, 0.05);
    const auto inside = [&] {
        const Transform frame = simulation->pose(mug_index);
        std::size_t held_in = 0;
        for (const Vec3 p : points_of(*simulation, index)) {
            const Vec3 local = inverse_transform_point(frame, p);
            if (local.y > 0 && local.y < 0.1 && std::hypot(local.x, local.z) < 0.043) ++held_in;
        }
        return static_cast<double>(held_in) / static_cast<double>(count);
    };
    step(*simulation, 60);
    EXPECT_GT(inside(), 0.98);
    ASSERT_TRUE(simulation->set_velocity(mug_index, {}, {0, 0, 2}).ok());
    step(*simulation, 65);
    ASSERT_TRUE(simulation->set_velocity(mug_index, {}, {}).ok());
    step(*simulation, 60);
    EXPECT_LT(inside(), 0.05);
    // All of it is still there, except for drops that left the grid.
    EXPECT_GE(simulation->points(index)->mass(), 0.97 * mass);
}

TEST(FluidsInASession, FollowMovesUndoAndReset) {
    const auto session = std::move(Session::create(nullptr, {})).value();
    const auto run = [&](const std::string& command, const nlohmann::json& params = nlohmann::json::object()) {
        auto result = session->execute(command, params);
        EXPECT_TRUE(result.ok()) << command << ": " << (result.ok() ? "" : result.error().message());
        return result.ok() ? std::move(result).value() : nlohmann::json();
    };
    const auto points = [&](EntityIndex entity) {
        std::vector<EntityState> states;
        session->read_states(states);
        std::vector<Vec3> found;
        for (const EntityState& state : states)
            if (state.entity == entity && state.points) state.points->read(found);
        return found;
    };
    const nlohmann::json box = {{"shape", {{"type", "box"}, {"half_extents", {0.1, 0.05, 0.1}}}},
                                {"attributes", {{"kind", "fluid"}, {"particle_budget", 500}}},
                                {"pose", {{"position", {0, 0.5, 0}}}}};
    const EntityIndex index = run("entity.add", {{"entity", box}})["index"];
    const std::vector<Vec3> filled = points(index);
    ASSERT_FALSE(filled.empty());
    run("entity.transform", {{"poses", {{{"index", index}, {"position", {1, 0.5, 0}}}}}});
    EXPECT_NEAR(points(index).front().x, filled.front().x + 1, 1e-5);
    run("edit.undo");
    run("entity.drop_to_floor", {{"indices", {index}}});
    EXPECT_NEAR(points(index).front().y, filled.front().y - 0.45, 0.02);
    const std::vector<Vec3> dropped = points(index);
    run("simulation.step", {{"count", 30}});
    EXPECT_NE(points(index), dropped);
    run("simulation.reset");
    ASSERT_EQ(points(index).size(), dropped.size());
    EXPECT_LT(distance(points(index).front(), dropped.front()), 1e-5);
    run("entity.remove", {{"indices", {index}}});
    EXPECT_TRUE(points(index).empty());
    run("edit.undo");
    EXPECT_EQ(points(index).size(), filled.size());
}

}  // namespace
}  // namespace embody::scene
