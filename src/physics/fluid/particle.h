// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace embody::physics {

/// A parcel of liquid: a cache line. Lengths in metres, in world axes from the fluid's origin.
struct FluidParticle {
    float position[3] = {};
    float velocity[3] = {};  ///< m/s
    /// Gradient of each velocity component (its row of the affine field of Jiang and others 2015), 1/s.
    float affine[3][3] = {};
    std::uint32_t id = 0;
};
static_assert(sizeof(FluidParticle) == 64);

}  // namespace embody::physics
