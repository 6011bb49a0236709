// SPDX-License-Identifier: MIT
#include "attributes/attribute_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "attributes/registry.h"
#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

TEST(AttributeJson, RefusesWrongDocumentsByName) {
    EXPECT_FALSE(set_from_json(json::object()).ok());
    EXPECT_FALSE(entry_from_json(json(7)).ok());
    EXPECT_EQ(entry_from_json(json::parse(R"({"name": "mass"})")).error().where, "attribute.source");
    EXPECT_EQ(entry_from_json(json::parse(R"({"name": "mass", "source": "", "level": "high"})")).error().where,
              "mass.level");
    EXPECT_EQ(entry_from_json(json::parse(R"({"name": "mass", "source": "", "level": "model"})")).error().where,
              "mass.value");
    const auto twice = json::parse(R"([{"name": "mass", "value": 1, "source": "", "level": "model"},
                                       {"name": "mass", "value": 2, "source": "", "level": "model"}])");
    EXPECT_EQ(set_from_json(twice).error().why, "is there twice");
    EXPECT_FALSE(value_from_json("mass", "heavy").ok());
    EXPECT_FALSE(value_from_json("mass", nullptr).ok());
    EXPECT_FALSE(value_from_json("mass", "infinity").ok());
    EXPECT_FALSE(value_from_json("center_of_mass", json::array({1, 2, "3"})).ok());
    EXPECT_FALSE(value_from_json("no_such_name", 1).ok());
}

TEST(AttributeJson, FactsOfTheWrongTypeAreRefusedByName) {
    EXPECT_FALSE(facts_from_json(json(1)).ok());
    EXPECT_EQ(facts_from_json(json::parse(R"({"name": 7})")).error().where, "facts.name");
    EXPECT_EQ(facts_from_json(json::parse(R"({"movable": "yes"})")).error().where, "facts.movable");
    EXPECT_EQ(facts_from_json(json::parse(R"({"geometry": {"size": [1, 2]}})")).error().where, "facts.size");
    for (const char* inertia : {"[1, 2, 3]", "[[1, 2, 3], [1, 2]]", "[[1, 2, 3], [1, 2, 3], [1, 2, null]]"}) {
        const json damaged = {{"geometry", {{"unit_inertia", json::parse(inertia)}}}};
        EXPECT_EQ(facts_from_json(damaged).error().where, "facts.unit_inertia") << inertia;
    }
    EXPECT_EQ(facts_from_json(json::parse(R"({"geometry": {"fitted_rotation": [0, 0, 1]}})")).error().where,
              "facts.fitted_rotation");
}

TEST(AttributeJson, SetsReadBackAlike) {
    for (const char* name : {"Chair", "Curtain", "Palm tree", "White light source", "Teddy bear"}) {
        const AttributeSet set = resolve(shipped_taxonomy(), closed_box(name, {0.5, 0.7, 0.3}));
        const auto read = set_from_json(json::parse(to_json(set).dump()));
        ASSERT_TRUE(read.ok()) << read.error().message();
        ASSERT_EQ(read->entries().size(), set.entries().size());
        for (std::size_t i = 0; i < set.entries().size(); ++i) {
            const AttributeEntry& a = set.entries()[i];
            const AttributeEntry& b = read->entries()[i];
            EXPECT_EQ(a.name, b.name);
            EXPECT_EQ(a.value, b.value) << a.name;
            EXPECT_EQ(a.low, b.low);
            EXPECT_EQ(a.high, b.high);
            EXPECT_EQ(a.source, b.source);
            EXPECT_EQ(a.level, b.level);
        }
    }
}

TEST(AttributeJson, InfinityIsAWord) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(to_json(AttributeValue(infinity)), "infinity");
    EXPECT_EQ(value_from_json("break_impulse", "infinity").value(), AttributeValue(infinity));
}

TEST(AttributeJson, EntriesCarryWhatPeopleRead) {
    const json entry = to_json(AttributeEntry{"mass", 2.0, 1.0, 3.0, "a scale", AttributeLevel::measured});
    EXPECT_EQ(entry["unit"], "kg");
    EXPECT_EQ(entry["kind"], "mass");
    EXPECT_EQ(entry["label"], "Mass");
    EXPECT_EQ(entry["level"], "measured");
    EXPECT_EQ(entry["low"], 1.0);
    EXPECT_FALSE(entry["help"].get<std::string>().empty());
}

TEST(AttributeJson, FactsReadBackAlike) {
    ModelFacts facts = closed_box("Ch\xC3\xAAne", {0.5, 0.7, 0.3});
    facts.tags = {"a", "b"};
    facts.material_names = {"oak"};
    facts.folder = "x/y";
    facts.catalogue_category = "Bedroom";
    facts.movable = false;
    facts.geometry.fitted_pose = {{0.1, 0.2, 0.3}, {0.5, 0.5, 0.5, 0.5}};
    facts.geometry.unit_inertia = {{1, 0.1, 1.0 / 3}, {0.1, 2, 0.3}, {1.0 / 3, 0.3, 3}};
    geometry::SolidAndShell form;
    form.shell = {6, {0, 0.5, 0}, {{1, 0.1, 0}, {0.1, 2, 0}, {0, 0, 3}}};
    form.solid = {1.0 / 3, {0.25, 0.5, 0}, Mat3::diagonal({2, 2, 2})};
    facts.geometry.parts = {{"oak", form}, {"", {}}};
    const auto read = facts_from_json(json::parse(to_json(facts).dump()));
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(to_json(*read), to_json(facts));
    EXPECT_EQ(read->geometry.fitted_pose, facts.geometry.fitted_pose);
    EXPECT_EQ(read->geometry.unit_inertia, facts.geometry.unit_inertia);
    ASSERT_EQ(read->geometry.parts.size(), 2u);
    EXPECT_EQ(read->geometry.parts[0].material, "oak");
    EXPECT_EQ(read->geometry.parts[0].form.shell.inertia, form.shell.inertia);
    EXPECT_EQ(read->geometry.parts[0].form.solid.center, form.solid.center);
    EXPECT_EQ(read->movable, facts.movable);
    EXPECT_FALSE(facts_from_json(json::object()).value().movable.has_value());
}

TEST(AttributeJson, RegistryListsEveryAttribute) {
    const json list = registry_to_json();
    ASSERT_EQ(list.size(), registry().size());
    EXPECT_EQ(list[0]["name"], registry()[0].name);
}

}  // namespace
}  // namespace embody::attributes
