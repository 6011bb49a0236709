// SPDX-License-Identifier: MIT
// Cloth with gas inside: closed sheets of random things (docs/physics/cloth.md, "Gas inside").
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "attributes/physical_kind.h"
#include "foundation/random.h"
#include "scene/embody/entity_definitions.h"
#include "scene/live_scene.h"
#include "scene/matter/soft_nodes.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using physics::BoxShape;
using physics::ShapeDefinition;
using samples::make;
using samples::thing;

/// Closed cloth of this shape above the floor.
Document blown_up(const ShapeDefinition& shape, double pressure, double stiffness, double nodes = 300) {
    Document document = samples::floor_and_box(2);
    Entity& entity = document.entities[1];
    entity.geometry = shape;
    entity.attributes = {{"kind", attributes::to_value(PhysicalKind::cloth)},
                         {"internal_pressure", pressure},
                         {"stretch_stiffness", stiffness},
                         {"shear_stiffness", stiffness},
                         {"mass", 0.2},
                         {"cloth_nodes", nodes}};
    return document;
}

std::optional<physics::GasInside> gas_of(const Simulation& simulation) {
    const MovingPoints* points = simulation.points(thing);
    const auto* nodes = points ? dynamic_cast<const SoftNodes*>(points) : nullptr;
    return nodes ? simulation.world().gas_inside(nodes->handle()) : std::nullopt;
}

double mean_radius(const Simulation& simulation) {
    const MovingPoints* points = simulation.points(thing);
    std::vector<Vec3> places;
    points->read(places);
    Vec3 center;
    for (const Vec3 place : places) center += place / static_cast<double>(places.size());
    double sum = 0;
    for (const Vec3 place : places) sum += length(place - center);
    return sum / static_cast<double>(places.size());
}

TEST(ClosedForm, ABallHasTheSizeAndThePressureThatItIsGiven) {
    Random random(5);
    for (int i = 0; i < 6; ++i) {
        const double radius = random.between(0.1, 0.4), pressure = random.between(500, 8000);
        const double stiffness = pressure * radius / 2 / random.between(0.01, 0.2);
        Document document = blown_up(physics::SphereShape{radius}, pressure, stiffness);
        document.settings.gravity = {};
        const auto simulation = make(document);
        ASSERT_TRUE(simulation);
        ASSERT_TRUE(gas_of(*simulation)) << i;
        for (int step = 0; step < 120; ++step) simulation->step();
        EXPECT_NEAR(gas_of(*simulation)->pressure, pressure, 0.1 * pressure) << i;
        EXPECT_NEAR(mean_radius(*simulation), radius, 0.03 * radius) << i;
        EXPECT_NEAR(simulation->points(thing)->mass(), 0.2, 1e-6) << i;
    }
}

TEST(ClosedForm, EveryShapeWithRoomInsideHoldsGas) {
    Random random(6);
    for (int i = 0; i < 8; ++i) {
        const auto draw = [&] { return random.between(0.08, 0.4); };
        const ShapeDefinition shapes[] = {BoxShape{{draw(), draw(), draw()}}, physics::CylinderShape{draw(), draw()},
                                          physics::CapsuleShape{draw(), draw()}, physics::SphereShape{draw()}};
        const double nodes = std::round(random.between(150, 800));
        const auto simulation = make(blown_up(shapes[i % 4], random.between(500, 5000), 2e4, nodes));
        ASSERT_TRUE(simulation);
        ASSERT_TRUE(gas_of(*simulation)) << i;
        const auto* points = dynamic_cast<const SoftNodes*>(simulation->points(thing));
        const auto count = static_cast<double>(points->definition().nodes.size());
        EXPECT_LT(std::fabs(std::log(count / nodes)), std::log(2)) << i << ": " << count << " for " << nodes;
        for (int step = 0; step < 30; ++step) simulation->step();
        EXPECT_GT(gas_of(*simulation)->pressure, 0) << i;
    }
}

TEST(ClosedForm, ExtremePressuresStayFinite) {
    for (const double pressure : {1e-3, 1e8}) {
        for (const double stiffness : {1e-3, 1e9}) {
            const auto simulation = make(blown_up(BoxShape{{0.2, 0.1, 0.3}}, pressure, stiffness));
            ASSERT_TRUE(simulation);
            ASSERT_TRUE(gas_of(*simulation)) << pressure << " " << stiffness;
            for (int step = 0; step < 5; ++step) simulation->step();
            EXPECT_TRUE(std::isfinite(mean_radius(*simulation))) << pressure << " " << stiffness;
        }
    }
}

}  // namespace
}  // namespace embody::scene
