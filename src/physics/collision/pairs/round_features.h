// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/contact_region.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

// The features of a convex in a given direction (unit, frame of the pair, pointing out of it). Rims become
// polygons of rim_corners points, one of which is the farthest along the direction.
inline constexpr int rim_corners = 24;

/// Whether the convex has a flat face whose normal is within that cosine of `direction`.
bool has_aligned_face(const PlacedConvex& convex, Vec3 direction, double cosine);
/// The flat face whose normal is `direction` (within 1e-4.5 rad): false if there is none there.
bool get_aligned_face(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// The straight line of the surface (edge, side of a round shape, axis of a capsule) that lies across `direction`.
bool get_aligned_line(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);
/// The core's point nearest to `point` on the face, edge or side of a box, capsule, cylinder or cone that lies across
/// `direction` (within a few hundredths); else its farthest point. Always a point of the core.
Vec3 facing_point(const PlacedConvex& convex, Vec3 direction, Vec3 point);
/// A polytope's face by its index.
void get_polytope_face(const PlacedConvex& convex, std::uint32_t face, ContactFeature& feature);
/// The face or line that faces most along `direction`, at whatever angle: the incident feature of another's face.
void get_facing(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature);

/// Exact normals close to `direction` along which this convex may separate: of its faces and its side.
void add_own_normals(const PlacedConvex& convex, Vec3 direction, bool all_faces, std::vector<Vec3>& normals);
/// A family of straight lines of a surface by the outward normals along them: all whose cosine with `direction` is
/// `cosine`. Edges, sides of cylinders and axes of capsules: zero; sides of a cone: that of its slope, with its axis.
struct SlopedLine {
    Vec3 direction;  ///< unit
    double cosine = 0;
};
/// Adds the lines close to `direction`: for the normals of two shapes' lines that cross.
void add_sloped_lines(const PlacedConvex& convex, Vec3 direction, std::vector<SlopedLine>& lines);

/// How near the crossing's normal is to a face's where the two span that face: 8 degrees.
inline constexpr double min_span_cosine = 0.99;
/// Whether a face's region is as deep as the crossing.
bool is_span(double deepest, double separation);
/// Where an edge of a polytope crosses a line or edge of another shape that lies nearly flat on a face beside that
/// edge, one point is too little: a plank across a narrow block would rock on one end of its support after the other,
/// and each end would be found only after penetration. Adds the points where the line crosses the face's sides, along
/// region.normal; false, with nothing added, where there is no such face or its depth differs from `separation`.
/// `is_owner_a`: the polytope is a; `lift`: radius around the line; `face`: scratch.
bool span_face(const PlacedConvex& owner, bool is_owner_a, const ContactFeature& line, double lift, double separation,
               double margin, ContactFeature& face, ContactRegion& region);

}  // namespace embody::physics::collision
