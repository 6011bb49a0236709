// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/contact_region.h"
#include "physics/collision/convex.h"

namespace embody::physics {

// What a convex offers to a contact in a given direction (unit, frame of the pair, pointing out of it). Rims become
// polygons of rim_corners points, one of which is the farthest along the direction.
inline constexpr int rim_corners = 24;

/// The flat face whose normal is `direction` (within 1e-4.5 rad): false if there is none there.
bool get_aligned_face(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// The straight line of the surface (edge, side of a round shape, axis of a capsule) that lies across `direction`.
bool get_aligned_line(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// A polytope's face by its index.
void get_polytope_face(const PlacedConvex& convex, std::uint32_t face, ContactFeature& feature);
/// The face or line that faces most along `direction`, at whatever angle: what is clipped by another's face.
void get_facing(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);

/// Exact normals near `direction` that this convex may part along: its faces and its side.
void add_own_normals(const PlacedConvex& convex, Vec3 direction, bool all_faces, std::vector<Vec3>& normals);
/// Directions of its straight lines near `direction`: for the cross products of two shapes' lines.
void add_line_directions(const PlacedConvex& convex, Vec3 direction, std::vector<Vec3>& lines);

}  // namespace embody::physics
