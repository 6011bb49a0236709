// SPDX-License-Identifier: MIT
// What the structures hold today, so that none of it is lost. `embody bench stability` shows them beside their goals.
#include <gtest/gtest.h>

#include "scenes/structures/structure.h"
#include "validation/reference.h"

namespace embody::scenes {
namespace {

struct Held {
    std::string_view name;
    StructureGoal bounds;  // the time is the builder's
};

class Structures : public ::testing::TestWithParam<Held> {};

TEST_P(Structures, StandTightAndQuietAndSleep) {
    const StructureBuilder* builder = find_structure_builder(GetParam().name);
    ASSERT_NE(builder, nullptr);
    const StructureResult result = run_structure(*builder);
    EXPECT_EQ(result.misses(GetParam().bounds), "")
        << "sag " << result.sag << " m, drift " << result.drift << " m, " << result.energy << " J, asleep after "
        << result.asleep_after.value_or(-1) << " s";
}

constexpr Held held[] = {
    {"mass_ratio_1000", {.sag = 0.001, .drift = 0.001, .energy = 1e-6, .asleep_after = 1}},
    {"tower_10000", {.sag = 0.001, .drift = 0.001, .energy = 1e-6, .asleep_after = 1}},
    {"card_pair", {.sag = 1e-4, .drift = 1e-4, .energy = 1e-9, .asleep_after = 1}},
    {"arch", {.sag = 0.001, .drift = 0.001, .energy = 1e-9, .asleep_after = 1}},
    {"thick_arch", {.sag = 0.001, .drift = 5e-4, .energy = 1e-9, .asleep_after = 1}},
    {"column_10", {.sag = 0.001, .drift = 1e-3, .energy = 1e-6, .asleep_after = 1}},
    {"column_30", {.sag = 0.001, .drift = 0.001, .energy = 1e-4, .asleep_after = 1}},
    {"restitution_stack", {.sag = 0.001, .drift = 0.002, .energy = 1e-9, .asleep_after = 5}},
    {"card_house", {.sag = 5e-4, .drift = 5e-4, .energy = 1e-9, .asleep_after = 1}},
    {"jenga", {.sag = 1e-4, .drift = 1e-4, .energy = 1e-9, .asleep_after = 1}},
    {"large_jenga", {.sag = 1e-4, .drift = 1e-4, .energy = 1e-6, .asleep_after = 1}},
    {"dominoes", {.sag = 1e-4, .drift = 1e-4, .energy = 1e-9, .asleep_after = 1}},
    {"pyramid_10", {.sag = 1e-4, .drift = 1e-4, .energy = 1e-6, .asleep_after = 1}},
    {"wall", {.sag = 2e-4, .drift = 1e-4, .energy = 1e-6, .asleep_after = 1}},
    {"figure_10", {.sag = 2e-4, .drift = 1e-4, .energy = 1e-6, .asleep_after = 1}},
};
INSTANTIATE_TEST_SUITE_P(All, Structures, ::testing::ValuesIn(held),
                         [](const auto& structure) { return std::string(structure.param.name); });

TEST(StructureList, HasDifferentNamesAndTheRightCounts) {
    for (const StructureBuilder& builder : structure_builders()) {
        EXPECT_EQ(find_structure_builder(builder.name), &builder);
        if (builder.pieces > 1000) continue;
        EXPECT_EQ(builder.build({}).pieces.size(), static_cast<std::size_t>(builder.pieces)) << builder.name;
    }
    EXPECT_EQ(find_structure_builder("no such structure"), nullptr);
}

// Once asleep nothing stirs them.
TEST(Rest, NothingMovesInTenMinutes) {
    for (const std::string_view name : {"column_10", "card_house", "arch", "mass_ratio_1000", "pyramid_10"}) {
        const Structure structure = find_structure_builder(name)->build({});
        physics::run(*structure.world, 10);
        std::vector<Vec3> before;
        for (const Piece& piece : structure.pieces) before.push_back(structure.world->center_of_mass(piece.body));
        physics::run(*structure.world, 590);
        for (std::size_t i = 0; i < before.size(); ++i) {
            EXPECT_LT(length(structure.world->center_of_mass(structure.pieces[i].body) - before[i]), 0.001) << name;
        }
        EXPECT_EQ(structure.world->last_report().bodies_asleep, structure.pieces.size()) << name;
    }
}

}  // namespace
}  // namespace embody::scenes
