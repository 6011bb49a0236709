// SPDX-License-Identifier: MIT
#include "attributes/resolver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "attributes/check.h"
#include "attributes/physical_kind.h"
#include "attributes/registry.h"
#include "attributes/sample_facts.h"
#include "foundation/random.h"

namespace embody::attributes {
namespace {

AttributeSet resolved(const ModelFacts& facts) { return resolve(shipped_taxonomy(), facts); }

void expect_consistent(const AttributeSet& set, const ModelFacts& facts) {
    for (const Issue& issue : check(set, facts))
        ADD_FAILURE() << facts.name << ": " << issue.attribute << " " << issue.why;
}

TEST(Resolve, NothingKnownGivesDefaultsThatHoldTogether) {
    const ModelFacts facts;
    const AttributeSet set = resolved(facts);
    expect_consistent(set, facts);
    EXPECT_EQ(set.word("category", ""), "object");
    EXPECT_EQ(set.find("category")->level, AttributeLevel::standard);
}

TEST(Resolve, BrokenGeometryNeverBreaksTheSet) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinity, -infinity, -1.0, 0.0, 1e-300, 1e300}) {
        ModelFacts facts = closed_box("Chair", {0.5, 1, 0.5});
        facts.geometry.volume = bad;
        facts.geometry.hull_volume = bad;
        facts.geometry.surface_area = bad;
        facts.geometry.unit_inertia = Mat3::diagonal({bad, bad, bad});
        facts.geometry.center_of_volume = {bad, bad, bad};
        facts.geometry.fitted_error = bad;
        expect_consistent(resolved(facts), facts);
        facts.geometry.size = {bad, bad, bad};
        expect_consistent(resolved(facts), facts);
        facts.geometry.size = {bad, 1, 1};
        expect_consistent(resolved(facts), facts);
    }
}

struct Expected {
    const char* name;
    const char* category;
    const char* subcategory;
    PhysicalKind kind;
};

// Names of real catalogues, and the reason why each is hard.
constexpr Expected real_names[] = {
    {"Chair", "chair", "", PhysicalKind::rigid},
    {"Chair with cushion", "chair", "", PhysicalKind::rigid},     // the first part decides
    {"Oak chair", "chair", "", PhysicalKind::rigid},              // a material in front
    {"Bedside lamp", "lamp", "table lamp", PhysicalKind::rigid},  // the last noun decides
    {"Bedside table", "table", "bedside table", PhysicalKind::rigid},
    {"Coffee table", "table", "coffee table", PhysicalKind::rigid},  // not coffee
    {"Coffee cup", "cup", "", PhysicalKind::rigid},
    {"Coffee mug", "cup", "mug", PhysicalKind::rigid},
    {"Table tennis", "table", "tennis table", PhysicalKind::rigid},  // a phrase, not a table called tennis
    {"Table tennis bat", "racket", "table tennis bat", PhysicalKind::rigid},
    {"Football table", "table", "football table", PhysicalKind::articulated},
    {"Soccer ball", "ball", "football", PhysicalKind::rigid},
    {"Sofa 2 seats", "sofa", "", PhysicalKind::rigid},  // a number ends the noun
    {"Corner sofa", "sofa", "corner sofa", PhysicalKind::rigid},
    {"Piano bench", "bench", "piano bench", PhysicalKind::rigid},
    {"Grand piano", "musical instrument", "grand piano", PhysicalKind::rigid},
    {"Christmas tree", "sculpture", "christmas tree", PhysicalKind::rigid},
    {"Palm tree", "tree", "palm", PhysicalKind::static_body},
    {"Pine under snow", "tree", "conifer", PhysicalKind::static_body},
    {"Hot dog", "prepared dish", "hot dog", PhysicalKind::rigid},  // not a dog
    {"Bulldog", "pet", "dog", PhysicalKind::articulated},
    {"Roasted chicken", "meat", "roast chicken", PhysicalKind::rigid},
    {"Chicken", "bird", "chicken", PhysicalKind::articulated},
    {"Plate, glass and cutlery", "plate", "", PhysicalKind::rigid},
    {"Bowl with fruits", "bowl", "full bowl", PhysicalKind::rigid},
    {"Fridge & Freezer", "refrigerator", "", PhysicalKind::articulated},
    {"Glass door cabinet", "cabinet", "display cabinet", PhysicalKind::articulated},
    {"Double French window small panes", "window", "", PhysicalKind::static_body},
    {"Garage door", "door", "garage door", PhysicalKind::static_body},
    {"Toilet paper dispenser", "paper dispenser", "", PhysicalKind::rigid},
    {"Toilets unit", "toilet", "", PhysicalKind::static_body},
    {"Teddy bear", "toy", "plush toy", PhysicalKind::soft},
    {"Air mattress", "bed", "air mattress", PhysicalKind::soft},
    {"Curtain", "curtain", "", PhysicalKind::cloth},
    {"Towel", "towel", "", PhysicalKind::cloth},
    {"Apple iPhone", "phone", "smartphone", PhysicalKind::rigid},  // not fruit
    {"Glasses", "glasses", "", PhysicalKind::articulated},         // not the plural of glass
    {"Glass", "glass", "", PhysicalKind::rigid},
    {"White light source", "lamp", "light source", PhysicalKind::visual},
    {"Sitting boy", "person", "child", PhysicalKind::articulated},
    {"Car model", "toy", "toy car", PhysicalKind::rigid},
    {"Ford Focus", "car", "", PhysicalKind::articulated},
    {"Shopping basket", "box", "basket", PhysicalKind::rigid},
    {"bedsideTable", "table", "bedside table", PhysicalKind::rigid},
    {"WARDROBES", "wardrobe", "", PhysicalKind::articulated},
};

TEST(Resolve, RealNamesReachTheRightCategoryAndKind) {
    for (const Expected& expected : real_names) {
        const ModelFacts facts = named(expected.name);
        const AttributeSet set = resolved(facts);
        EXPECT_EQ(set.word("category", ""), expected.category) << expected.name;
        EXPECT_EQ(set.word("subcategory", ""), expected.subcategory) << expected.name;
        EXPECT_EQ(kind_of(set), expected.kind) << expected.name;
        expect_consistent(set, facts);
    }
}

struct Weight {
    const char* name;
    Vec3 size;
    double low, high;  // kg
};

TEST(Resolve, MassesAreThoseOfRealThings) {
    const Weight weights[] = {{"Sofa", {2.0, 0.85, 0.9}, 40, 80},
                              {"Chair", {0.48, 0.88, 0.52}, 4, 8},
                              {"Coffee mug", {0.12, 0.095, 0.085}, 0.3, 0.4},
                              {"Fridge", {0.6, 1.75, 0.65}, 50, 90},
                              {"Wardrobe", {1.3, 2.0, 0.6}, 70, 150},
                              {"Bicycle", {0.55, 1.05, 1.75}, 9, 18},
                              {"Soccer ball", {0.22, 0.22, 0.22}, 0.41, 0.45},
                              {"Hatchback", {1.75, 1.45, 4.1}, 900, 1500},
                              {"Child chair", {0.33, 0.58, 0.33}, 1.5, 4}};
    for (const Weight& weight : weights) {
        const double mass = resolved(named(weight.name, weight.size)).number("mass", 0);
        EXPECT_GE(mass, weight.low) << weight.name;
        EXPECT_LE(mass, weight.high) << weight.name;
    }
}

TEST(Resolve, FoldedClothFillsItsBox) {
    const auto mass = [](Vec3 size) { return resolve(shipped_taxonomy(), named("Curtain", size)).number("mass", 0); };
    EXPECT_NEAR(mass({0.3, 0.04, 0.25}), 180 * 0.3 * 0.04 * 0.25, 1e-9);
    EXPECT_LT(mass({0.6, 0.6, 0.1}), 1) << "a small one that hangs";
    EXPECT_GT(mass({1.4, 2.35, 0.12}), 1);
}

TEST(Resolve, ATagThatSaysMoreThanTheNameDecides) {
    ModelFacts facts = named("Cup");
    facts.tags = {"toy cup"};
    EXPECT_EQ(resolve(shipped_taxonomy(), facts).word("subcategory", ""), "plastic cup");
    facts = named("Banana");
    facts.tags = {"fruit"};
    EXPECT_EQ(resolve(shipped_taxonomy(), facts).word("subcategory", ""), "banana");
    facts.tags = {"toy fruit"};
    EXPECT_EQ(resolve(shipped_taxonomy(), facts).word("subcategory", ""), "toy fruit");
    facts = named("Table lamp");
    facts.tags = {"table"};
    EXPECT_EQ(resolve(shipped_taxonomy(), facts).word("category", ""), "lamp");
}

TEST(Resolve, MassGrowsWithSizeAndIntervalHoldsIt) {
    const AttributeSet small = resolved(named("Table", {0.8, 0.7, 0.8}));
    const AttributeSet large = resolved(named("Table", {2.4, 0.75, 1.0}));
    EXPECT_GT(large.number("mass", 0), 1.5 * small.number("mass", 0));
    const AttributeEntry* mass = large.find("mass");
    ASSERT_TRUE(mass->low && mass->high);
    EXPECT_LT(*mass->low, std::get<double>(mass->value));
    EXPECT_GT(*mass->high, std::get<double>(mass->value));
    EXPECT_EQ(mass->level, AttributeLevel::category);
}

TEST(Resolve, SheetsGrowWithTheirArea) {
    const double thin = resolved(named("Rug", {1.5, 0.01, 2.2})).number("mass", 0);
    const double thick = resolved(named("Rug", {1.5, 0.03, 2.2})).number("mass", 0);
    EXPECT_NEAR(thin, thick, 0.1 * thin);
}

TEST(Resolve, WhatHasAnUnusualSizeIsDrawnToWhatAnyThingOfThatSizeWeighs) {
    const auto mass_of = [](const char* name, Vec3 size) { return *resolved(named(name, size)).find("mass"); };
    const auto typical = [](const AttributeEntry& mass) { return std::get<double>(mass.value); };
    const Vec3 usual{0.48, 0.88, 0.52}, tiny{0.048, 0.088, 0.052};
    const AttributeEntry chair = mass_of("chair", usual), small = mass_of("chair", tiny), any = mass_of("xyzzy", tiny);
    EXPECT_EQ(chair.source.find("drawn"), std::string::npos);
    EXPECT_NE(small.source.find("any thing of this size, since its size is unusual"), std::string::npos);
    // The mass is between the category's law and the law of any thing, and less certain.
    const double by_law = typical(chair) * std::pow(0.001, 0.8 * 0.85);
    EXPECT_GT(typical(small), std::min(by_law, typical(any)));
    EXPECT_LT(typical(small), std::max(by_law, typical(any)));
    EXPECT_GT(*small.high / *small.low, 1.5 * *chair.high / *chair.low);
}

TEST(Resolve, AStatedSizeThatNoSuchThingHasLetsATagDecide) {
    ModelFacts facts = named("dragon man", {0.06, 0.09, 0.04});
    facts.tags = {"action figure"};
    facts.size_is_stated = false;
    EXPECT_EQ(resolved(facts).word("category", ""), "person");
    facts.size_is_stated = true;
    EXPECT_EQ(resolved(facts).word("subcategory", ""), "action figure");
}

TEST(Resolve, SolidThingsWeighTheirVolume) {
    const ModelFacts facts = closed_box("Rock", {0.3, 0.2, 0.2});
    const AttributeSet set = resolved(facts);
    EXPECT_NEAR(set.number("mass", 0), 2650 * 0.012, 1e-9);
    EXPECT_EQ(set.find("mass")->level, AttributeLevel::model);
    EXPECT_NE(set.find("mass")->source.find("Mirtich"), std::string::npos);
    EXPECT_EQ(set.find("volume")->level, AttributeLevel::measured);
}

TEST(Resolve, ClosedSurfaceBringsItsMomentsScaledToTheMass) {
    const ModelFacts facts = closed_box("Wooden crate", {0.6, 0.4, 0.5});
    const AttributeSet set = resolved(facts);
    const double scale = set.number("mass", 0) / facts.geometry.volume;
    const Mat3 inertia = std::get<Mat3>(set.find("inertia")->value);
    EXPECT_NEAR(inertia(1, 1), facts.geometry.unit_inertia(1, 1) * scale, 1e-12);
    EXPECT_EQ(set.find("inertia")->level, AttributeLevel::measured);
    EXPECT_EQ(set.word("collision_shape", ""), "box");
}

TEST(Resolve, OpenSurfaceFallsBackToTheBoxAndSaysSo) {
    const AttributeSet set = resolved(named("Chair", {0.5, 0.9, 0.5}));
    EXPECT_NE(set.find("inertia")->source.find("bounding box"), std::string::npos);
    EXPECT_EQ(std::get<Vec3>(set.find("center_of_mass")->value), (Vec3{0, 0.45, 0}));
    EXPECT_EQ(set.word("collision_shape", ""), "convex_hull");
}

TEST(Resolve, PrimitiveThatFitsBadlyIsNotTaken) {
    ModelFacts facts = closed_box("Crate", {0.5, 0.5, 0.5});
    facts.geometry.fitted_error = 0.1;
    EXPECT_EQ(resolved(facts).word("collision_shape", ""), "convex_hull");
}

TEST(Resolve, HollowThingsAreDecomposedAlsoWhereAPrimitiveFitsTheirHull) {
    ModelFacts table = closed_box("Table", {1.4, 0.75, 0.8});
    EXPECT_EQ(resolved(table).word("collision_shape", ""), "box");
    table.geometry.hull_concavity = 0.35;
    EXPECT_EQ(resolved(table).word("collision_shape", ""), "decomposition");
    EXPECT_NE(resolved(table).find("collision_shape")->source.find("350 mm"), std::string::npos);
    // A groove that one does not see counts as none.
    table.geometry.hull_concavity = 0.03;
    EXPECT_EQ(resolved(table).word("collision_shape", ""), "box");
    table.geometry.hull_concavity = 0.35;
    table.movable = false;
    EXPECT_EQ(resolved(table).word("collision_shape", ""), "trimesh");
    EXPECT_EQ(negligible_concavity({0.1, 0.1, 0.1}), usual_hull_error);
    EXPECT_EQ(std::get<double>(describe("hull_error")->standard), usual_hull_error);
}

TEST(Resolve, CataloguesMovableFlagWinsOverTheCategory) {
    ModelFacts facts = named("Radiator");
    EXPECT_EQ(kind_of(resolved(facts)), PhysicalKind::static_body);
    facts.movable = true;
    EXPECT_EQ(kind_of(resolved(facts)), PhysicalKind::rigid);
    EXPECT_NE(resolved(facts).find("kind")->source.find("unlike what is usual"), std::string::npos);
    facts.door_or_window = true;
    EXPECT_EQ(kind_of(resolved(facts)), PhysicalKind::static_body);
    EXPECT_EQ(resolved(facts).word("collision_shape", ""), "trimesh");
}

TEST(Resolve, TagsThenFolderThenCatalogueCategoryTellWhereTheNameDoesNot) {
    ModelFacts facts = named("xyzzy 17");
    facts.catalogue_category = "Kitchen";
    EXPECT_EQ(resolved(facts).word("category", ""), "kitchen thing");
    facts.folder = "models/lamps";
    EXPECT_EQ(resolved(facts).word("category", ""), "lamp");
    facts.tags = {"Default", "Armchair"};
    EXPECT_EQ(resolved(facts).word("subcategory", ""), "armchair");
    EXPECT_EQ(resolved(facts).find("category")->level, AttributeLevel::subcategory);
    EXPECT_NE(resolved(facts).find("category")->source.find("tag says \"armchair\""), std::string::npos);
}

TEST(Resolve, AmbiguityIsReported) {
    const AttributeSet set = resolved(named("Chair and table"));
    EXPECT_EQ(set.word("category", ""), "chair");
    EXPECT_NE(set.find("category")->source.find("it also says \"table\""), std::string::npos);
}

TEST(Resolve, MaterialComesFromNameThenPartsThenCategory) {
    EXPECT_EQ(resolved(named("Table")).word("surface_material", ""), "wood");
    ModelFacts facts = named("Table");
    facts.material_names = {"Material_12", "chrome_legs"};
    EXPECT_EQ(resolved(facts).word("surface_material", ""), "steel");
    facts.name = "Glass table";
    EXPECT_EQ(resolved(facts).word("surface_material", ""), "glass");
    // The words that name the thing do not say its material.
    EXPECT_NE(resolved(named("Paper towel holder")).word("surface_material", ""), "paper");
    EXPECT_EQ(resolved(named("Door with panes")).word("surface_material", ""), "wood");
}

TEST(Resolve, UnusualSizeIsSaidAndTheLikelyUnitNamed) {
    ModelFacts facts = named("Chair", {480, 880, 520});
    facts.size_is_stated = false;
    EXPECT_NE(resolved(facts).find("scale_to_m")->source.find("0.001 m a unit"), std::string::npos);
    EXPECT_EQ(suggested_scale(shipped_taxonomy(), facts), 0.001);
    facts.geometry.size = {0.48, 0.88, 0.52};
    EXPECT_FALSE(suggested_scale(shipped_taxonomy(), facts).has_value());
    facts.geometry.size = {480, 880, 520};
    facts.size_is_stated = true;
    EXPECT_FALSE(suggested_scale(shipped_taxonomy(), facts).has_value());
}

// Seeded facts of all kinds, possible or not: the rules hold for each.
TEST(Resolve, RandomFactsAlwaysHoldTogether) {
    Random random(20261120);
    const auto exponential = [&](double low, double high) { return low * std::pow(high / low, random.unit()); };
    for (int i = 0; i < 3000; ++i) {
        const Expected& thing = real_names[random.below(std::size(real_names))];
        const Vec3 size{exponential(1e-5, 1e4), exponential(1e-5, 1e4), exponential(1e-5, 1e4)};
        ModelFacts facts = random.below(2) == 0 ? named(thing.name, size) : closed_box(thing.name, size);
        facts.geometry.volume *= random.between(0, 1.2);
        facts.geometry.center_of_volume =
            scale(size, {random.between(-0.6, 0.6), random.unit(), random.between(-0.6, 0.6)});
        facts.geometry.closed = random.below(2) == 0;
        if (random.below(3) == 0) facts.movable = random.below(2) == 0;
        if (random.below(3) == 0) facts.material_names = {"lead", "glass"};
        const AttributeSet set = resolved(facts);
        expect_consistent(set, facts);
        if (HasFailure()) FAIL() << "case " << i << ", " << size.x << " " << size.y << " " << size.z;
    }
}

}  // namespace
}  // namespace embody::attributes
