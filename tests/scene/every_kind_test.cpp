// SPDX-License-Identifier: MIT
// Each kind of the table of kinds is tested from end to end: attributes, scene file, world, steps, commands, recording.
// The test names no kind, so that a new one is tested without a change here.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/matter/fluid_body.h"
#include "scene/matter/grain_bodies.h"
#include "scene/matter/soft_nodes.h"
#include "scene/sample_documents.h"
#include "scene/simulation/recording.h"

namespace embody::scene {
namespace {

using attributes::Matter;
using attributes::PhysicalKind;
using nlohmann::json;
using physics::ShapeDefinition;

/// A shape that such matter can have. The switch has no default, so that the compiler refuses new matter without one.
ShapeDefinition shape_of(Matter matter) {
    switch (matter) {
        case Matter::none:
        case Matter::body:
        case Matter::solid:
        case Matter::liquid:
        case Matter::grains:
            return physics::BoxShape{{0.1, 0.1, 0.1}};
        case Matter::sheet:
            return physics::BoxShape{{0.3, 0.001, 0.3}};
        case Matter::line:
            return physics::CapsuleShape{0.01, 0.3};
    }
    return {};
}

/// Whether the points, or their absence, are those of such matter.
bool stands_for(Matter matter, const MovingPoints* points) {
    const auto* soft = dynamic_cast<const SoftNodes*>(points);
    switch (matter) {
        case Matter::none:
        case Matter::body:
            return points == nullptr;
        case Matter::solid:
            return soft && std::holds_alternative<physics::SoftSolid>(soft->definition().matter);
        case Matter::sheet:
            return soft && std::holds_alternative<physics::Cloth>(soft->definition().matter);
        case Matter::line:
            return soft && std::holds_alternative<physics::Rope>(soft->definition().matter);
        case Matter::liquid:
            return dynamic_cast<const FluidBody*>(points) != nullptr;
        case Matter::grains:
            return dynamic_cast<const GrainBodies*>(points) != nullptr;
    }
    return false;
}

bool moves(PhysicalKind kind) { return traits_of(kind).matter != Matter::none && !is_static(kind); }

class EveryKind : public samples::LiveSession, public testing::WithParamInterface<PhysicalKind> {
protected:
    /// Attributes for few points, where the kind has points.
    static std::map<std::string, attributes::AttributeValue> coarse() {
        std::map<std::string, attributes::AttributeValue> few;
        for (const char* name : {"cloth_nodes", "grain_budget", "particle_budget"})
            if (applies_to(*attributes::describe(name), GetParam())) few[name] = 200.0;
        return few;
    }
    /// A floor and a thing of this kind, 20 m above it.
    [[nodiscard]] static Document a_thing() {
        Document document = samples::floor_and_box(20);
        document.settings.air_density = 0;
        document.entities[1].geometry = shape_of(traits_of(GetParam()).matter);
        document.entities[1].attributes = coarse();
        document.entities[1].attributes["kind"] = to_value(GetParam());
        return document;
    }
    static double height(const Simulation& simulation) {
        const MovingPoints* points = simulation.points(samples::thing);
        return points ? points->center_of_mass().y : simulation.pose(samples::thing).position.y;
    }
};

TEST_P(EveryKind, HasEachAttributeThatConcernsIt) {
    const auto simulation = samples::make(a_thing());
    ASSERT_TRUE(simulation);
    const auto set = simulation->attributes(samples::thing);
    ASSERT_TRUE(set.ok());
    EXPECT_EQ(kind_of(set.value()), GetParam());
    for (const attributes::AttributeDescription& attribute : attributes::registry()) {
        // The collision shape is the primitive itself.
        if (attribute.name == "collision_shape") continue;
        if (applies_to(attribute, GetParam())) {
            EXPECT_TRUE(set.value().find(attribute.name)) << attribute.name;
        }
    }
}

TEST_P(EveryKind, StandsInTheWorldAsItsMatterSays) {
    const auto simulation = samples::make(a_thing());
    ASSERT_TRUE(simulation);
    EXPECT_TRUE(simulation->notes().empty()) << simulation->notes().front();
    EXPECT_TRUE(stands_for(traits_of(GetParam()).matter, simulation->points(samples::thing)));
    EXPECT_EQ(simulation->points(samples::thing) == nullptr, !simulation->body(samples::thing).is_null());
    EXPECT_EQ(simulation->is_movable(samples::thing), moves(GetParam()));
}

TEST_P(EveryKind, FallsAsAnythingDoesOrStays) {
    const auto simulation = samples::make(a_thing());
    ASSERT_TRUE(simulation);
    const double before = height(*simulation);
    samples::step(*simulation, 30);
    const double step = simulation->world().settings().time_step, seconds = 30 * step,
                 fall = 9.81 / 2 * seconds * seconds;
    // With a tolerance of the travel in one step.
    EXPECT_NEAR(before - height(*simulation), moves(GetParam()) ? fall : 0, 9.81 * seconds * step);
}

TEST_P(EveryKind, ComesBackFromAFile) {
    const json written = document_to_json(a_thing());
    const auto read = document_from_json(written);
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(document_to_json(read.value()), written);
    EXPECT_EQ(read.value().entities[1].attributes.at("kind"), to_value(GetParam()));
}

TEST_P(EveryKind, IsChosenAndLeftByCommand) {
    Document document = a_thing();
    document.entities[1].attributes = coarse();
    open(document);
    const json thing{{"index", samples::thing}};
    json kind{{"indices", {samples::thing}}, {"name", "kind"}, {"value", attributes::to_text(GetParam())}};
    run("entity.set_attribute", kind);
    bool is_listed = false;
    const json rows = run("entity.attributes", thing)["attributes"];
    for (const json& row : rows) {
        if (row["name"] != "kind") continue;
        is_listed = true;
        EXPECT_EQ(row["value"], attributes::to_text(GetParam()));
        EXPECT_EQ(row["choices"].size(), attributes::kind_count) << "the Studio's list is the table";
    }
    EXPECT_TRUE(is_listed);
    kind.erase("value");
    run("entity.reset_attribute", kind);
    EXPECT_EQ(session_->document().find(samples::thing)->attributes.count("kind"), 0u);
}

TEST_P(EveryKind, IsRecorded) {
    std::string folder = (std::filesystem::temp_directory_path() / "embody_kind_XXXXXX").string();
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    const std::filesystem::path file = std::filesystem::path(folder) / "out.jsonl";
    const Document document = a_thing();
    const auto simulation = samples::make(document);
    const auto recorder = Recorder::create(file, document, {});
    ASSERT_TRUE(simulation && recorder.ok());
    simulation->step();
    EXPECT_TRUE(recorder.value()->sample(*simulation).ok());
    EXPECT_TRUE(recorder.value()->finish().ok());
    std::ifstream in(file);
    std::string header, line;
    std::getline(in, header);
    std::getline(in, line);
    const json thing = json::parse(line)["entities"][1];
    EXPECT_EQ(thing["index"], samples::thing);
    EXPECT_EQ(thing.contains("points"), simulation->points(samples::thing) != nullptr);
    EXPECT_EQ(thing["state"] == "static", !moves(GetParam()));
    std::filesystem::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryKind, testing::ValuesIn(attributes::physical_kinds),
                         [](const auto& kind) { return attributes::to_text(kind.param); });

}  // namespace
}  // namespace embody::scene
