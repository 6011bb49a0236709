// SPDX-License-Identifier: MIT
// Reference cases of ropes, from end to end with a scene file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/file/scene_file.h"
#include "scene/sample_documents.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {
namespace {

using physics::CapsuleShape;
using physics::CylinderShape;
using physics::ShapeDefinition;
using physics::SphereShape;

constexpr double pi = 3.14159265358979323846;
constexpr EntityIndex thing = 2;

std::unique_ptr<Simulation> read_and_make(const Document& document) {
    auto read = document_from_json(document_to_json(document));
    EXPECT_TRUE(read.ok()) << read.error().message();
    if (!read.ok()) return nullptr;
    auto made = Simulation::create(read.value(), nullptr);
    EXPECT_TRUE(made.ok()) << made.error().message();
    return made.ok() ? std::move(made).value() : nullptr;
}

std::vector<Vec3> nodes_of(const Simulation& simulation) {
    std::vector<Vec3> nodes;
    simulation.points(thing)->read(nodes);
    return nodes;
}

// A rope along X, its middle above the origin at this height.
Entity& rope_of(Document& document, double half_length, double radius, double height) {
    document = samples::floor_and_box(height);
    Entity& rope = document.entities[1];
    rope.geometry = ShapeDefinition{CapsuleShape{radius, half_length}};
    rope.pose.rotation = from_axis_angle({0, 0, 1}, -pi / 2);
    rope.attributes = {{"kind", to_value(attributes::PhysicalKind::rope)}};
    return rope;
}

TEST(RopeReference, HangsAsACatenary) {
    // Reference case "catenary": 2.2 m and 1 kg/m over 2 m.
    Document document;
    Entity& rope = rope_of(document, 1, 0.005, 3);
    rope.attributes["slack"] = 0.1;
    rope.attributes["mass"] = 2.2;
    rope.attributes["axial_stiffness"] = 1e6;
    rope.attributes["bend_rigidity"] = 1e-6;
    rope.attributes["rope_segments"] = 100.0;
    rope.attributes["damping_rayleigh"] = 0.02;
    rope.pins = {{{0, 1, 0}, 0.0, {}}, {{0, -1, 0}, 0.0, {}}};
    const auto simulation = read_and_make(document);
    ASSERT_TRUE(simulation);
    for (int i = 0; i < 900; ++i) simulation->step();
    const double sag = 3 - std::ranges::min(nodes_of(*simulation), {}, [](Vec3 p) { return p.y; }).y;
    const auto tensions = simulation->world().rope_tensions(simulation->world().deformables().front());
    RecordProperty("sag", std::to_string(sag));
    RecordProperty("end_tension", std::to_string(tensions.front()));
    EXPECT_NEAR(sag, 0.400601581472, 0.01 * 0.4006);
    EXPECT_NEAR(tensions.front(), 16.7802941669, 0.03 * 16.78);
    EXPECT_NEAR(*std::ranges::min_element(tensions), 12.8503926526, 0.03 * 12.85);
}

TEST(RopeReference, GripsADrumAsACapstan) {
    // Two hands lay a rope over half a turn of a drum, and pull it: T₂/T₁ = exp(μ π).
    const double radius = 0.1, thickness = 2e-3, mu = 0.3, path_radius = radius + thickness, straight = 0.2;
    const double half = path_radius * pi / 2 + straight, height = 2;
    Document document;
    Entity& rope = rope_of(document, half, thickness, height + path_radius);
    rope.attributes["mass"] = 0.01;
    rope.attributes["axial_stiffness"] = 2000.0;
    rope.attributes["bend_rigidity"] = 1e-6;
    rope.attributes["rope_segments"] = 140.0;
    rope.attributes["damping_rayleigh"] = 0.005;
    rope.pins = {{{0, half, 0}, 0.0, 4}, {{0, -half, 0}, 0.0, 5}};
    for (const char* name : {"friction_static", "friction_dynamic"}) rope.attributes[name] = mu;
    Entity& drum = samples::add(document, "Drum", ShapeDefinition{CylinderShape{radius, 0.1}}, {0, height, 0});
    drum.pose.rotation = from_axis_angle({1, 0, 0}, pi / 2);
    drum.attributes = {
        {"kind", to_value(attributes::PhysicalKind::static_body)}, {"friction_static", mu}, {"friction_dynamic", mu}};
    for (const double side : {1.0, -1.0}) {
        Entity& hand =
            samples::add(document, "Hand", ShapeDefinition{SphereShape{2e-3}}, {side * half, height + path_radius, 0});
        hand.attributes = {{"kinematic", true}, {"collision_mask", 0.0}};
    }
    const auto simulation = read_and_make(document);
    ASSERT_TRUE(simulation);
    const auto lead = [&](Vec3 right, Vec3 left, double seconds) {
        ASSERT_TRUE(simulation->set_velocity(4, right / seconds, {}).ok());
        ASSERT_TRUE(simulation->set_velocity(5, left / seconds, {}).ok());
        for (int i = 0; i < std::lround(60 * seconds); ++i) simulation->step();
    };
    // The hands move down on both sides, slightly further than the rope is long, and then pull it over.
    const double across = half - path_radius, down = path_radius + straight + 0.005 * half;
    lead({-across, -down, 0}, {across, -down, 0}, 4);
    lead({0, -0.05, 0}, {0, 0.05, 0}, 2.5);
    double low = 0, high = 0;
    for (int i = 0; i < 30; ++i) {
        lead({0, -0.02 / 60, 0}, {0, 0.02 / 60, 0}, 1.0 / 60);
        const auto tensions = simulation->world().rope_tensions(simulation->world().deformables().front());
        // Node 0 is at the primitive's lower end, which is on the left.
        const std::vector<Vec3> nodes = nodes_of(*simulation);
        std::size_t first = 0, last = nodes.size() - 1;
        while (nodes[first + 1].y < height) ++first;
        while (nodes[last - 1].y < height) --last;
        low += tensions[first - 1];
        high += tensions[last];
    }
    RecordProperty("ratio", std::to_string(high / low));
    EXPECT_GT(low / 30, 1) << "it is tight on both sides";
    EXPECT_NEAR(high / low, std::exp(mu * pi), 0.1 * std::exp(mu * pi));
}

}  // namespace
}  // namespace embody::scene
