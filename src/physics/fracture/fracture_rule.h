// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "math/vec3.h"
#include "physics/definitions/brittleness.h"
#include "physics/fracture/namespace.h"

namespace embody::physics::fracture {

/// What hit a body in one step.
struct Blow {
    Vec3 position;       ///< world, m
    double impulse = 0;  ///< N s
    double energy = 0;   ///< kinetic energy along the normal that the blow stopped, J
};

/// The fraction of the blow's impulse that came after the body had broken, 0 … 1; nothing where it does not break.
std::optional<double> excess_of(const Blow& blow, const Brittleness& brittleness);

/// The solid that a blow breaks.
struct BrokenSolid {
    Vec3 size;          ///< of its bounds, m
    double volume = 0;  ///< m³
};
/// How many pieces a blow makes: their size is Grady's. 2 at least, max_pieces at most.
int piece_count(const BrokenSolid& solid, double blow_energy, const Brittleness& brittleness);

/// What breaks a piece that is this fraction of the whole, 0 … 1; nothing where it is too small to break again.
std::optional<Brittleness> brittleness_of_piece(const Brittleness& whole, double fraction);

}  // namespace embody::physics::fracture
