// SPDX-License-Identifier: MIT
#include "attributes/material_parts.h"

#include <gtest/gtest.h>

#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

geometry::SolidAndShell box_form(Vec3 size, Vec3 center) {
    const Vec3 s = scale(size, size);
    geometry::SolidAndShell form;
    form.solid.volume = size.x * size.y * size.z;
    form.solid.center = form.shell.center = center;
    form.solid.inertia = Mat3::diagonal({s.y + s.z, s.x + s.z, s.x + s.y}) * (form.solid.volume / 12);
    // A box of six plates.
    const double ab = size.x * size.y, bc = size.y * size.z, ca = size.z * size.x;
    form.shell.volume = 2 * (ab + bc + ca);
    const Vec3 second{(s.x * (ab + ca) / 6 + s.x * bc / 2), (s.y * (ab + bc) / 6 + s.y * ca / 2),
                      (s.z * (bc + ca) / 6 + s.z * ab / 2)};
    form.shell.inertia = Mat3::diagonal({second.y + second.z, second.x + second.z, second.x + second.y});
    return form;
}

// A glass plate of 1 cm on a steel column with a foot of stone: 1 m high.
ModelFacts small_table() {
    ModelFacts facts = named("bistro table", {0.6, 1, 0.6});
    GeometryFacts& g = facts.geometry;
    g.parts = {{"Top_glass", box_form({0.6, 0.01, 0.6}, {0, 0.995, 0})},
               {"stone_foot", box_form({0.4, 0.04, 0.4}, {0, 0.02, 0})},
               {"Chrome", box_form({0.06, 0.95, 0.06}, {0, 0.515, 0})}};
    for (const PartFacts& part : g.parts) {
        g.surface_area += part.form.shell.volume;
        g.volume += part.form.solid.volume;
    }
    return facts;
}

struct Choices {
    Classification what;
    MaterialChoice surface;
    std::vector<MaterialPart> parts;
};
Choices choose(const ModelFacts& facts) {
    const Taxonomy::Data& data = shipped_taxonomy().data();
    Choices result;
    result.what = classify(data, facts);
    result.surface = choose_material(data, facts, result.what);
    result.parts = material_parts(data, facts, *result.what.category, result.surface);
    return result;
}

TEST(MaterialParts, EachIsOfWhatItsNameSays) {
    const ModelFacts facts = small_table();
    const Choices table = choose(facts);
    ASSERT_EQ(table.parts.size(), 3u);
    EXPECT_EQ(table.parts[0].material->name, "glass");
    EXPECT_EQ(table.parts[1].material->name, "stone");
    EXPECT_EQ(table.parts[1].usual_wall, 0) << "stone is solid";
    EXPECT_EQ(table.parts[2].material->name, "steel");

    // A name that says no material: the part has the material of the whole.
    ModelFacts plain = facts;
    for (PartFacts& part : plain.geometry.parts) part.material = "Material.001";
    for (const MaterialPart& part : choose(plain).parts) EXPECT_EQ(part.material, choose(plain).surface.material);
}

TEST(MaterialParts, DensityIsTheSumOverTheParts) {
    const ModelFacts facts = small_table();
    const Choices table = choose(facts);
    // Material volumes: the plate's walls of 4 mm on both sides, the foot solid, the column a tube.
    const auto& [glass, stone, steel] = std::tie(table.parts[0], table.parts[1], table.parts[2]);
    const double glass_volume = std::min(0.0036, glass.usual_wall * glass.facts->form.shell.volume);
    const double steel_volume = steel.usual_wall * steel.facts->form.shell.volume;
    const double stone_volume = 0.0064;
    const double mass = glass.material->density.typical * glass_volume +
                        stone.material->density.typical * stone_volume + steel.material->density.typical * steel_volume;
    const Substance substance = substance_of(table.parts, table.surface);
    EXPECT_NEAR(substance.density.typical, mass / (glass_volume + stone_volume + steel_volume), 1e-9 * mass);
    EXPECT_LT(substance.density.low, substance.density.typical);
    EXPECT_GT(substance.density.high, substance.density.typical);
    EXPECT_TRUE(substance.name.starts_with("stone 6")) << substance.name;

    const AttributeSet set = resolve(shipped_taxonomy(), facts);
    EXPECT_DOUBLE_EQ(set.number("density", 0), substance.density.typical);
    EXPECT_NEAR(set.number("density", 0) * set.number("fill_fraction", 0) * set.number("volume", 0),
                set.number("mass", 0), 1e-9 * set.number("mass", 0));
}

TEST(MaterialParts, AHeavyFootDrawsTheCentreDown) {
    const ModelFacts facts = small_table();
    const auto center = [](const AttributeSet& set) { return std::get<Vec3>(set.find("center_of_mass")->value); };
    const AttributeSet set = resolve(shipped_taxonomy(), facts);
    EXPECT_LT(center(set).y, 0.45);
    EXPECT_TRUE(set.find("center_of_mass")->source.starts_with("spread over its parts")) << set.find("inertia")->source;

    // With one material for all parts, the plate on top has a larger fraction of the mass, compared with the foot.
    ModelFacts wooden = facts;
    for (PartFacts& part : wooden.geometry.parts) part.material = "oak";
    EXPECT_GT(center(resolve(shipped_taxonomy(), wooden)).y, center(set).y + 0.05);
}

TEST(MaterialParts, AHollowBoxTurnsLikeItsPlatesAndAFullOneLikeASolid) {
    const Vec3 size{1, 1, 1};
    ModelFacts facts = named("crate", size);
    facts.geometry.parts = {{"oak", box_form(size, {0, 0.5, 0})}};
    const Choices crate = choose(facts);
    const auto turning = [&](double mass) { return spread_over(crate.parts, mass)->inertia(1, 1) / mass; };
    // The moment of inertia is 1/6 for a solid cube, 5/18 for a thin cubic shell.
    EXPECT_NEAR(turning(1), 5.0 / 18, 2e-3);
    EXPECT_NEAR(turning(300), (1.0 / 6 + 5.0 / 18) / 2, 1e-6) << "half full: 300 kg of the 600 of a wooden cube";
    EXPECT_FALSE(spread_over(crate.parts, 700)) << "full: the form of the whole says it all";
}

TEST(MaterialParts, ACoverIsFilledWithItsCore) {
    ModelFacts facts = named("sofa", {2, 0.8, 0.9});
    facts.geometry.parts = {{"blue fabric", box_form({2, 0.8, 0.9}, {0, 0.4, 0})}};
    const Choices sofa = choose(facts);
    ASSERT_NE(sofa.parts[0].core, nullptr);
    EXPECT_EQ(sofa.parts[0].core->name, "foam");
    // The mean density of cover and filling is far below that of the cover.
    EXPECT_LT(substance_of(sofa.parts, sofa.surface).density.typical, 100);
}

TEST(MaterialParts, BadPartsDoNoHarm) {
    ModelFacts facts = small_table();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan, 1e300}) {
        for (PartFacts& part : facts.geometry.parts) {
            part.form.shell.inertia = Mat3::diagonal({bad, bad, bad});
            part.form.solid.inertia = Mat3::diagonal({bad, bad, bad});
            part.form.shell.volume = bad;
        }
        const AttributeSet set = resolve(shipped_taxonomy(), facts);
        const Mat3 inertia = std::get<Mat3>(set.find("inertia")->value);
        EXPECT_GT(inertia(0, 0), 0);
        EXPECT_TRUE(std::isfinite(inertia(0, 0)));
        EXPECT_TRUE(std::isfinite(set.number("density", nan)));
    }
}

}  // namespace
}  // namespace embody::attributes
