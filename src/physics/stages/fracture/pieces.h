// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/fracture/split_solid.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/fracture_state.h"

namespace embody::physics::stages {

struct MadePieces {
    std::vector<PlannedPiece> pieces;
    /// Kinetic energy of the pieces less that of the body, J: not zero where the body's mass is not spread over its
    /// shape evenly.
    double energy_growth = 0;
};

/// The pieces that a body becomes: its mass by volume, and its momentum and angular momentum as those of one rigid
/// motion. Nothing where the world can not have one of them as a body.
std::optional<MadePieces> make_pieces(const FractureAccess& world, std::uint32_t body, const Split& split);

}  // namespace embody::physics::stages
