// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "foundation/result.h"
#include "physics/definitions/shape_definition.h"
#include "scene/matter/momenta.h"

namespace embody::scene {

/// Drops that lie together, as one rigid body (docs/physics/melting.md). Its frame is at the centre of mass, along the
/// world's axes.
struct FrozenPiece {
    physics::CompoundShape shape;
    Momenta momenta;
    Mat3 inertia;           ///< about the centre of mass, kg m²
    Vec3 linear_velocity;   ///< m/s
    Vec3 angular_velocity;  ///< rad/s
};

/// The connected components of the drops, of which neighbours are no farther apart than a cell (edge `cell_size`, m),
/// in the order of their first drop. Drops have one mass (kg) each.
std::vector<FrozenPiece> freeze(std::span<const Vec3> places, std::span<const Vec3> velocities, double drop_mass,
                                double cell_size);

}  // namespace embody::scene
