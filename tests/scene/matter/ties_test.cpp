// SPDX-License-Identifier: MIT
// Pins of ropes, cloth and soft things to each other.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using attributes::PhysicalKind;
using physics::BoxShape;
using physics::CapsuleShape;
using physics::ShapeDefinition;

constexpr EntityIndex line = 2, hung = 3;

// A rope of 2 m along X, 3 m up, pinned at both ends, and a thing of this kind that hangs 0.5 m down from its middle.
Document hung_on_a_line(PhysicalKind kind) {
    Document document = samples::floor_and_box(3);
    Entity& rope = document.entities[1];
    rope.name = "Line";
    rope.geometry = ShapeDefinition{CapsuleShape{0.01, 1}};
    rope.pose.rotation = from_axis_angle({0, 0, 1}, std::acos(0.0));
    rope.attributes = {{"kind", to_value(PhysicalKind::rope)}, {"mass", 0.2}, {"rope_segments", 20.0}};
    rope.pins = {{{0, 1, 0}, 0.0, {}}, {{0, -1, 0}, 0.0, {}}};
    const ShapeDefinition shape = kind == PhysicalKind::rope    ? ShapeDefinition{CapsuleShape{0.01, 0.24}}
                                  : kind == PhysicalKind::cloth ? ShapeDefinition{BoxShape{{0.25, 0.25, 0.002}}}
                                                                : ShapeDefinition{BoxShape{{0.1, 0.1, 0.1}}};
    const double half = kind == PhysicalKind::soft ? 0.1 : 0.25;
    Entity thing = samples::add(document, "Hung", shape, {0, 3 - half, 0});
    thing.attributes = {{"kind", to_value(kind)}};
    if (kind == PhysicalKind::cloth) thing.attributes["cloth_nodes"] = 100.0;
    thing.pins = {{{0, half, 0}, kind == PhysicalKind::soft ? 0.06 : 0.3, line}};
    if (kind == PhysicalKind::rope) thing.pins[0].radius = 0.0;
    document.entities.back() = thing;
    return document;
}

TEST(Ties, WhatIsPinnedToARopeHangsOnIt) {
    for (const PhysicalKind kind : {PhysicalKind::rope, PhysicalKind::cloth, PhysicalKind::soft}) {
        const Document document = hung_on_a_line(kind);
        ASSERT_EQ(document.entities.back().index, hung);
        const auto read = document_from_json(document_to_json(document));
        ASSERT_TRUE(read.ok()) << read.error().message();
        EXPECT_EQ(read.value().entities.back().pins, document.entities.back().pins);
        const auto simulation = samples::make(read.value());
        ASSERT_TRUE(simulation);
        EXPECT_TRUE(simulation->notes().empty()) << to_text(kind) << ": " << simulation->notes()[0];
        ASSERT_NE(simulation->points(line), nullptr) << to_text(kind) << ": neither is rigid";
        ASSERT_NE(simulation->points(hung), nullptr) << to_text(kind);
        samples::step(*simulation, 300);
        std::vector<Vec3> nodes;
        simulation->points(line)->read(nodes);
        double lowest = 10;
        for (const Vec3 node : nodes) lowest = std::min(lowest, node.y);
        EXPECT_GT(lowest, 2) << to_text(kind);
        EXPECT_LT(lowest, 2.995) << to_text(kind) << ": it bears a load";
        EXPECT_NEAR(simulation->points(hung)->bounds().upper.y, lowest, 0.15) << to_text(kind);
    }
}

TEST(Ties, GoWithTheirPinsAndComeWithTheThing) {
    for (const PhysicalKind kind : {PhysicalKind::soft}) {
        const Document document = hung_on_a_line(kind);
        const auto simulation = samples::make(document);
        ASSERT_TRUE(simulation);
        samples::step(*simulation, 60);
        // A line with other nodes replaces the line: the thing stays hung on it.
        Entity other = document.entities[1];
        other.attributes["rope_segments"] = 30.0;
        ASSERT_TRUE(simulation->update(other, true).ok());
        samples::step(*simulation, 60);
        EXPECT_GT(simulation->points(hung)->center_of_mass().y, 2) << to_text(kind);
        Entity loose = document.entities.back();
        loose.pins.clear();
        ASSERT_TRUE(simulation->update(loose, true).ok());
        samples::step(*simulation, 60);
        EXPECT_LT(simulation->points(hung)->center_of_mass().y, 2) << to_text(kind);
    }
}

TEST(Ties, TwoSoftThingsCannotBeTied) {
    Document document = hung_on_a_line(PhysicalKind::soft);
    document.entities[1].geometry = ShapeDefinition{BoxShape{{0.1, 0.1, 0.1}}};
    document.entities[1].attributes = {{"kind", to_value(PhysicalKind::soft)}};
    const auto simulation = samples::make(document);
    ASSERT_TRUE(simulation);
    EXPECT_EQ(simulation->points(line), nullptr);
    ASSERT_FALSE(simulation->notes().empty());
    EXPECT_NE(simulation->notes()[0].find("is simulated as rigid, because"), std::string::npos);
}

class TiedSession : public samples::LiveSession {};

TEST_F(TiedSession, CopiesMadeTogetherAreTiedToEachOther) {
    open(hung_on_a_line(PhysicalKind::cloth));
    const nlohmann::json copies =
        run("entity.duplicate", {{"indices", {line, hung}}, {"offset", {0, 0, 2}}})["indices"];
    ASSERT_EQ(copies.size(), 2u);
    EXPECT_EQ(session_->document().find(copies[1])->pins[0].to, copies[0].get<EntityIndex>());
    // A copy of only the hung thing is held by the same thing as the original.
    const nlohmann::json one = run("entity.duplicate", {{"indices", {hung}}, {"offset", {0, 0, 0.3}}})["indices"];
    EXPECT_EQ(session_->document().find(one[0])->pins[0].to, line);
}

TEST_F(TiedSession, WhatCannotBePinnedToNamesTheEntityOnce) {
    Document document = hung_on_a_line(PhysicalKind::rope);
    document.entities.back().pins.clear();
    Entity& sand = samples::add(document, "Sand", BoxShape{{0.1, 0.1, 0.1}}, {2, 0.5, 0});
    sand.attributes = {{"kind", to_value(PhysicalKind::granular)}, {"grain_budget", 50.0}};
    const EntityIndex heap = sand.index;
    open(document);
    const auto refused = session_->execute(
        "entity.update", {{"index", hung}, {"entity", {{"pins", {{{"position", {0, 0.25, 0}}, {"to", heap}}}}}}});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().where, "entity 3 (Hung): pins[0].to");
    EXPECT_TRUE(session_->document().find(hung)->pins.empty());
}

}  // namespace
}  // namespace embody::scene
