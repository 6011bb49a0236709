// SPDX-License-Identifier: MIT
// Plastic strain and broken segments, taken from one deformable and given to another.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "foundation/random.h"
#include "make_world.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/inter/world.h"

namespace embody::physics {
namespace {

DeformableDefinition clay_box() {
    DeformableDefinition clay = tetrahedral_brick({0.2, 0.2, 0.2}, {2, 2, 2}, {.density = 1500, .youngs_modulus = 3e5});
    std::get<SoftSolid>(clay.matter).yield_stress = 3e3;
    std::get<SoftSolid>(clay.matter).rayleigh_damping = 0.01;
    return clay;
}

WorldSettings weightless() {
    WorldSettings settings;
    settings.gravity = {};
    return settings;
}

// Two that are put into one form go on alike if they have the same plastic strain, and not else.
TEST(LastingDeformation, OfAnotherSolidMakesItGoOnAlike) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const auto world = make_world(weightless());
        const DeformableDefinition clay = clay_box();
        const DeformableHandle dented = world->create_deformable(clay).value();
        EXPECT_TRUE(world->lasting_deformation(dented).plastic_strain.empty());
        std::vector<Vec3> squeezed = clay.nodes;
        for (Vec3& node : squeezed)
            node += 0.01 * Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const std::vector<Vec3> rest(squeezed.size());
        ASSERT_TRUE(world->set_nodes(dented, squeezed, rest));
        for (int i = 0; i < 60; ++i) world->step();
        const LastingDeformation lasting = world->lasting_deformation(dented);
        EXPECT_EQ(lasting.plastic_strain.size(), std::get<SoftSolid>(clay.matter).tetrahedra.size() + rest.size());
        EXPECT_TRUE(lasting.broken_segments.empty());

        const auto places = world->node_positions(dented);
        const std::vector<Vec3> form(places.begin(), places.end());
        double travel[2] = {};
        for (const bool has_strain : {false, true}) {
            const auto other = make_world(weightless());
            const DeformableHandle copy = other->create_deformable(clay).value();
            if (has_strain) {
                ASSERT_TRUE(other->set_lasting_deformation(copy, lasting));
                EXPECT_EQ(other->lasting_deformation(copy).plastic_strain, lasting.plastic_strain);
            }
            ASSERT_TRUE(other->set_nodes(copy, form, rest));
            for (int i = 0; i < 30; ++i) other->step();
            for (std::size_t i = 0; i < form.size(); ++i)
                travel[has_strain ? 1 : 0] =
                    std::max(travel[has_strain ? 1 : 0], length(other->node_positions(copy)[i] - form[i]));
        }
        EXPECT_LT(travel[1], 2e-5) << "it is at rest in its form";
        EXPECT_GT(travel[0], 10 * travel[1]);
    }
}

// A sheet that was bent and let go: another one in its form goes on alike if it has what bending has left.
TEST(LastingDeformation, OfAnotherSheetMakesItGoOnAlike) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const auto world = make_world(weightless());
        const DeformableDefinition foil = cloth_rectangle(
            0.3, 0.2, 0.03, {.rayleigh_damping = 0.05, .bend_friction = 20, .bend_yield = random.between(1, 10)});
        const DeformableHandle bent = world->create_deformable(foil).value();
        EXPECT_TRUE(world->lasting_deformation(bent).bend.empty());
        std::vector<Vec3> pushed(foil.nodes.size());
        for (std::size_t i = 0; i < pushed.size(); ++i) {
            const double along = foil.nodes[i].x * random.between(0.9, 1.1);
            pushed[i] = {0, 10 * along * along, 0};
        }
        ASSERT_TRUE(world->set_nodes(bent, foil.nodes, pushed));
        for (int i = 0; i < 240; ++i) world->step();
        const LastingDeformation lasting = world->lasting_deformation(bent);
        EXPECT_EQ(lasting.bend.size(), std::get<Cloth>(foil.matter).triangles.size());

        const auto places = world->node_positions(bent);
        const std::vector<Vec3> form(places.begin(), places.end());
        double travel[2] = {};
        for (const bool has_bend : {false, true}) {
            const auto other = make_world(weightless());
            const DeformableHandle copy = other->create_deformable(foil).value();
            if (has_bend) {
                ASSERT_TRUE(other->set_lasting_deformation(copy, lasting));
                EXPECT_EQ(other->lasting_deformation(copy).bend, lasting.bend);
            }
            ASSERT_TRUE(other->set_nodes(copy, form, std::vector<Vec3>(form.size())));
            for (int i = 0; i < 30; ++i) other->step();
            for (std::size_t i = 0; i < form.size(); ++i)
                travel[has_bend ? 1 : 0] =
                    std::max(travel[has_bend ? 1 : 0], length(other->node_positions(copy)[i] - form[i]));
        }
        RecordProperty("m, with and without " + std::to_string(seed),
                       std::to_string(travel[1]) + " " + std::to_string(travel[0]));
        EXPECT_GT(travel[0], 10 * travel[1]);
    }
}

// A wire that was bent, at a wall or free: another one in its form with its bends goes on alike, to rounding where it
// is free.
TEST(LastingDeformation, OfAnotherWireMakesItGoOnAlike) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed);
        const auto world = make_world(weightless());
        DeformableDefinition wire =
            rope_between({0, 0, 0}, {0.4, 0, 0}, 0.02,
                         {.bend_rigidity = 0.1, .rayleigh_damping = 0.05, .bend_yield = random.between(1, 5)});
        const bool is_clamped = seed % 2 == 0;
        if (is_clamped) {
            wire.pinned = {0};
            wire.clamps = {{0, {1, 0, 0}}};
        }
        const DeformableHandle bent = world->create_deformable(wire).value();
        EXPECT_TRUE(world->lasting_deformation(bent).bend.empty());
        std::vector<Vec3> pushed = wire.nodes;
        for (Vec3& node : pushed) node += Vec3{0, 3 * node.x * node.x, 2 * node.x * node.x * random.between(0.9, 1.1)};
        ASSERT_TRUE(world->set_nodes(bent, pushed, std::vector<Vec3>(pushed.size())));
        for (int i = 0; i < 120; ++i) world->step();
        const LastingDeformation lasting = world->lasting_deformation(bent);
        ASSERT_EQ(lasting.bend.size(), wire.nodes.size());

        const auto places = world->node_positions(bent);
        const std::vector<Vec3> form(places.begin(), places.end()), still(form.size());
        std::vector<Vec3> ends[3];
        for (const int copy : {0, 1, 2}) {
            const auto other = copy == 0 ? nullptr : make_world(weightless());
            World& in = other ? *other : *world;
            const DeformableHandle same = other ? other->create_deformable(wire).value() : bent;
            if (copy == 1) {
                ASSERT_TRUE(in.set_lasting_deformation(same, lasting));
                EXPECT_EQ(in.lasting_deformation(same).bend, lasting.bend);
            }
            ASSERT_TRUE(in.set_nodes(same, form, still));
            for (int i = 0; i < 30; ++i) in.step();
            ends[copy].assign(in.node_positions(same).begin(), in.node_positions(same).end());
        }
        double away[3] = {};
        for (const int copy : {1, 2}) {
            for (std::size_t i = 0; i < form.size(); ++i)
                away[copy] = std::max(away[copy], length(ends[copy][i] - ends[0][i]));
        }
        EXPECT_LT(away[1], is_clamped ? 0.01 * away[2] : 1e-12) << seed;
        EXPECT_GT(away[2], 0.003) << "without its bends it straightens";
    }
}

TEST(LastingDeformation, ThatIsWrongIsRefusedAndChangesNothing) {
    const auto world = make_world();
    const DeformableHandle solid = world->create_deformable(clay_box()).value();
    const DeformableHandle rope = world->create_deformable(rope_between({0, 1, 0}, {0, 0, 0}, 0.1, {})).value();
    const std::size_t parts = std::get<SoftSolid>(clay_box().matter).tetrahedra.size() + clay_box().nodes.size();
    LastingDeformation lasting;
    lasting.plastic_strain.assign(parts - 1, {});
    EXPECT_EQ(world->set_lasting_deformation(solid, lasting).error().where, "plastic_strain");
    lasting.plastic_strain.assign(parts, {0, 0, 0, 0, std::numeric_limits<double>::quiet_NaN()});
    EXPECT_EQ(world->set_lasting_deformation(solid, lasting).error().where, "plastic_strain");
    EXPECT_EQ(world->set_lasting_deformation(rope, lasting).error().where, "plastic_strain");
    EXPECT_EQ(world->set_lasting_deformation(rope, {{}, {10}, {}}).error().where, "broken_segments");
    EXPECT_EQ(world->set_lasting_deformation(solid, {{}, {0}, {}}).error().where, "broken_segments");
    EXPECT_EQ(world->set_lasting_deformation(solid, {{}, {}, {{}}}).error().where, "bend");
    EXPECT_EQ(world->set_lasting_deformation(rope, {{}, {}, {{}}}).error().where, "bend");
    EXPECT_TRUE(world->lasting_deformation(solid).plastic_strain.empty());
    EXPECT_TRUE(world->broken_segments(rope).empty());

    // What is beyond the bound of strains is shortened to it.
    lasting.plastic_strain.assign(parts, {1e6, 0, 0, 0, 0});
    ASSERT_TRUE(world->set_lasting_deformation(solid, lasting));
    const double bound = WorldSettings{}.solver.deformable.solid.max_plastic_strain;
    for (const auto& [xx, yy, xy, xz, yz] : world->lasting_deformation(solid).plastic_strain)
        EXPECT_NEAR(std::sqrt(xx * xx + yy * yy + (xx + yy) * (xx + yy)), bound, 1e-9);

    ASSERT_TRUE(world->set_lasting_deformation(rope, {{}, {2, 5}}));
    EXPECT_EQ(world->broken_segments(rope), (std::vector<std::uint32_t>{2, 5}));
    ASSERT_TRUE(world->set_lasting_deformation(rope, {}));
    EXPECT_TRUE(world->broken_segments(rope).empty());
}

}  // namespace
}  // namespace embody::physics
