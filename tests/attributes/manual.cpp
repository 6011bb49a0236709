// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "attributes/check.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/resolver.h"
#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

AttributeEntry manual(std::string name, AttributeValue value) {
    return {std::move(name), std::move(value), {}, {}, "", AttributeLevel::manual};
}

struct Case {
    ModelFacts facts = closed_box("Crate", {0.6, 0.5, 0.5});
    AttributeSet automatic = resolve(shipped_taxonomy(), facts);

    [[nodiscard]] AttributeSet with(const std::vector<AttributeEntry>& entries) const {
        return with_manual(shipped_taxonomy(), automatic, entries, facts);
    }
};

TEST(KnownValue, AMaterialIsNamedByItsWordsOrRefused) {
    const auto known = [](const char* name, AttributeValue value) {
        return known_value(shipped_taxonomy(), name, std::move(value));
    };
    EXPECT_EQ(known("surface_material", std::string("steel")).value(), AttributeValue(std::string("steel")));
    EXPECT_EQ(known("surface_material", std::string("oak")).value(), AttributeValue(std::string("wood")));
    const auto refused = known("surface_material", std::string("unobtainium"));
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message().find("steel"), std::string::npos);
    EXPECT_EQ(known("category", std::string("unobtainium")).value(), AttributeValue(std::string("unobtainium")));
    EXPECT_EQ(known("mass", 2.0).value(), AttributeValue(2.0));
    const Case crate;
    const AttributeSet set = crate.with({manual("surface_material", std::string("mahogany"))});
    EXPECT_EQ(set.word("surface_material", ""), "wood");
    EXPECT_EQ(set.find("surface_material")->level, AttributeLevel::manual);
}

TEST(WithManual, LeavesOutWhatValidateRefuses) {
    const Case crate;
    const AttributeSet set =
        crate.with({manual("mass", -1.0), manual("masss", 1.0), manual("mass", std::string("heavy"))});
    EXPECT_EQ(set.number("mass", 0), crate.automatic.number("mass", 0));
    EXPECT_EQ(set.find("masss"), nullptr);
}

TEST(WithManual, ContradictionStaysAndCheckNamesIt) {
    const Case crate;
    const AttributeSet set = crate.with(
        {manual("mass", 1000.0), manual("density", 1.0), manual("fill_fraction", 0.5), manual("volume", 1.0)});
    const auto issues = check(set, crate.facts);
    ASSERT_FALSE(issues.empty());
    EXPECT_EQ(issues.front().attribute, "mass");
}

TEST(WithManual, MassBringsDensityAndScalesInertia) {
    const Case crate;
    const double before = crate.automatic.number("mass", 0);
    const AttributeSet set = crate.with({manual("mass", 2 * before)});
    EXPECT_DOUBLE_EQ(set.number("density", 0), 2 * crate.automatic.number("density", 0));
    const Mat3 inertia = std::get<Mat3>(set.find("inertia")->value);
    EXPECT_NEAR(inertia(0, 0), 2 * std::get<Mat3>(crate.automatic.find("inertia")->value)(0, 0), 1e-12);
    EXPECT_EQ(set.find("mass")->level, AttributeLevel::manual);
    EXPECT_EQ(set.find("mass")->source, "set by a person");
    EXPECT_TRUE(check(set, crate.facts).empty());
}

TEST(WithManual, HeavierThanAnyMaterialFillsUp) {
    const Case crate;
    // 0.15 m³ in a material at fill 0.1 would need more than osmium's density.
    const AttributeSet set = crate.with({manual("mass", 3000.0)});
    EXPECT_LE(set.number("density", 0), 22600);
    EXPECT_TRUE(check(set, crate.facts).empty());
}

TEST(WithManual, DensityFillAndBulkDensityBringTheMass) {
    const Case crate;
    const double before = crate.automatic.number("mass", 0);
    const double density = crate.automatic.number("density", 0);
    EXPECT_NEAR(crate.with({manual("density", 2 * density)}).number("mass", 0), 2 * before, 1e-9);
    EXPECT_NEAR(crate.with({manual("fill_fraction", 1.0)}).number("mass", 0), density * 0.15, 1e-9);
    EXPECT_NEAR(crate.with({manual("bulk_density", 100.0)}).number("mass", 0), 15, 1e-9);
    for (const char* name : {"density", "bulk_density"}) {
        EXPECT_TRUE(check(crate.with({manual(name, 100.0)}), crate.facts).empty()) << name;
    }
}

TEST(WithManual, MassAndDensityTogetherBringTheFill) {
    const Case crate;
    const AttributeSet set = crate.with({manual("mass", 30.0), manual("density", 1000.0)});
    EXPECT_NEAR(set.number("fill_fraction", 0), 30.0 / (1000 * 0.15), 1e-12);
    EXPECT_TRUE(check(set, crate.facts).empty());
}

TEST(WithManual, FrictionThatNobodySetGivesWay) {
    const Case crate;
    const AttributeSet low = crate.with({manual("friction_static", 0.1)});
    EXPECT_EQ(low.number("friction_dynamic", 1), 0.1);
    EXPECT_NE(low.find("friction_dynamic")->source.find("lowered"), std::string::npos);
    const AttributeSet high = crate.with({manual("friction_dynamic", 1.5)});
    EXPECT_EQ(high.number("friction_static", 0), 1.5);
}

TEST(WithManual, SurfaceMaterialBringsItsNumbers) {
    const Case crate;
    const AttributeSet set = crate.with({manual("surface_material", std::string("steel"))});
    EXPECT_EQ(set.number("density", 0), 7850);
    EXPECT_GT(set.number("mass", 0), 5 * crate.automatic.number("mass", 0));
    EXPECT_EQ(set.number("friction_rolling", 0), 0.0005);
    EXPECT_TRUE(check(set, crate.facts).empty());
}

TEST(WithManual, KindChangesShapeAndAttributes) {
    const Case crate;
    const AttributeSet fixed = crate.with({manual("kind", to_value(PhysicalKind::static_body))});
    EXPECT_EQ(fixed.word("collision_shape", ""), "trimesh");
    EXPECT_EQ(fixed.find("linear_damping"), nullptr);
    const AttributeSet cloth = crate.with({manual("kind", to_value(PhysicalKind::cloth))});
    EXPECT_NE(cloth.find("stretch_stiffness"), nullptr);
    EXPECT_TRUE(check(fixed, crate.facts).empty());
    EXPECT_TRUE(check(cloth, crate.facts).empty());

    // The reverse: a person makes a static thing movable.
    const ModelFacts door = named("Door", {0.9, 2.05, 0.1});
    const AttributeSet freed =
        with_manual(resolve(shipped_taxonomy(), door), {manual("kind", to_value(PhysicalKind::rigid))}, door);
    EXPECT_EQ(freed.word("collision_shape", ""), "convex_hull");
    EXPECT_NE(freed.find("linear_damping"), nullptr);
    EXPECT_TRUE(check(freed, door).empty());
}

TEST(WithManual, NoEntriesChangeNothing) {
    const Case crate;
    const AttributeSet set = crate.with({});
    ASSERT_EQ(set.entries().size(), crate.automatic.entries().size());
    for (const AttributeEntry& entry : crate.automatic.entries()) EXPECT_EQ(set.find(entry.name)->value, entry.value);
}

}  // namespace
}  // namespace embody::attributes
