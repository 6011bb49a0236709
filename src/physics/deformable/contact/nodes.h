// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "math/vec3.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// How a liquid around a node answers to a change of the node's velocity: with drag (v_expected − v), by axis, beside
/// the force that it has on a node that moves as it expects (docs/physics/coupling.md, "Liquids and what bends").
struct NodeFlow {
    Vec3 drag;          ///< N s/m
    Vec3 velocity;      ///< that is expected when the step begins, m/s
    Vec3 acceleration;  ///< m/s²

    /// The expected velocity, s after the step began.
    [[nodiscard]] Vec3 expected_velocity(double time) const { return velocity + acceleration * time; }
    [[nodiscard]] Vec3 force(Vec3 node_velocity, double time) const {
        return scale(drag, expected_velocity(time) - node_velocity);
    }
};

/// The points of a deformable, one entry a node in each array.
struct Nodes {
    std::vector<Vec3> position;        ///< world, m
    std::vector<Vec3> mean_velocity;   ///< over the last substep, m/s: what carries the motion
    double substep = 0;                ///< length of that, s; 0: the mean velocities are those of the present instant
    std::vector<Vec3> velocity;        ///< at its end, m/s: `set_velocities`
    std::vector<double> mass;          ///< kg
    std::vector<double> inverse_mass;  ///< 1/kg; 0: pinned
    std::vector<Vec3> force;           ///< of liquids through the step, N; empty: none
    std::vector<NodeFlow> flow;        ///< of liquids through the step; empty: none
    std::vector<Vec3> flow_impulse;    ///< that `flow` has had on the nodes in the step, N s; as many as `flow`

    [[nodiscard]] std::size_t size() const { return position.size(); }
    /// Where it comes in some seconds with its mean velocity.
    [[nodiscard]] Vec3 ahead(std::size_t node, double seconds) const {
        return position[node] + seconds * mean_velocity[node];
    }
    [[nodiscard]] Vec3 force_on(std::size_t node) const { return force.empty() ? Vec3{} : force[node]; }
};

}  // namespace embody::physics::deformable
