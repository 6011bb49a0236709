// SPDX-License-Identifier: MIT
// A convex against the triangles within reach. One-sided, and without bumps at the edges inside a surface: a normal
// that leans over an edge farther than the surface itself bends there belongs to the neighbour (the Voronoi region
// test, cf. P. Terdiman and others on "internal edges"). Triangles are looked up and most of them ruled out in the
// surface's own frame, where they need no rotation; the few that are left are tested in the convex's.
#include "physics/collision/pairs/surface_pair.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/triangle_pairs.h"
#include "physics/collision/shapes/near_triangles.h"
#include "physics/collision/shapes/polytope_query.h"

namespace embody::physics::collision {

namespace {

/// All contacts of triangles whose normals nearly agree.
struct NormalGroup {
    ContactRegion region;
    std::uint32_t lowest_triangle = 0;
    bool has_all_corners = true;  ///< of the convex over these triangles, within the margin
};

/// The convex that is tested against triangles, seen in the surface's frame.
struct Probe {
    PlacedConvex placed;
    Core own;  ///< in its own frame
    Vec3 inside, own_inside;
    double reach = 0;  ///< of the convex about `inside` and the margin, m
    double margin = 0;

    Probe(const ConvexPiece& piece, const Transform& pose, const Transform& surface_pose, double extra)
        : placed{&piece.convex, to_matrix(conjugate(surface_pose.rotation) * (pose.rotation * piece.local.rotation)),
                 inverse_transform_point(surface_pose, transform_point(pose, piece.local.position))},
          own({&piece.convex, {}, {}}),
          inside(interior_point(placed)),
          own_inside(own.interior()),
          reach(piece.convex.reach + extra),
          margin(extra) {}

    [[nodiscard]] bool is_polytope() const { return placed.shape->kind == ConvexKind::polytope; }
    // Bounds of the part of its own box that is in its ball, with the margin: turned boxes reach far beyond their
    // contents.
    [[nodiscard]] Bounds bounds() const {
        const Bounds& box = placed.shape->bounds;
        const Vec3 half = box.half_extents(), center = placed.to_frame(box.center());
        const Mat3& r = placed.rotation;
        const Vec3 extent = abs(r.x) * half.x + abs(r.y) * half.y + abs(r.z) * half.z + Vec3{margin, margin, margin};
        const Vec3 of_ball{reach, reach, reach};
        return {max(center - extent, inside - of_ball), min(center + extent, inside + of_ball)};
    }
    // Farthest point of the core in its own frame; of a hull within the precision of floats.
    [[nodiscard]] Vec3 own_support(Vec3 direction) const {
        const Convex& convex = *placed.shape;
        if (convex.kind != ConvexKind::polytope || convex.is_box) return own.support(direction);
        return convex.polytope.vertices[farthest_roughly(convex.polytope.rough_vertex_lanes, direction)];
    }
    // Whether the convex may be within the margin of the triangle's front: by the extents of both along the shortest
    // line from the triangle to its inside, which separates most of those that are only close.
    [[nodiscard]] bool may_meet(const NearTriangle& t, Vec3 across) const {
        if (!(dot(inside - t.corners[0], across) > 0)) return false;
        const Vec3 own_away = placed.direction_to_local(t.away);
        const double nearest = std::min({dot(t.away, inside - t.corners[0]), dot(t.away, inside - t.corners[1]),
                                         dot(t.away, inside - t.corners[2])});
        const double gap = nearest + dot(own_away, own_support(-own_away) - own_inside);
        return !(gap > 0 && gap * gap > (margin + own.depth) * (margin + own.depth) * length_squared(t.away));
    }
};

// Puts a triangle into the convex's frame; false where its plane separates the two, or one of its sides a round convex,
// whose test is slow.
bool place_near(const Probe& probe, const std::array<Vec3, 3>& corners, Vec3 normal, PlacedTriangle& t) {
    t.normal = probe.placed.direction_to_local(normal);
    t.corners[0] = probe.placed.to_local(corners[0]);
    t.lowest = probe.own_support(-t.normal) - t.normal * probe.own.depth;
    t.height = dot(t.normal, t.lowest - t.corners[0]);
    if (t.height > probe.margin) return false;
    t.corners[1] = probe.placed.to_local(corners[1]);
    t.corners[2] = probe.placed.to_local(corners[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        t.outward[i] = normalized(cross(t.along(i), t.normal));
        if (probe.is_polytope() || t.beyond(i, probe.own_inside) <= probe.margin) continue;
        if (t.beyond(i, probe.own_support(-t.outward[i])) - probe.own.depth > probe.margin) return false;
    }
    return true;
}

/// The contacts that one triangle adds.
struct TriangleRegion {
    const ContactRegion& region;
    std::uint32_t triangle = 0;
    bool has_all_corners = false;
};

void add_to_groups(const TriangleRegion& added, std::vector<NormalGroup>& groups, std::size_t& count) {
    const ContactRegion& region = added.region;
    constexpr double same_normal = 0.9998;  // within 1.1 degrees
    std::size_t g = 0;
    while (g < count && dot(groups[g].region.normal, region.normal) < same_normal) ++g;
    if (g == count) {
        if (count == groups.size()) groups.emplace_back();
        groups[g].region.points.clear();
        groups[g].region.normal = region.normal;
        groups[g].lowest_triangle = added.triangle;
        groups[g].has_all_corners = groups[g].region.is_on_edge = true;
        ++count;
    }
    groups[g].has_all_corners = groups[g].has_all_corners && added.has_all_corners;
    groups[g].region.is_on_edge = groups[g].region.is_on_edge && region.is_on_edge;
    groups[g].region.points.insert(groups[g].region.points.end(), region.points.begin(), region.points.end());
}

}  // namespace

void collide_surface(const ConvexPiece& piece, std::uint32_t piece_index, const Transform& pose,
                     const PlacedSurface& placed, double margin, std::vector<Manifold>& manifolds) {
    thread_local std::vector<std::uint32_t> near;
    thread_local std::vector<NormalGroup> groups;
    thread_local ContactRegion region;
    const Probe probe(piece, pose, placed.pose, margin);
    near.clear();
    placed.surface.find(probe.bounds(), near);

    thread_local std::vector<NearTriangle> within_reach;
    find_near_triangles(placed.surface, near, probe.inside, probe.reach, within_reach);

    // Each triangle's contacts join those of others with nearly the same normal.
    std::size_t count = 0;
    PlacedTriangle triangle;
    for (const NearTriangle& found : within_reach) {
        const std::uint32_t index = found.index;
        const std::array<Vec3, 3>& corners = found.corners;
        const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (!probe.may_meet(found, across)) continue;
        if (!place_near(probe, corners, across / length(across), triangle)) continue;
        triangle.index = index;
        triangle.half_dihedrals = placed.surface.half_dihedrals(index);
        region.points.clear();
        region.is_on_edge = false;
        bool has_all_corners = false;
        if (probe.is_polytope()) {
            has_all_corners = collide_polytope_triangle(piece.convex, triangle, margin, region);
        } else {
            collide_round_triangle(piece.convex, triangle, margin, region);
            for (ManifoldPoint& point : region.points) point.feature = feature_name({index, point.feature});
        }
        if (!region.points.empty()) add_to_groups({region, index, has_all_corners}, groups, count);
    }

    // Transforms the contacts into the world.
    const PlacedConvex own = place(piece, pose, {});
    for (std::size_t g = 0; g < count; ++g) {
        const std::size_t before = manifolds.size();
        append_manifolds(groups[g].region, own.rotation, own.position, manifolds);
        for (std::size_t k = before; k < manifolds.size(); ++k) {
            manifolds[k].is_whole = groups[g].has_all_corners && manifolds[k].is_whole;
            manifolds[k].is_on_edge = groups[g].region.is_on_edge;
            manifolds[k].piece_a = piece_index;
            manifolds[k].piece_b = groups[g].lowest_triangle;
        }
    }
}

}  // namespace embody::physics::collision
