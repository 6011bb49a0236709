// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "foundation/result.h"

// What a step of matter in motion costs, by its size: the limits of 60 Hz, and how cost grows.
namespace embody::scaling {

/// cloth: a sheet falls over a box and drapes. solids: eight bricks of rubber fall on the ground and on each other.
/// dam: a column of water collapses between walls. grains: a column of sand runs out over a plate.
enum class Matter : std::uint8_t { cloth, solids, dam, grains };

inline constexpr Matter matters[] = {Matter::cloth, Matter::solids, Matter::dam, Matter::grains};

std::string_view name_of(Matter matter);
std::string_view what_of(Matter matter);     ///< description
std::string_view element_of(Matter matter);  ///< what its size counts: edges, tetrahedra, particles or grains
/// Smallest first; the largest is what 60 Hz should bear on two cores.
std::array<int, 3> sizes_of(Matter matter);

struct MatterCost {
    std::size_t elements = 0;  ///< as many as asked for, or about so many
    double mean_ms = 0;        ///< wall time of a step, over all steps of one run
    double worst_ms = 0;       ///< of the slowest one
    std::uint64_t hash = 0;    ///< of the end state: the same for any number of workers
    std::string wrong;         ///< empty: the end state is correct
};

/// Builds the scene and steps it for as long as it moves. `workers`: 0 as many as pay.
Result<MatterCost> measure(Matter matter, int size, int workers);

/// Exponent p of cost ~ elements^p; 1 is linear.
double growth(const MatterCost& smaller, const MatterCost& larger);

}  // namespace embody::scaling
