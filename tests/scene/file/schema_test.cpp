// SPDX-License-Identifier: MIT
// The published schema and the strict reader agree on every field.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "attributes/registry.h"
#include "folders.h"
#include "physics/every_shape.h"
#include "scene/document/document.h"
#include "scene/file/scene_file.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path data = source_folder() / "data";

json read_json(const fs::path& file) {
    std::ifstream in(file);
    return json::parse(in);
}

std::string read_text(const fs::path& of_the_sources) {
    std::ifstream in(source_folder() / of_the_sources);
    return {std::istreambuf_iterator<char>(in), {}};
}

class SceneSchema : public testing::Test {
protected:
    SceneSchema() : text_(read_json(data / "schema" / "scene.schema.json")) {
        valijson::SchemaParser parser;
        parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(text_), schema_);
    }
    bool allows(const json& scene) {
        valijson::Validator validator;
        return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(scene), nullptr);
    }
    json text_;
    valijson::Schema schema_;
};

// The paths of all values of a scene; one value is changed at a time.
void list_places(const json& value, const std::string& pointer, std::vector<std::string>& places) {
    places.push_back(pointer);
    if (value.is_object())
        for (const auto& [name, inner] : value.items()) list_places(inner, pointer + "/" + name, places);
    if (value.is_array())
        for (std::size_t i = 0; i < value.size(); ++i) list_places(value[i], pointer + "/" + std::to_string(i), places);
}

TEST_F(SceneSchema, NamesTheAttributesOfTheRegistry) {
    std::set<std::string> named, known;
    for (const auto& [name, rule] : text_["definitions"]["attributes"]["properties"].items()) named.insert(name);
    for (const attributes::AttributeDescription& attribute : attributes::registry()) known.insert(attribute.name);
    EXPECT_EQ(named, known);
}

// The list of settings repeats the ranges that the physics validates, for the schema and for messages with units.
TEST_F(SceneSchema, SettingsHaveTheRangesOfThePhysics) {
    int ranges = 0;
    for_each_field<physics::WorldSettings>([&ranges](const auto& field) {
        using Value = typename std::remove_cvref_t<decltype(field)>::Member;
        if constexpr (std::is_arithmetic_v<Value> && std::remove_cvref_t<decltype(field)>::saved != Saved::never) {
            if (!std::isfinite(field.range.low)) return;
            const auto is_valid = [&field](double value) {
                physics::WorldSettings settings;
                settings.*field.member = static_cast<Value>(value);
                return physics::validate(settings).ok();
            };
            const double step = std::is_integral_v<Value> ? 1 : 1e-9;
            EXPECT_TRUE(is_valid(field.range.low) && is_valid(field.range.high)) << field.name;
            EXPECT_FALSE(is_valid(field.range.low - step)) << field.name;
            EXPECT_FALSE(is_valid(field.range.high + step)) << field.name;
            ++ranges;
        }
    });
    EXPECT_EQ(ranges, 8);
}

TEST_F(SceneSchema, NamesEveryShape) {
    const auto names = names_of(static_cast<const physics::ShapeDefinition*>(nullptr));
    const std::set<std::string> known(names.begin(), names.end());
    std::set<std::string> named;
    for (const json& shape : text_["definitions"]["shape"]["anyOf"])
        named.insert(shape["properties"]["type"]["const"].get<std::string>());
    EXPECT_EQ(named, known);
    const std::string format = read_text("docs/scene-format.md");
    for (const std::string& name : known)
        EXPECT_NE(format.find("| `" + name + "` |"), std::string::npos) << name << " is not in docs/scene-format.md";

    // The Studio draws shapes that consist only of lengths by a table.
    const std::string table = read_text("studio/src/view/shapes_of_lengths.ts");
    physics::for_each_shape_of_lengths<physics::ShapeDefinition>([&](const auto& shape) {
        EXPECT_NE(table.find("\n  " + std::string(shape.name) + ": {"), std::string::npos)
            << shape.name << " is not in shapes_of_lengths.ts";
    });
}

TEST_F(SceneSchema, NamesEveryJoint) {
    const auto names = names_of(static_cast<const physics::JointKind*>(nullptr));
    const std::set<std::string> known(names.begin(), names.end());
    std::set<std::string> named;
    for (const json& joint : text_["definitions"]["joint"]["anyOf"])
        named.insert(joint["properties"]["type"]["const"].get<std::string>());
    EXPECT_EQ(named, known);
    const std::string format = read_text("docs/scene-format.md");
    for (const std::string& name : known)
        EXPECT_NE(format.find('`' + name + '`'), std::string::npos) << name << " is not in docs/scene-format.md";
}

TEST_F(SceneSchema, AllowsWhatTheReaderAllows) {
    const json everything = document_to_json(samples::everything());
    ASSERT_TRUE(document_from_json(everything).ok());
    EXPECT_TRUE(allows(everything));
    int demos = 0;
    for (const auto& entry : fs::directory_iterator(data / "scenes")) {
        if (entry.path().extension() != ".json") continue;
        const Result<Document> read = load_document(entry.path());
        EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message());
        EXPECT_TRUE(allows(read_json(entry.path()))) << entry.path();
        ++demos;
    }
    EXPECT_GE(demos, 3);
}

// Changes each value of a scene with all fields in five ways; schema and reader must agree.
TEST_F(SceneSchema, RefusesWhatTheReaderRefuses) {
    json scene = document_to_json(samples::everything());
    // One action of each trigger and each effect is enough here.
    json actions = json::array();
    for (std::size_t i = 0; i < scene["actions"].size(); i += 10) actions.push_back(scene["actions"][i]);
    scene["actions"] = actions;
    std::vector<std::string> places;
    list_places(scene, "", places);
    const json broken[] = {nullptr, true, "word", json::array(), {{"no_such_field", 1}}};
    int refused = 0;
    for (const std::string& place : places) {
        for (const json& wrong : broken) {
            json changed = scene;
            changed[json::json_pointer(place)] = wrong;
            const bool reads = document_from_json(changed).ok();
            const bool fits = allows(changed);
            refused += reads ? 0 : 1;
            // A schema cannot check values of attributes in actions, which entities exist, or what is packed.
            const bool is_beyond = place == "/entities" || place.ends_with("/effect/value") ||
                                   place.find("/entity_") != std::string::npos ||
                                   place.find("/attributes/") != std::string::npos ||
                                   place.find("/kept/") != std::string::npos;
            if (is_beyond) {
                EXPECT_TRUE(fits || !reads) << place << " = " << wrong.dump();
            } else {
                EXPECT_EQ(fits, reads) << place << " = " << wrong.dump()
                                       << (reads ? "" : ": " + document_from_json(changed).error().message());
            }
        }
    }
    EXPECT_GT(refused, 1000);
}

TEST_F(SceneSchema, RefusesUnknownFieldsEverywhere) {
    const json scene = document_to_json(samples::everything());
    std::vector<std::string> places;
    list_places(scene, "", places);
    for (const std::string& place : places) {
        json changed = scene;
        json& object = changed[json::json_pointer(place)];
        if (!object.is_object()) continue;
        object["no_such_field"] = 1;
        EXPECT_FALSE(document_from_json(changed).ok()) << place;
        EXPECT_FALSE(allows(changed)) << place;
    }
}

}  // namespace
}  // namespace embody::scene
