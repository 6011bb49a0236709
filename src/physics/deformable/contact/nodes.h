// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "math/vec3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// The points of a deformable, one entry a node in each array.
struct Nodes {
    std::vector<Vec3> position;        ///< world, m
    std::vector<Vec3> mean_velocity;   ///< over the last substep, m/s: what carries the motion
    std::vector<Vec3> velocity;        ///< at its end, m/s: `set_velocities`
    std::vector<double> mass;          ///< kg
    std::vector<double> inverse_mass;  ///< 1/kg; 0: pinned

    [[nodiscard]] std::size_t size() const { return position.size(); }
};

}  // namespace embody::physics::deformable
