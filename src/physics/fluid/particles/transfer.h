// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

/// What particles are: each one's volume, in cells, and their liquids, which are identified.
struct ParticleMatter {
    float volume;
    const Mixture& liquids;
};

/// Particles to faces: grid.mass, grid.velocity (momentum over mass), grid.density.
/// grid.known marks the faces that any particle reached. `places`: where each particle meets the grid. Of several
/// liquids also grid.liquid_volume, grid.face_volume and grid.mobility.
void particles_to_grid(FluidGrid& grid, const std::vector<FluidParticle>& particles,
                       const std::vector<std::array<float, 3>>& places, const ParticleMatter& matter,
                       TaskPool& workers);

/// A vector field on faces at a place, and its gradient.
struct FieldSample {
    float value[3];
    float gradient[3][3];  ///< row: component, 1/m times its unit
};
FieldSample sample_field(const FluidGrid& grid, const std::array<std::vector<float>, 3>& field, const float* position);
/// Without gradient.
void sample_value(const FluidGrid& grid, const std::array<std::vector<float>, 3>& field, const float* position,
                  float* value);
/// The eight faces along `axis` around a place of the fluid's frame and their trilinear weights.
struct FaceWeight {
    int cell;
    float weight;
};
using FaceWeights = std::array<FaceWeight, 8>;
FaceWeights face_weights(const FluidGrid& grid, const float* position, int axis);
/// A value on centres at a place of the fluid's frame, and its gradient per cell.
float sample_center(const FluidGrid& grid, const std::vector<float>& field, const float* position, float* gradient);

}  // namespace embody::physics::fluid
