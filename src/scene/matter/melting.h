// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <variant>
#include <vector>

#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/shape_definition.h"
#include "scene/matter/momenta.h"

namespace embody::scene {

/// A rigid thing that becomes drops of liquid (docs/physics/melting.md).
struct MeltingBody {
    physics::ShapeDefinition shape;
    Transform pose;         ///< of the shape
    Vec3 linear_velocity;   ///< of the centre of mass, m/s
    Vec3 angular_velocity;  ///< rad/s
};

/// A soft solid that does; all are of one world and live on.
struct MeltingSolid {
    std::span<const std::array<std::uint32_t, 4>> tetrahedra;
    std::span<const Vec3> rest;                   ///< places of the nodes as they are made, m
    std::span<const Vec3> positions, velocities;  ///< now, m and m/s
    std::span<const double> masses;               ///< kg
};

struct Melting {
    std::variant<MeltingBody, MeltingSolid> matter;
    Momenta momenta;
};

Momenta momenta_of(const MeltingSolid& solid);

/// What a thing fills, and for cells of which size.
struct Filled {
    double volume = 0;     ///< m³
    double cell_size = 0;  ///< m
};
/// With at most `max_count` particles of about this cell size (m); a body as its shape is filled by them.
Result<Filled> filled_by(const Melting& melting, double cell_size, std::size_t max_count);

/// So many drops, spread evenly by volume in a body and by mass in a solid, that move as its matter there.
Result<std::vector<physics::FluidDrop>> drops_of(const Melting& melting, std::size_t count);

}  // namespace embody::scene
