// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "math/vec3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// One corner of a contact region (paper, III.B: the contact area is a polygon, not one point).
struct ManifoldPoint {
    Vec3 position;              ///< world, midway between the two surfaces
    double separation = 0;      ///< along the normal, m; negative where the shapes overlap
    std::uint32_t feature = 0;  ///< name of the features that met; equal from step to step while they stay the same
};

/// The contact region of two convex pieces: up to four points kept of the polygon, chosen for area. A region whose
/// corners lie in no common plane (a chair with uneven feet) has a second manifold with other points.
struct Manifold {
    static constexpr int max_points = 4;            ///< three carry a body, a fourth keeps a face from tipping
    static constexpr double whole_travel = 0.0025;  ///< m, see is_whole
    Vec3 normal;                                    ///< world, unit, from shape a to shape b
    std::uint32_t piece_a = 0, piece_b = 0;         ///< child of a compound, triangle of a mesh; 0 otherwise
    std::uint32_t part = 0;                         ///< 0 holds the deepest point; 1: the second four
    int count = 0;
    /// No other corner of the two pieces is within the margin; a sphere meets one face or plane alone, and keeps to it
    /// until it has moved by whole_travel.
    bool is_whole = false;
    /// A sphere meets an edge or a corner of what it touches.
    bool is_on_edge = false;
    /// Whether the piece is of those that roll: spheres, capsules, cylinders and cones.
    bool a_is_round = false, b_is_round = false;
    std::array<ManifoldPoint, max_points> points;
};

}  // namespace embody::physics::collision
