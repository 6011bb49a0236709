// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "scenes/structures/building.h"

namespace embody::scenes {
namespace {

using physics::WorldSettings;

Structure build_reference_card_pair(const WorldSettings& settings) { return build_card_pair(settings, 0.25); }
Structure build_reference_arch(const WorldSettings& settings) { return build_arch(settings, 0.115, 1); }
Structure build_thick_arch(const WorldSettings& settings) { return build_arch(settings, 0.15, 0.5); }

constexpr std::array builders{
    StructureBuilder{"mass_ratio_1000",
                     "1000 kg on 1 kg, cubes of 1 m",
                     {.seconds = 20, .sag = 0.005, .energy = 0.01, .asleep_after = 5},
                     build_mass_ratio_1000,
                     2},
    StructureBuilder{"tower_10000",
                     "1, 10, 100, 1000, 10000 kg upwards, cubes of 1 m",
                     {.seconds = 60, .drift = 0.005},
                     build_tower_10000,
                     5},
    StructureBuilder{"card_pair",
                     "two leaning cards, friction 7 % above what they need",
                     {.seconds = 60, .sag = 0.001, .drift = 0.001},
                     build_reference_card_pair,
                     2},
    StructureBuilder{"arch",
                     "arch of 11 blocks, 10 % thicker than it needs to be",
                     {.seconds = 60, .drift = 0.005},
                     build_reference_arch,
                     11},
    StructureBuilder{"thick_arch",
                     "arch of 11 blocks, 0.15 of its radius thick",
                     {.seconds = 20, .drift = 0.001, .energy = 0.01, .asleep_after = 5},
                     build_thick_arch,
                     11},
    StructureBuilder{"column_10",
                     "10 cubes of 1 m",
                     {.seconds = 20, .sag = 0.001, .drift = 0.001, .energy = 0.01, .asleep_after = 4},
                     build_column_10,
                     10},
    StructureBuilder{"column_30",
                     "30 cubes of 1 m",
                     {.seconds = 20, .sag = 0.003, .drift = 0.003, .energy = 0.01, .asleep_after = 4},
                     build_column_30,
                     30},
    StructureBuilder{"restitution_stack",
                     "10 cubes dropped on one another, e = 0.8 (paper, Figure 9)",
                     {.seconds = 30, .sag = 0.01, .asleep_after = 20},
                     build_restitution_stack,
                     10},
    StructureBuilder{"card_house",
                     "card house of 5 levels, 40 cards of 0.4 m",
                     {.seconds = 60, .drift = 0.005, .asleep_after = 10},
                     build_card_house,
                     40},
    StructureBuilder{"jenga",
                     "18 layers of three blocks of 75 x 25 x 15 mm",
                     {.seconds = 60, .sag = 0.001, .drift = 0.001, .asleep_after = 4},
                     build_jenga,
                     54},
    StructureBuilder{"large_jenga",
                     "the same, 40 times as large",
                     {.seconds = 60, .sag = 0.003, .drift = 0.003, .asleep_after = 4},
                     build_large_jenga,
                     54},
    StructureBuilder{"dominoes",
                     "60 stones of 48 x 24 x 7.5 mm that nobody pushes",
                     {.seconds = 20, .sag = 0.0005, .drift = 0.0005, .asleep_after = 2},
                     build_dominoes,
                     60},
    StructureBuilder{"pyramid_10",
                     "pyramid of 10 rows of cubes of 1 m",
                     {.seconds = 10, .sag = 0.003, .drift = 0.003, .energy = 0.01, .asleep_after = 4},
                     build_pyramid_10,
                     55},
    StructureBuilder{"wall",
                     "wall of 21 x 10 cubes of 1 m",
                     {.seconds = 10, .sag = 0.003, .drift = 0.003, .asleep_after = 4},
                     build_wall,
                     205},
    StructureBuilder{"figure_10",
                     "walls, pyramids, drums and a tower of beams (paper, Figure 10)",
                     {.seconds = 10, .sag = 0.003, .drift = 0.003, .asleep_after = 4},
                     build_figure_10,
                     230},
    StructureBuilder{"pen",
                     "343 spheres, cubes and columns fall into a pen (paper, Table I g)",
                     {.seconds = 20, .asleep_after = 10},
                     build_pen,
                     343},
    StructureBuilder{
        "pyramid_60", "pyramid of 60 rows of cubes of 1 m", {.seconds = 10, .asleep_after = 4}, build_pyramid_60, 1830},
    StructureBuilder{"pyramid_100",
                     "pyramid of 100 rows of cubes of 1 m",
                     {.seconds = 10, .asleep_after = 4},
                     build_pyramid_100,
                     5050},
};

}  // namespace

std::span<const StructureBuilder> structure_builders() { return builders; }

const StructureBuilder* find_structure_builder(std::string_view name) {
    const auto found = std::find_if(builders.begin(), builders.end(),
                                    [&](const StructureBuilder& builder) { return builder.name == name; });
    return found == builders.end() ? nullptr : &*found;
}

}  // namespace embody::scenes
