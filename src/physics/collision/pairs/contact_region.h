// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <vector>

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/choose_four.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// The feature of a shape that meets another: a polygon (counter-clockwise seen from outside), a segment or a point, in
/// the frame of the pair. `ids` name the corners; edge i runs from corner i to the next.
struct ContactFeature {
    std::vector<Vec3> points;
    std::uint32_t id = 0;  ///< of the face, edge or vertex within its shape
    Vec3 normal;           ///< outwards, of a polygon only
    double radius = 0;     ///< of a cap, whose rim the points lie on; else 0
    Vec3 center;           ///< of a cap

    void clear() {
        points.clear();
        id = 0;
        radius = 0;
    }
};

/// 32-bit name of a combination of features.
std::uint32_t feature_name(std::initializer_list<std::uint32_t> parts);

/// A corner of a polygon while it is clipped: in the reference's plane, and its height over it; the edges that meet
/// there name it.
struct ClipCorner {
    double x, y, height;
    std::uint32_t edge_in, edge_out;
};

/// A contact region while it is gathered, in the frame of the pair, and memory for that work: one object lives long and
/// its vectors keep their memory.
struct ContactRegion {
    Vec3 normal;  ///< unit, a to b
    std::vector<ManifoldPoint> points;
    bool is_proper = false;        ///< known to be four points at most, of which each adds area
    bool has_all_corners = false;  ///< of a face: no other corner of the two is within the margin
    bool is_on_edge = false;       ///< as Manifold::is_on_edge

    ContactFeature reference, incident;
    std::vector<ClipCorner> sides, corners, clipped;
    std::vector<FlatPoint> flat;
    std::vector<std::uint32_t> low;

    /// `on_a` on the surface of a, `separation` from there along the normal to b.
    void add(Vec3 on_a, double separation, std::uint32_t feature) {
        points.push_back({on_a + normal * (0.5 * separation), separation, feature});
    }
};

/// Clips `incident` (polygon or segment) by the sides of the polygon `reference` and adds the points within `margin` of
/// the reference's plane. `reference_is_a` says whose plane it is; region.normal must be +-reference.normal. `lift`:
/// radius around the incident's core.
void clip_to_region(const ContactFeature& reference, const ContactFeature& incident, bool reference_is_a, double lift,
                    double margin, ContactRegion& region);

/// Adds the corners of a rich polytope (more than a box has) that lie over the polygon `reference` within `margin` of
/// its plane, so that a rounded or slightly bent side stands on all its low corners and not on one small face of many,
/// another one each step. To be called before clip_to_region: of two equal points the first one's name is kept.
void add_near_corners(const ContactFeature& reference, const PlacedConvex& incident, bool reference_is_a, double margin,
                      ContactRegion& region);

/// Adds the deepest point of the pair where clipping lost it: it can lie on another face than the one that faces most,
/// or in the sliver between a rim and its polygon.
void keep_deepest(Vec3 on_a, double separation, double tolerance, ContactRegion& region);

/// Two segments: the overlap of nearly parallel ones (two points), else their nearest points (one point).
/// Separations are measured along region.normal less the radii.
void cross_segments(const ContactFeature& a, const ContactFeature& b, double radius_a, double radius_b, double margin,
                    ContactRegion& region);

/// Appends the region as manifold, turned and moved into the world; as two where four points do not cover the others;
/// nothing for an empty region.
void append_manifolds(ContactRegion& region, const Mat3& turn, Vec3 origin, std::vector<Manifold>& manifolds);

}  // namespace embody::physics::collision
