// SPDX-License-Identifier: MIT
#include "attributes/attribute_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "attributes/facts_json.h"
#include "attributes/registry.h"
#include "attributes/sample_facts.h"
#include "foundation/random.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

TEST(AttributeJson, RefusesWrongDocumentsByName) {
    EXPECT_FALSE(set_from_json(json::object()).ok());
    EXPECT_FALSE(entry_from_json(json(7), "a").ok());
    const auto wrong_at = [](const char* text) { return entry_from_json(json::parse(text), "a").error().where; };
    EXPECT_EQ(wrong_at(R"({"name": "mass"})"), "a.source");
    EXPECT_EQ(wrong_at(R"({"name": "mass", "source": "", "level": "high"})"), "a.level");
    EXPECT_EQ(wrong_at(R"({"name": "mass", "source": "", "level": "model"})"), "a.value");
    EXPECT_EQ(wrong_at(R"({"name": "mass", "source": "", "level": "model", "value": 1, "low": "x"})"), "a.low");
    const auto twice = json::parse(R"([{"name": "mass", "value": 1, "source": "", "level": "model"},
                                       {"name": "mass", "value": 2, "source": "", "level": "model"}])");
    EXPECT_EQ(set_from_json(twice).error().message(), "attributes[1].name: is there twice");
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
    EXPECT_EQ(facts_from_json(json::parse(R"({"geometry": {"size": [1, 2]}})")).error().where, "facts.geometry.size");
    for (const char* inertia : {"[1, 2, 3]", "[[1, 2, 3], [1, 2]]", "[[1, 2, 3], [1, 2, 3], [1, 2, null]]"}) {
        const json damaged = {{"geometry", {{"unit_inertia", json::parse(inertia)}}}};
        EXPECT_TRUE(facts_from_json(damaged).error().where.starts_with("facts.geometry.unit_inertia")) << inertia;
    }
    EXPECT_EQ(facts_from_json(json::parse(R"({"geometry": {"fitted_rotation": [0, 0, 1]}})")).error().where,
              "facts.geometry.fitted_rotation");
    EXPECT_EQ(facts_from_json(json::parse(R"({"geometry": {"parts": [{}, {"shell": [1, [0, 0, 0]]}]}})")).error().where,
              "facts.geometry.parts[1].shell");
}

// A number inside the registry's range, each end of it, and infinity where that is in range.
double random_number(Random& random, const AttributeDescription& description) {
    const double low = description.low.value_or(-1e6), high = description.high.value_or(1e6);
    const auto choice = random.below(6);
    if (choice == 0) return low;
    if (choice == 1) return description.high ? high : std::numeric_limits<double>::infinity();
    const double number = random.between(low, high);
    return description.whole ? std::floor(number) : number;
}

AttributeValue random_value(Random& random, const AttributeDescription& description) {
    const auto unit = [&] { return random.between(-1, 1); };
    switch (description.type) {
        case ValueType::number:
            return random_number(random, description);
        case ValueType::word:
            if (description.choices.empty()) return std::string("Stühle \"\\\n") + std::to_string(random.next());
            return description.choices[random.below(description.choices.size())];
        case ValueType::truth:
            return random.below(2) == 0;
        case ValueType::vector:
            return Vec3{unit(), unit() / 3, unit() * 1e-300};
        case ValueType::tensor:
            break;
    }
    const double a = 0.1 * unit(), b = 0.1 * unit(), c = 0.1 * unit();
    return Mat3{{1, a, b}, {a, 1 + 1.0 / 3, c}, {b, c, 1.5}};
}

AttributeSet random_set(Random& random) {
    AttributeSet set;
    for (const AttributeDescription& description : registry()) {
        if (random.below(3) == 0) continue;
        AttributeEntry entry{description.name, random_value(random, description)};
        entry.level = static_cast<AttributeLevel>(random.below(7));
        entry.source = "because \t" + std::to_string(random.next());
        if (description.type == ValueType::number && random.below(2) == 0) {
            entry.low = random_number(random, description);
            entry.high = std::numeric_limits<double>::infinity();
        }
        set.put(std::move(entry));
    }
    return set;
}

void expect_same(const AttributeSet& a, const AttributeSet& b) {
    ASSERT_EQ(a.entries().size(), b.entries().size());
    for (std::size_t i = 0; i < a.entries().size(); ++i) {
        const AttributeEntry &one = a.entries()[i], &other = b.entries()[i];
        EXPECT_EQ(one.name, other.name);
        EXPECT_EQ(one.value, other.value) << one.name;
        EXPECT_EQ(one.low, other.low) << one.name;
        EXPECT_EQ(one.high, other.high) << one.name;
        EXPECT_EQ(one.source, other.source) << one.name;
        EXPECT_EQ(one.level, other.level) << one.name;
    }
}

TEST(AttributeJson, RandomSetsReadBackToTheLastBitInEitherForm) {
    Random random(20);
    for (int i = 0; i < 200; ++i) {
        const AttributeSet set = random_set(random);
        for (const AttributeForm form : {AttributeForm::told, AttributeForm::stored}) {
            const auto read = set_from_json(json::parse(to_json(set, form).dump()), "set", form);
            ASSERT_TRUE(read.ok()) << read.error().message();
            expect_same(*read, set);
        }
        for (const AttributeEntry& entry : set.entries()) {
            const auto stored = stored_value_from_json(to_json(entry.value, AttributeForm::stored), "value");
            ASSERT_TRUE(stored.ok()) << entry.name;
            EXPECT_EQ(*stored, entry.value) << entry.name;
        }
    }
}

// Databases hold this text, and programs read it: it must not change.
TEST(AttributeJson, TextsAreThoseOfOlderVersions) {
    AttributeSet set;
    set.put({"kind", std::string("rigid"), {}, {}, "usual", AttributeLevel::category});
    set.put({"mass", 2.5, 1.0, std::numeric_limits<double>::infinity(), "a scale", AttributeLevel::measured});
    set.put({"inertia", Mat3{{1, 0.5, 0}, {0.5, 2, 0}, {0, 0, 3}}, {}, {}, "", AttributeLevel::manual});
    EXPECT_EQ(
        to_json(set, AttributeForm::stored).dump(),
        R"([{"level":"category","name":"kind","source":"usual","word":"rigid"},)"
        R"({"high":"inf","level":"measured","low":1.0,"name":"mass","number":2.5,"source":"a scale"},)"
        R"({"level":"manual","name":"inertia","source":"","tensor":[[1.0,0.5,0.0],[0.5,2.0,0.0],[0.0,0.0,3.0]]}])");
    json told = to_json(set);
    for (json& entry : told)
        for (const char* field : {"help", "label", "kind", "unit"}) EXPECT_EQ(entry.erase(field), 1u);
    EXPECT_EQ(told.dump(),
              R"([{"level":"category","name":"kind","source":"usual","value":"rigid"},)"
              R"({"high":"infinity","level":"measured","low":1.0,"name":"mass","source":"a scale","value":2.5},)"
              R"({"level":"manual","name":"inertia","source":"","value":[1.0,2.0,3.0,0.5,0.0,0.0]}])");
}

TEST(AttributeJson, DamagedStoredSetsNameTheField) {
    const json right = json::parse(R"({"level": "model", "name": "mass", "number": 1, "source": ""})");
    const auto wrong_at = [](const json& entry) {
        const auto read = set_from_json(json::array({entry}), "stored", AttributeForm::stored);
        return read.ok() ? std::string("right") : read.error().where;
    };
    EXPECT_EQ(wrong_at(right), "right");
    for (const auto& [field, value] : {std::pair<const char*, json>{"level", 7},
                                       {"level", "high"},
                                       {"name", json()},
                                       {"source", json::array()},
                                       {"number", "heavy"},
                                       {"low", "x"}}) {
        json damaged = right;
        damaged[field] = value;
        EXPECT_EQ(wrong_at(damaged), std::string("stored[0].") + field);
        if (std::string(field) == "low") continue;
        damaged.erase(field);
        EXPECT_NE(wrong_at(damaged), "right") << field;
    }
    EXPECT_EQ(wrong_at(7), "stored[0]");
}

TEST(AttributeJson, SetsReadBackAlike) {
    for (const char* name : {"Chair", "Curtain", "Palm tree", "White light source", "Teddy bear"}) {
        const AttributeSet set = resolve(shipped_taxonomy(), closed_box(name, {0.5, 0.7, 0.3}));
        const auto read = set_from_json(json::parse(to_json(set).dump()));
        ASSERT_TRUE(read.ok()) << read.error().message();
        expect_same(*read, set);
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
