// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "foundation/result.h"
#include "physics/definitions/shape_definition.h"

namespace embody::scene {

/// Particles of a liquid that fills a shape.
struct FluidFilling {
    std::vector<Vec3> places;  ///< in the shape's frame, m
    double cell_size = 0;      ///< of the cells, m; a particle has an eighth of a cell's volume
};

/// Fills a shape with particles for cells of about this size (m), at most `max_count` particles: the cells are enlarged
/// where more would fit. The particles' volume is the shape's to the accuracy of a lattice. The error says why the
/// shape has no inside, or that it is too flat.
Result<FluidFilling> fill_with_fluid(const physics::ShapeDefinition& shape, double cell_size, std::size_t max_count);

/// Places of exactly so many particles, spread evenly in the shape, in its frame, m: of a lattice with more, some are
/// left out.
Result<std::vector<Vec3>> places_of_particles(const physics::ShapeDefinition& shape, std::size_t count);

}  // namespace embody::scene
