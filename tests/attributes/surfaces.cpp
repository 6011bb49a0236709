// SPDX-License-Identifier: MIT
#include "attributes/surfaces.h"

#include <gtest/gtest.h>

#include <fstream>

#include "attributes/sample_facts.h"
#include "attributes/to_physics.h"

namespace embody::attributes {
namespace {

const std::vector<MaterialData> known_materials{{.name = "oak"}, {.name = "pine"}, {.name = "steel"}};

Result<Surfaces> loaded(const std::string& text) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const auto file = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".json");
    std::ofstream(file) << text;
    return Surfaces::load(file, known_materials);
}

std::string with_pair(const std::string& pair) {
    return R"({"families": [{"name": "wood", "materials": ["oak", "pine"]}, {"name": "metal", "materials": ["steel"]}],
               "pairs": [)" +
           pair + "]}";
}

std::string pair_row(const std::string& a, const std::string& b, const std::string& sliding) {
    return R"({"a": ")" + a + R"(", "b": ")" + b + R"(", "friction_static": [0.3, 0.5, 0.7], "friction_dynamic": )" +
           sliding + R"(, "restitution": [0.4, 0.5, 0.6], "source": "s"})";
}

TEST(Surfaces, FamiliesShareTheirPairs) {
    const auto surfaces = loaded(with_pair(pair_row("metal", "wood", "[0.2, 0.4, 0.6]")));
    ASSERT_TRUE(surfaces.ok()) << surfaces.error().message();
    ASSERT_NE(surfaces->pair("oak", "steel"), nullptr);
    EXPECT_EQ(surfaces->pair("oak", "steel"), surfaces->pair("steel", "pine"));
    EXPECT_EQ(surfaces->pair("oak", "pine"), nullptr);
    EXPECT_EQ(surfaces->pair("oak", "unobtainium"), nullptr);
    EXPECT_EQ(surfaces->surface_of("unobtainium"), 0);
    const auto* typical = surfaces->table().find(surfaces->surface_of("oak"), surfaces->surface_of("steel"));
    ASSERT_NE(typical, nullptr);
    EXPECT_EQ(typical->friction_dynamic, 0.4);
}

TEST(Surfaces, WhatIsWrongIsNamedByRowAndField) {
    const auto message = [](const std::string& text) {
        const auto surfaces = loaded(text);
        return surfaces.ok() ? std::string() : surfaces.error().message();
    };
    EXPECT_NE(message(with_pair(pair_row("metal", "wool", "[0.2, 0.4, 0.6]"))).find("pairs[0].b: there is no family"),
              std::string::npos);
    EXPECT_NE(
        message(with_pair(pair_row("metal", "wood", "[0.2, 0.6, 0.6]"))).find("friction_dynamic: must not exceed"),
        std::string::npos);
    EXPECT_NE(message(with_pair(pair_row("metal", "wood", "[0.2, 0.4, 0.6]") + "," +
                                pair_row("wood", "metal", "[0.2, 0.4, 0.6]")))
                  .find("stands twice"),
              std::string::npos);
    EXPECT_NE(
        message(R"({"families": [{"name": "a", "materials": ["cheese"]}], "pairs": []})").find("has no \"cheese\""),
        std::string::npos);
    EXPECT_NE(message(R"({"families": [{"name": "a", "materials": ["oak"]}, {"name": "b", "materials": ["oak"]}],
                          "pairs": []})")
                  .find("in another family"),
              std::string::npos);
    EXPECT_NE(message("[]").find("must be an object"), std::string::npos);
}

TEST(Surfaces, TheShippedTableIsCompleteAndHoldsEveryMaterial) {
    const Surfaces& surfaces = shipped_taxonomy().surfaces();
    const std::size_t families = surfaces.families().size();
    EXPECT_GE(families, 25u);
    EXPECT_EQ(surfaces.pairs().size(), families * (families + 1) / 2);
    for (const MaterialData& material : shipped_taxonomy().data().materials) {
        if (material.name == "generic") continue;
        EXPECT_NE(surfaces.surface_of(material.name), 0) << material.name;
    }
}

TEST(Surfaces, OwnNumbersGoBeforeTheTable) {
    AttributeSet set = resolve(shipped_taxonomy(), named("Wooden crate"));
    ASSERT_EQ(set.word("surface_material", ""), "wood");
    const auto usual = body_from_attributes(set, &shipped_taxonomy());
    EXPECT_EQ(usual->material.surface, shipped_taxonomy().surfaces().surface_of("wood"));
    EXPECT_EQ(usual->material.friction_combine, physics::CombineRule::pair_table);
    EXPECT_EQ(usual->material.restitution_combine, physics::CombineRule::pair_table);

    set = with_manual(shipped_taxonomy(), set, {{"friction_dynamic", 0.11, {}, {}, "", AttributeLevel::manual}},
                      named("Wooden crate"));
    const auto own = body_from_attributes(set, &shipped_taxonomy());
    EXPECT_EQ(own->material.friction_combine, physics::CombineRule::geometric_mean);
    EXPECT_EQ(own->material.friction_dynamic, 0.11);
    EXPECT_EQ(own->material.restitution_combine, physics::CombineRule::pair_table);

    // A restitution of the thing's own, set by its category.
    const AttributeSet ball = resolve(shipped_taxonomy(), named("medicine ball", {0.25, 0.25, 0.25}));
    const auto dead = body_from_attributes(ball, &shipped_taxonomy());
    EXPECT_EQ(dead->material.restitution_combine, physics::CombineRule::own);
    EXPECT_EQ(dead->material.restitution, ball.number("restitution", 0));

    // A person's material also sets that material's surface in the pair table.
    set = with_manual(shipped_taxonomy(), resolve(shipped_taxonomy(), named("Wooden crate")),
                      {{"surface_material", std::string("steel"), {}, {}, "", AttributeLevel::manual}},
                      named("Wooden crate"));
    const auto steel = body_from_attributes(set, &shipped_taxonomy());
    EXPECT_EQ(steel->material.surface, shipped_taxonomy().surfaces().surface_of("steel"));
    EXPECT_EQ(steel->material.friction_combine, physics::CombineRule::pair_table);
}

}  // namespace
}  // namespace embody::attributes
