// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "foundation/task_pool.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/touched_body.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A node over a plane of a body, which moves with the body.
struct NodeContact {
    std::uint32_t node = 0, body = 0;  ///< body: index in the list of bodies
    Vec3 anchor, normal;       ///< of the plane, from the centre of mass, when the step began; normal to the node
    Vec3 velocity;             ///< velocity of the surface besides the body's own, m/s
    bool is_foreseen = false;  ///< the anchor is below where the node will be when the substep ends
};

/// Appends, for every one of `candidates` that may come closer than `radius` (m) to a body within `time_step` (s), the
/// nearest faces of that body as planes. `node_ball` is a sphere of that radius. Ordered by body, then as candidates.
void find_node_contacts(const Nodes& nodes, std::span<const std::uint32_t> candidates, const CollisionShape& node_ball,
                        double radius, std::span<const TouchedBody> bodies, double time_step, Vec3 gravity,
                        std::vector<NodeContact>& contacts, TaskPool& workers);

/// Maximum travel of a body's surface on its path within `time_step` (s), m.
double displacement_of(const TouchedBody& body, double time_step);

/// Gap of the node's surface to the plane (m; negative: overlap) `time` (s) after the step began.
double gap(const NodeContact& contact, Vec3 node_position, double radius, const TouchedBody& body, double time);

}  // namespace embody::physics::deformable
