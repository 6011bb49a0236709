// SPDX-License-Identifier: MIT
// A category may change the kind and the form of a primitive.
#include <gtest/gtest.h>

#include "attributes/assemble.h"
#include "attributes/physical_kind.h"
#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

/// A box about the origin, as primitives are.
ModelFacts box(Vec3 size) {
    ModelFacts facts = closed_box("", size);
    facts.geometry.center_of_volume = {};
    return facts;
}

struct Stuff {
    const char* category;
    PhysicalKind kind;
    const char* number;  ///< attribute of its matter …
    double low, high;    ///< … and the range that it must lie in
};

TEST(PrimitiveOfCategory, IsOfItsKindAndMatter) {
    const Stuff list[] = {{"water", PhysicalKind::fluid, "rest_density", 990, 1000},
                          {"honey", PhysicalKind::fluid, "dynamic_viscosity", 1, 100},
                          {"Olive oil", PhysicalKind::fluid, "rest_density", 900, 930},
                          {"beer", PhysicalKind::fluid, "rest_density", 1000, 1020},
                          {"sand", PhysicalKind::granular, "friction_angle", 25, 45},
                          {"curtain", PhysicalKind::cloth, "area_density", 0.05, 0.5},
                          {"rope", PhysicalKind::rope, "linear_density", 0.02, 0.3},
                          {"cushion", PhysicalKind::soft, "youngs_modulus", 1e3, 1e5}};
    for (const Stuff& stuff : list) {
        const auto set = resolve_primitive(shipped_taxonomy(), stuff.category, box({0.4, 0.4, 0.4}));
        ASSERT_TRUE(set) << stuff.category;
        EXPECT_EQ(kind_of(*set), stuff.kind) << stuff.category;
        EXPECT_GE(set->number(stuff.number, -1), stuff.low) << stuff.category;
        EXPECT_LE(set->number(stuff.number, 1e9), stuff.high) << stuff.category;
        EXPECT_GE(set->find(stuff.number)->level, AttributeLevel::category) << stuff.category;
        EXPECT_EQ(set->find("collision_shape"), nullptr) << "it collides as what it is";
        EXPECT_NE(set->find("category")->source.find(stuff.category), std::string::npos);
    }
}

TEST(PrimitiveOfCategory, IsWhatItsShapeSaysWhereThatIsRigidOrNobodyKnowsTheWord) {
    for (const char* category : {"chair", "wall", "domino", "flibbertigibbet", "", "a shot in the dark", "honey jar"})
        EXPECT_FALSE(resolve_primitive(shipped_taxonomy(), category, box({0.4, 0.4, 0.4}))) << category;
}

// Mass of cloth by its area, of a rope by its length, of liquids and bulk by their own density.
TEST(PrimitiveOfCategory, WeighsByWhatItIsMadeOf) {
    const auto mass = [](const char* category, Vec3 size) {
        const ModelFacts facts = box(size);
        AttributeSet set = resolve_primitive(shipped_taxonomy(), category, facts).value();
        put_mass_of_primitive(set, facts.geometry);
        return set.number("mass", 0);
    };
    const auto usual = [](const char* category, const char* name) {
        return resolve_primitive(shipped_taxonomy(), category, box({1, 1, 1}))->number(name, 0);
    };
    EXPECT_NEAR(mass("curtain", {2, 1.5, 0.002}), 3 * usual("curtain", "area_density"), 1e-9);
    EXPECT_NEAR(mass("rope", {0.02, 3, 0.02}), 3 * usual("rope", "linear_density"), 1e-9);
    EXPECT_NEAR(mass("honey", {0.1, 0.1, 0.1}), 0.001 * usual("honey", "rest_density"), 1e-9);
    EXPECT_NEAR(mass("sand", {0.1, 0.1, 0.1}), 0.001 * loose_packing * usual("sand", "grain_density"), 1e-9);

    // Its moments are those of the box about its own middle.
    const auto cushion = resolve_primitive(shipped_taxonomy(), "cushion", box({0.4, 0.1, 0.4}));
    const double kilograms = cushion->number("mass", 0);
    EXPECT_LT(kilograms, 4) << "16 litres of foam, not of water";
    EXPECT_EQ(std::get<Vec3>(cushion->find("center_of_mass")->value), Vec3{});
    const Mat3 inertia = std::get<Mat3>(cushion->find("inertia")->value);
    EXPECT_NEAR(inertia(1, 1), kilograms * (0.16 + 0.16) / 12, 1e-9);
}

}  // namespace
}  // namespace embody::attributes
