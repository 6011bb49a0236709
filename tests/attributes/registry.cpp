// SPDX-License-Identifier: MIT
#include "attributes/registry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "attributes/physical_kind.h"

namespace embody::attributes {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Validate, UnknownNameSuggestsTheNearest) {
    const auto result = validate("frictoin_static", 0.5);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().where, "frictoin_static");
    EXPECT_EQ(result.error().remedy, "did you mean \"friction_static\"?");
    EXPECT_EQ(validate("Mass", 1.0).error().remedy, "did you mean \"mass\"?");
}

TEST(Validate, NameThatResemblesNothingGetsNoGuess) {
    EXPECT_EQ(validate("qqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqqq", 0.5).error().remedy.find("did you mean"),
              std::string::npos);
    EXPECT_FALSE(validate("", 0.5).ok());
    EXPECT_FALSE(validate(std::string(100000, 'x'), 0.5).ok());
}

TEST(Validate, SaysTheRange) {
    EXPECT_EQ(validate("friction_static", 2.5).error().why, "must be 0 to 2, got 2.5");
    EXPECT_EQ(validate("mass", -2.0).error().why, "must be 1e-06 to 1e+09 kg, got -2");
    EXPECT_EQ(validate("break_impulse", -1.0).error().why, "must be at least 0 N s, got -1");
}

TEST(Validate, RefusesFractionsOfCountsAndNonFiniteNumbers) {
    EXPECT_TRUE(validate("max_hulls", 3.0).ok());
    EXPECT_NE(validate("max_hulls", 2.5).error().message().find("a whole number from 1 to 256"), std::string::npos);
    EXPECT_FALSE(validate("collision_mask", 0.5).ok());
    EXPECT_FALSE(validate("mass", nan).ok());
    EXPECT_FALSE(validate("mass", infinity).ok());
    EXPECT_FALSE(validate("break_impulse", nan).ok());
    EXPECT_FALSE(validate("center_of_mass", Vec3{0, nan, 0}).ok());
    EXPECT_TRUE(validate("break_impulse", infinity).ok());
    EXPECT_FALSE(validate("break_impulse", -infinity).ok());
}

TEST(Validate, RefusesOtherTypes) {
    EXPECT_FALSE(validate("mass", std::string("heavy")).ok());
    EXPECT_FALSE(validate("kinematic", 1.0).ok());
    EXPECT_FALSE(validate("inertia", Vec3{1, 1, 1}).ok());
}

TEST(Validate, WordsAreChoices) {
    EXPECT_EQ(validate("collision_shape", std::string("boks")).error().why,
              "must be one of box, sphere, capsule, cylinder, convex_hull, decomposition, trimesh, got \"boks\"");
    EXPECT_TRUE(validate("collision_shape", std::string("box")).ok());
    EXPECT_TRUE(validate("category", std::string("anything")).ok());
}

TEST(Validate, InertiaIsThatOfAPossibleBody) {
    EXPECT_TRUE(validate("inertia", Mat3::diagonal({1, 2, 3})).ok());
    EXPECT_FALSE(validate("inertia", Mat3::diagonal({1, 1, 3})).ok());
    EXPECT_FALSE(validate("inertia", Mat3::diagonal({1, -1, 1})).ok());
    EXPECT_FALSE(validate("inertia", Mat3::zero()).ok());
    EXPECT_FALSE(validate("inertia", Mat3{{1, 0.1, 0}, {0, 1, 0}, {0, 0, 1}}).ok());
}

TEST(ParseValue, RefusesWhatItCannotRead) {
    for (const char* text : {"", "heavy", "1,2", "0.5x", "nan", "1e999", "--1"}) {
        EXPECT_FALSE(parse_value("mass", text).ok()) << text;
    }
    for (const char* text : {"", "1,2", "1,2,3,4", "a,b,c", "1,,3"}) {
        EXPECT_FALSE(parse_value("center_of_mass", text).ok()) << text;
    }
    EXPECT_FALSE(parse_value("kinematic", "perhaps").ok());
    EXPECT_FALSE(parse_value("inertia", "1,2,3,4").ok());
    EXPECT_FALSE(parse_value("no_such_thing", "1").ok());
}

TEST(ParseValue, ReadsEachType) {
    EXPECT_EQ(parse_value("mass", " 2.5 ").value(), AttributeValue(2.5));
    EXPECT_EQ(parse_value("surface_material", "oak").value(), AttributeValue(std::string("oak")));
    EXPECT_EQ(parse_value("kinematic", "yes").value(), AttributeValue(true));
    EXPECT_EQ(parse_value("center_of_mass", "1, 2,3").value(), AttributeValue(Vec3{1, 2, 3}));
    EXPECT_EQ(parse_value("inertia", "1,2,2.5").value(), AttributeValue(Mat3::diagonal({1, 2, 2.5})));
    EXPECT_EQ(parse_value("break_energy", "infinity").value(), AttributeValue(infinity));
}

TEST(ParseValue, ReadsBackEveryStandardValue) {
    for (const AttributeDescription& description : registry()) {
        const auto read = parse_value(description.name, to_text(description.standard));
        ASSERT_TRUE(read.ok()) << description.name << ": " << read.error().message();
        EXPECT_EQ(*read, description.standard) << description.name;
    }
}

TEST(ParseValue, ReadsBackFullTensorsToTheLastDigit) {
    const Mat3 inertia{{1.1, 0.1 / 3, -0.2}, {0.1 / 3, 1.7, 0.3}, {-0.2, 0.3, 1.9}};
    EXPECT_EQ(parse_value("inertia", to_text(inertia)).value(), AttributeValue(inertia));
}

TEST(Registry, EveryRowIsCompleteAndItsStandardValid) {
    std::set<std::string> names;
    for (const AttributeDescription& d : registry()) {
        EXPECT_TRUE(names.insert(d.name).second) << d.name << " is there twice";
        EXPECT_TRUE(validate(d.name, d.standard).ok()) << d.name;
        EXPECT_FALSE(d.label.empty() || d.help.empty() || d.kind.empty() || d.applies_to.empty()) << d.name;
        EXPECT_EQ(d.help.back(), '.') << d.name;
        EXPECT_EQ(d.applies_to.find_first_not_of(every_kind.data()), std::string::npos) << d.name;
        EXPECT_EQ(describe(d.name), &d);
    }
    EXPECT_GE(names.size(), 60u);
    EXPECT_EQ(describe("masss"), nullptr);
}

TEST(Levels, NamesReadBackAndOrderIsBySpecificity) {
    for (int i = 0; i <= static_cast<int>(AttributeLevel::manual); ++i) {
        const auto level = static_cast<AttributeLevel>(i);
        EXPECT_EQ(level_from_name(level_name(level)), level);
    }
    EXPECT_FALSE(level_from_name("standard").has_value());
    EXPECT_LT(AttributeLevel::measured, AttributeLevel::manual);
}

TEST(AttributeSet, LowerLevelNeverReplacesHigher) {
    AttributeSet set;
    EXPECT_TRUE(set.put({"mass", 2.0, {}, {}, "a person", AttributeLevel::manual}));
    EXPECT_FALSE(set.put({"mass", 3.0, {}, {}, "a scale", AttributeLevel::measured}));
    EXPECT_EQ(set.number("mass", 0), 2.0);
    EXPECT_TRUE(set.put({"mass", 4.0, {}, {}, "a person", AttributeLevel::manual}));
    EXPECT_EQ(set.number("mass", 0), 4.0);
    set.erase("mass");
    EXPECT_EQ(set.find("mass"), nullptr);
}

TEST(AttributeSet, KeepsTheRegistrysOrder) {
    AttributeSet set;
    for (const char* name : {"no_such_name", "restitution", "mass", "kind", "friction_static"})
        set.put({name, 1.0, {}, {}, "", {}});
    std::string order;
    for (const AttributeEntry& entry : set.entries()) order += entry.name + " ";
    EXPECT_EQ(order, "kind mass friction_static restitution no_such_name ");
}

TEST(AttributeSet, WrongTypeOrMissingGivesTheFallback) {
    AttributeSet set;
    set.put({"mass", std::string("heavy"), {}, {}, "", {}});
    EXPECT_EQ(set.number("mass", 7), 7);
    EXPECT_EQ(kind_of(set), PhysicalKind::rigid);
    EXPECT_TRUE(set.truth("mass", true));
}

}  // namespace
}  // namespace embody::attributes
