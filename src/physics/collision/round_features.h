// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/contact_region.h"
#include "physics/collision/convex.h"

namespace embody::physics {

// What a convex offers to a contact in a given direction (unit, frame of the pair, pointing out of it). Rims become
// polygons of rim_corners points, one of which is the farthest along the direction.
inline constexpr int rim_corners = 24;

/// Whether the convex has a flat face whose normal is as near to `direction` as that cosine tells.
bool has_aligned_face(const PlacedConvex& convex, Vec3 direction, double cosine);
/// The flat face whose normal is `direction` (within 1e-4.5 rad): false if there is none there.
bool get_aligned_face(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// The straight line of the surface (edge, side of a round shape, axis of a capsule) that lies across `direction`.
bool get_aligned_line(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// Of the face, edge or side of a box, capsule, cylinder or cone that lies across `direction` (within a few hundredths)
/// the core's point nearest to `point`; else its farthest one. Always a point of the core.
Vec3 facing_point(const PlacedConvex& convex, Vec3 direction, Vec3 point);
/// A polytope's face by its index.
void get_polytope_face(const PlacedConvex& convex, std::uint32_t face, ContactFeature& feature);
/// The face or line that faces most along `direction`, at whatever angle: what is clipped by another's face.
void get_facing(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);

/// Exact normals near `direction` that this convex may part along: its faces and its side.
void add_own_normals(const PlacedConvex& convex, Vec3 direction, bool all_faces, std::vector<Vec3>& normals);
/// A family of straight lines of a surface by the outward normals along them: all whose cosine with `direction` is
/// `cosine`. Edges, sides of cylinders and axes of capsules: zero; sides of a cone: that of its slope, with its axis.
struct SlopedLine {
    Vec3 direction;  ///< unit
    double cosine = 0;
};
/// Those near `direction`: for the normals of two shapes' lines that cross.
void add_sloped_lines(const PlacedConvex& convex, Vec3 direction, std::vector<SlopedLine>& lines);

}  // namespace embody::physics
