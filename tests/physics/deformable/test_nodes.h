// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/contact/nodes.h"

namespace embody::physics::deformable {

/// Nodes at rest at these places (m), each with this mass (kg).
inline Nodes nodes_at(const std::vector<Vec3>& places, double mass = 1) {
    Nodes nodes;
    nodes.position = places;
    nodes.velocity = nodes.mean_velocity = std::vector<Vec3>(places.size());
    nodes.mass = std::vector<double>(places.size(), mass);
    nodes.inverse_mass = std::vector<double>(places.size(), 1 / mass);
    return nodes;
}

}  // namespace embody::physics::deformable
