// SPDX-License-Identifier: MIT
#include "attributes/plausible.h"

#include <gtest/gtest.h>

#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/sample_facts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

/// A crate whose values a person sets.
class Plausible : public testing::Test {
protected:
    std::vector<Issue> issues(const std::vector<std::pair<std::string, AttributeValue>>& own) const {
        std::vector<AttributeEntry> entries;
        for (const auto& [name, value] : own) entries.push_back({name, value, {}, {}, "", AttributeLevel::manual});
        return find_implausible(with_manual(shipped_taxonomy(), automatic_, entries, facts_), automatic_, around_);
    }
    // The attributes with an issue, each once.
    std::string told(const std::vector<std::pair<std::string, AttributeValue>>& own) const {
        std::string names;
        for (const Issue& issue : issues(own)) names += (names.empty() ? "" : " ") + issue.attribute;
        return names;
    }
    [[nodiscard]] double high(const char* name) const { return *automatic_.find(name)->high; }
    [[nodiscard]] double low(const char* name) const { return *automatic_.find(name)->low; }

    ModelFacts facts_ = closed_box("Crate", {0.6, 0.5, 0.5});
    AttributeSet automatic_ = resolve(shipped_taxonomy(), facts_);
    Circumstances around_{{{-0.3, 0, -0.25}, {0.3, 0.5, 0.25}}};
};

TEST_F(Plausible, NoAutomaticSetHasAnIssue) {
    int compared = 0;
    for (const CategoryData& category : shipped_taxonomy().data().categories) {
        const AttributeSet set = resolve(shipped_taxonomy(), named(category.name, category.at_size));
        const Vec3 half = category.at_size * 0.5;
        for (const Issue& issue : find_implausible(set, set, {{-half, half}, 1.0 / 240, 9.81, false}))
            ADD_FAILURE() << category.name << " " << issue.attribute << " " << issue.why;
        ++compared;
    }
    EXPECT_GT(compared, 500);
    EXPECT_EQ(told({}), "");
}

TEST_F(Plausible, AMassFarOutsideTheIntervalIsTold) {
    EXPECT_EQ(told({{"mass", 9.9 * high("mass")}}), "");
    EXPECT_EQ(told({{"mass", 10.1 * high("mass")}}), "mass");
    EXPECT_EQ(told({{"mass", low("mass") / 9.9}}), "");
    EXPECT_EQ(told({{"mass", low("mass") / 10.1}}), "mass");
    const std::string why = issues({{"mass", 20 * high("mass")}}).front().why;
    EXPECT_NE(why.find("20 times more than what such things weigh"), std::string::npos) << why;
}

TEST_F(Plausible, ASofaOfABillionKilogramsIsDenserThanOsmium) {
    const auto found = issues({{"mass", 1e9}});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(found.front().why.find("denser than osmium"), std::string::npos) << found.front().why;
    EXPECT_EQ(found.front().why.substr(0, 7), "1e9 kg ");
}

TEST_F(Plausible, LighterThanAirIsTold) {
    // Without an interval, as of a primitive.
    AttributeSet exact = automatic_;
    exact.erase("mass");
    exact.put({"mass", 100.0, {}, {}, "exact", AttributeLevel::measured});
    AttributeSet light = exact;
    light.put({"mass", 0.1, {}, {}, "set", AttributeLevel::manual});
    ASSERT_GT(light.number("volume", 0), 0.1);
    EXPECT_EQ(find_implausible(light, exact, around_).size(), 1u);
    light.erase("mass");
    light.put({"mass", 1.0, {}, {}, "set", AttributeLevel::manual});
    EXPECT_TRUE(find_implausible(light, exact, around_).empty());
}

TEST_F(Plausible, ADensityFarFromTheMaterialOrBelowAerogelIsTold) {
    EXPECT_EQ(told({{"density", 2.9 * high("density")}, {"mass", automatic_.number("mass", 0)}}), "");
    EXPECT_EQ(told({{"density", 3.1 * high("density")}, {"mass", automatic_.number("mass", 0)}}), "density");
    EXPECT_EQ(told({{"density", 0.5}, {"mass", automatic_.number("mass", 0)}}), "density");
}

TEST_F(Plausible, FrictionAndBounceBeyondAllSurfacesAreTold) {
    EXPECT_EQ(told({{"friction_static", 1.9}}), "friction_static");
    EXPECT_EQ(told({{"friction_static", 0.6}, {"friction_dynamic", 0.5}}), "");
    EXPECT_EQ(told({{"friction_dynamic", 0.01}}), "friction_dynamic");
    EXPECT_EQ(told({{"restitution", 0.99}}), "restitution");
    EXPECT_EQ(told({{"restitution", 0.97}}), "");
}

TEST_F(Plausible, ACenterOfMassOutsideTheBoxIsTold) {
    EXPECT_EQ(told({{"center_of_mass", Vec3{0.29, 0.5, -0.24}}}), "");
    const auto found = issues({{"center_of_mass", Vec3{0.3, 0.75, 0}}});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found.front().why, "lies 0.25 m outside the thing");
}

TEST_F(Plausible, InertiaThatNoBodyHasIsRefusedAtOnce) {
    EXPECT_TRUE(validate("inertia", Mat3::diagonal({1, 2, 2.9})).ok());
    EXPECT_FALSE(validate("inertia", Mat3::diagonal({1, 2, 3.1})).ok());
    EXPECT_FALSE(validate("inertia", Mat3::diagonal({1, -2, 3})).ok());
    // Turned into other axes it is the same body.
    const Mat3 turn = to_matrix(normalized(Quat{0.3, -0.2, 0.5, 0.7}));
    EXPECT_FALSE(validate("inertia", turn * Mat3::diagonal({1, 2, 3.1}) * transpose(turn)).ok());
}

TEST_F(Plausible, ASoftThingIsNeitherOfSteelNorOfSlime) {
    const auto soft = [](double stiffness) -> std::vector<std::pair<std::string, AttributeValue>> {
        return {{"kind", to_value(PhysicalKind::soft)}, {"youngs_modulus", stiffness}};
    };
    EXPECT_EQ(told(soft(1e5)), "");
    EXPECT_EQ(told(soft(2e11)), "youngs_modulus");
    EXPECT_NE(issues(soft(2e11)).front().why.find("looks rigid"), std::string::npos);
    EXPECT_EQ(told(soft(200)), "youngs_modulus");
    EXPECT_NE(issues(soft(200)).front().why.find("own weight"), std::string::npos);
    // What gives way on Earth holds without weight.
    const double half_strain = 2 * automatic_.number("density", 0) * 9.81 * 0.5;
    EXPECT_EQ(told(soft(0.9 * half_strain)), "youngs_modulus");
    EXPECT_EQ(told(soft(1.1 * half_strain)), "");
}

TEST_F(Plausible, WhatFallsThroughTheFloorIsTold) {
    EXPECT_EQ(told({{"collision_mask", 0.0}}), "collision_mask");
    EXPECT_EQ(told({{"collision_mask", 2.0}}), "");
    EXPECT_EQ(told({{"collision_mask", 0.0}, {"gravity_factor", 0.0}}), "");
    EXPECT_EQ(told({{"collision_mask", 0.0}, {"kind", to_value(PhysicalKind::static_body)}}), "");
}

TEST_F(Plausible, ArticulatedThingsNeedAJoint) {
    const std::vector<std::pair<std::string, AttributeValue>> own{{"kind", to_value(PhysicalKind::articulated)}};
    EXPECT_EQ(told(own), "");
    around_.has_joint = false;
    EXPECT_EQ(told(own), "kind");
}

TEST(ReadableNumber, IsWrittenForPeople) {
    EXPECT_EQ(readable_number(1e9), "1e9");
    EXPECT_EQ(readable_number(12345), "12300");
    EXPECT_EQ(readable_number(999999), "1e6");
    EXPECT_EQ(readable_number(0.25), "0.25");
    EXPECT_EQ(readable_number(-74.26), "-74.3");
    EXPECT_EQ(readable_number(1e-9), "1e-9");
}

}  // namespace
}  // namespace embody::attributes
