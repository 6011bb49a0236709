// SPDX-License-Identifier: MIT
// A polytope against one triangle of a surface, in the polytope's frame. Separating axes as for two polytopes
// (D. Gregorius, "The separating axis test between convex polyhedra", GDC 2013), but only those that belong to the
// triangle: its own normal, faces of the polytope whose normals lean no farther over an edge than the surface bends
// there, and edges of the polytope that the normal crosses while it turns over such an edge. They are found by walking:
// the vertex that is lowest along the triangle's normal is known; turning the normal over the edge, the lowest vertex
// changes exactly where an edge of the polytope lies across. On a flat floor nothing but the first axis is left.
#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/round_features.h"
#include "physics/collision/pairs/triangle_pairs.h"
#include "physics/collision/queries/gjk.h"
#include "physics/collision/shapes/polytope_query.h"

namespace embody::physics::collision {

namespace {

/// A normal (from the triangle outwards) and the feature of the polytope that it belongs to.
struct TriangleAxis {
    enum class Kind : std::uint8_t { own, face, edges };
    Kind kind = Kind::own;
    Vec3 outwards;
    double separation = 0;
    std::uint32_t face = 0;          ///< of the polytope
    std::uint32_t from = 0, to = 0;  ///< vertices of the polytope's edge
    std::size_t edge_of_triangle = 0;
};

/// The pair while its axis is searched.
struct TriangleSearch {
    const Convex& convex;
    const Polytope& polytope;
    const PlacedTriangle& triangle;
    double margin = 0;
    double bias = 0;           ///< the triangle's own normal is preferred by this, and faces before edges
    std::uint32_t lowest = 0;  ///< vertex along the triangle's normal
    TriangleAxis best;
};

/// A corner of a polygon while it is clipped, named by the edges that meet there.
struct PrismCorner {
    Vec3 point;
    double beyond = 0;  ///< distance beyond the present clipping side, m
    std::uint32_t edge_in = 0, edge_out = 0;
};

/// Scratch of one thread.
struct TriangleScratch {
    std::vector<double> heights;
    std::vector<std::uint32_t> low;
    std::vector<PrismCorner> corners, clipped;  ///< large enough for any face; `count` of the first are used
    std::size_t count = 0;
};

// The triangle's corner that is lowest over a face, and its height there.
struct CornerOverFace {
    Vec3 corner;
    double height = 1e300;
};
CornerOverFace lowest_over_face(const TriangleSearch& s, std::uint32_t face) {
    CornerOverFace lowest;
    for (const Vec3& corner : s.triangle.corners) {
        const double height = dot(s.polytope.faces[face].normal, corner) - s.polytope.reach[face];
        if (height < lowest.height) lowest = {corner, height};
    }
    return lowest;
}

// Faces of the polytope as axes. The gap along a face normal is at most the height of any one point of the triangle.
void lean_to_faces(TriangleSearch& s, std::vector<double>& heights) {
    const std::size_t count = s.polytope.faces.size();
    heights.resize(s.polytope.normal_lanes.size());
    const Vec3 witness = s.triangle.nearest_to(s.triangle.lowest);
    double least = s.best.separation + s.bias;
    if (heights_over_faces(s.polytope, witness, heights.data()) <= least) return;
    for (std::uint32_t f = 0; f < count; ++f) {
        if (heights[f] <= least) continue;
        const CornerOverFace lowest = lowest_over_face(s, f);
        const Vec3 outwards = -s.polytope.faces[f].normal;
        if (lowest.height <= least || s.triangle.leans_too_far(outwards, lowest.corner)) continue;
        least = lowest.height;
        s.best = {TriangleAxis::Kind::face, outwards, lowest.height, f};
    }
}

// Turns the normal over one edge and measures each edge of the polytope that the normal crosses.
void lean_over_edge(TriangleSearch& s, std::size_t edge) {
    const PlacedTriangle& t = s.triangle;
    // Turns as far as the neighbour's normal, but at most by 90 degrees.
    const double half = std::min(1.0, static_cast<double>(t.half_dihedrals[edge]));
    const double cosine = (1 - half * half) / (1 + half * half), sine = 2 * half / (1 + half * half);
    // At a lean by an angle v the lowest point alone limits the height to height cos v + beyond sin v.
    const double most = std::max(t.height, t.height * cosine) + std::max(0.0, t.beyond(edge, t.lowest)) * sine;
    if (most <= s.best.separation + s.bias) return;
    const Vec3 end = t.normal * cosine + t.outward[edge] * sine;
    const Vec3 change = end - t.normal;
    std::uint32_t vertex = s.lowest;
    double passed = 0;
    for (std::size_t iterations = 0; iterations < s.polytope.edges.size(); ++iterations) {
        // The first edge at which a neighbouring vertex becomes as low.
        const Vec3 here = s.polytope.vertices[vertex];
        double first = 1;
        std::uint32_t next = vertex;
        for (const std::uint32_t other : s.polytope.neighbours(vertex)) {
            const Vec3 d = s.polytope.vertices[other] - here;
            const double rise = dot(t.normal, d), falling = -dot(change, d);
            if (falling <= 0 || rise >= first * falling) continue;
            first = std::max(passed, rise / falling);
            next = other;
        }
        if (next == vertex) return;
        const Vec3 outwards = normalized(t.normal + change * first);
        const double separation = dot(outwards, here - t.corners[edge]);
        if (separation > s.best.separation + s.bias + 0.02 * std::fabs(s.best.separation)) {
            s.best = {TriangleAxis::Kind::edges, outwards, separation, 0, vertex, next, edge};
        }
        vertex = next;
        passed = first;
    }
}

// Whether the depth along the triangle's normal belongs to a neighbour: where a body stands across the edge of a step,
// the step's side cuts deep into it, yet a face of the body, which does not belong to this triangle, hardly overlaps.
bool is_deep_in_neighbour(const TriangleSearch& s) {
    constexpr double believed = 0.1;  // of the smallest side: a depth less than this is the triangle's own
    const Vec3 size = s.convex.bounds.size();
    const double depth = -s.best.separation;
    if (s.best.kind != TriangleAxis::Kind::own || depth < believed * std::min({size.x, size.y, size.z})) return false;
    for (std::uint32_t f = 0; f < s.polytope.faces.size(); ++f) {
        if (lowest_over_face(s, f).height > -0.5 * depth) return true;
    }
    return false;
}

// False where some axis separates the two by more than the margin.
bool find_triangle_axis(TriangleSearch& s, std::vector<double>& heights) {
    const PlacedTriangle& t = s.triangle;
    s.best = {TriangleAxis::Kind::own, t.normal, t.height};
    if (!t.normal_is_best()) {
        s.lowest = support_vertex(s.polytope, -t.normal);
        lean_to_faces(s, heights);
        for (std::size_t i = 0; i < 3; ++i) {
            if (t.is_open(i)) lean_over_edge(s, i);
        }
    }
    return s.best.separation <= s.margin && !is_deep_in_neighbour(s);
}

// Keeps the part of a closed polygon on the inner side.
void clip_by_prism_side(const PrismSide& side, std::uint32_t name, TriangleScratch& scratch) {
    const std::size_t n = scratch.count;
    PrismCorner* from = scratch.corners.data();
    double farthest_out = -1e300;
    for (std::size_t i = 0; i < n; ++i) {
        from[i].beyond = side.beyond(from[i].point);
        farthest_out = std::max(farthest_out, from[i].beyond);
    }
    if (farthest_out <= 0) return;
    std::size_t kept = 0;
    PrismCorner* to = scratch.clipped.data();
    for (std::size_t i = 0; i < n; ++i) {
        const PrismCorner &u = from[i], &v = from[i + 1 == n ? 0 : i + 1];
        const bool leaves = u.beyond <= 0;
        if (leaves) to[kept++] = u;
        if (leaves == (v.beyond <= 0)) continue;
        // Where the edge crosses the side, a new corner between this edge and the side.
        const double fraction = u.beyond / (u.beyond - v.beyond);
        to[kept++] = {u.point + (v.point - u.point) * fraction, 0, leaves ? u.edge_out : name,
                      leaves ? name : u.edge_out};
    }
    scratch.count = kept;
    scratch.corners.swap(scratch.clipped);
}

// Of a rich polytope all low corners over the triangle count, so that a rounded side does not stand on one small face
// of many, another one each step. Those far above the lowest one are left to later steps, however wide the margin of a
// fast body is: returns how far along the normal they may lie.
double add_low_corners(const TriangleSearch& s, const PrismSide (&sides)[3], double level, TriangleScratch& scratch,
                       ContactRegion& region) {
    constexpr std::size_t corners_of_a_box = 8;  // what has no more is no rounded thing
    const std::vector<Vec3>& vertices = s.polytope.vertices;
    if (vertices.size() <= corners_of_a_box) return -1e300;
    constexpr double low_fraction = 0.1;  // of the reach
    const Vec3 normal = s.triangle.normal;
    const double highest = level + std::min(s.margin, s.triangle.height + low_fraction * s.convex.reach);
    scratch.low.resize(s.polytope.vertex_lanes.size());
    const std::uint32_t count = find_low(s.polytope.vertex_lanes, normal, highest, scratch.low.data());
    for (std::uint32_t k = 0; k < count && scratch.low[k] < vertices.size(); ++k) {
        const Vec3 corner = vertices[scratch.low[k]];
        if (sides[0].beyond(corner) > 0 || sides[1].beyond(corner) > 0 || sides[2].beyond(corner) > 0) continue;
        region.add(corner, dot(normal, corner) - level, feature_name({4u, scratch.low[k]}));
    }
    return highest;
}

// The part of the polytope over the triangle: the corners of the face that faces it, clipped, and low corners.
void add_over_triangle(const TriangleSearch& s, TriangleScratch& scratch, ContactRegion& region) {
    constexpr std::uint32_t side_tag = 0x8000u;
    const PlacedTriangle& t = s.triangle;
    const Polytope& p = s.polytope;
    const double level = dot(t.normal, t.corners[0]);
    const PrismSide sides[3] = {{t, 0}, {t, 1}, {t, 2}};
    region.normal = -t.normal;
    const double low = add_low_corners(s, sides, level, scratch, region);

    // The polytope's face turned to the triangle; each side may add one corner.
    const std::uint32_t face = support_face(p, -t.normal);
    const Polytope::Face& f = p.faces[face];
    if (scratch.corners.size() < f.count + 3) {
        scratch.corners.resize(f.count + 3);
        scratch.clipped.resize(f.count + 3);
    }
    scratch.count = f.count;
    for (std::uint32_t i = 0; i < f.count; ++i) {
        scratch.corners[i] = {p.vertices[p.loops[f.first + i]], 0, i == 0 ? f.count - 1 : i - 1, i};
    }
    for (std::uint32_t i = 0; i < 3 && scratch.count > 0; ++i) clip_by_prism_side(sides[i], side_tag | i, scratch);
    for (std::size_t i = 0; i < scratch.count; ++i) {
        const PrismCorner& c = scratch.corners[i];
        const double along = dot(t.normal, c.point), separation = along - level;
        if (separation > s.margin) continue;
        // A corner of the face keeps its name from triangle to triangle, so that sliding bodies are recognised.
        const bool is_corner = (c.edge_in & side_tag) == 0 && (c.edge_out & side_tag) == 0;
        if (is_corner && along <= low) continue;  // known
        const std::uint32_t owner = is_corner ? 0 : t.index + 1;
        region.add(c.point, separation, feature_name({1u, face, c.edge_in << 16 | c.edge_out, owner}));
    }
}

// The part of the triangle in front of a face of the polytope.
void add_before_face(const TriangleSearch& s, ContactRegion& region) {
    const PlacedConvex placed{&s.convex, {}, {}};
    get_polytope_face(placed, s.best.face, region.reference);
    region.normal = region.reference.normal;
    region.incident.clear();
    region.incident.id = s.triangle.index;
    region.incident.points.assign(s.triangle.corners.begin(), s.triangle.corners.end());
    clip_to_region(region.reference, region.incident, true, 0, s.margin, region);
}

// The point where an edge of the polytope crosses an edge of the triangle; none where they pass beyond an end.
void add_crossing(const TriangleSearch& s, ContactRegion& region) {
    constexpr double slack = 1e-6;  // of an edge: rounding at its ends
    const std::size_t edge = s.best.edge_of_triangle;
    const Vec3 p = s.polytope.vertices[s.best.from], u = s.polytope.vertices[s.best.to] - p;
    const Vec3 q = s.triangle.corners[edge], v = s.triangle.along(edge);
    const Vec3 w = p - q;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), du = dot(u, w), dv = dot(v, w);
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-6 * uu * vv)) return;
    const double on_u = (uv * dv - vv * du) / det, on_v = (uu * dv - uv * du) / det;
    if (on_u < -slack || on_u > 1 + slack || on_v < -slack || on_v > 1 + slack) return;
    region.normal = -s.best.outwards;
    region.add(p + u * on_u, s.best.separation,
               feature_name({3u, std::min(s.best.from, s.best.to), std::max(s.best.from, s.best.to),
                             static_cast<std::uint32_t>(edge), s.triangle.index}));
}

// In the wedge over a sharp edge only the nearest points, if the normal there belongs to this triangle.
void add_nearest(const TriangleSearch& s, ContactRegion& region) {
    const auto& dihedrals = s.triangle.half_dihedrals;
    if (s.best.separation <= 0 ||
        std::max({dihedrals[0], dihedrals[1], dihedrals[2]}) <= PrismSide::shallow_half_dihedral)
        return;
    thread_local Convex flat{ConvexKind::polytope, 0, 0, triangle_polytope({}, {1, 0, 0}, {0, 0, 1}), {}};
    set_triangle(flat.polytope, s.triangle.corners[0], s.triangle.corners[1], s.triangle.corners[2]);
    const CoreDistance gap = core_distance(Core({&s.convex, {}, {}}), Core({&flat, {}, {}}), s.margin);
    if (gap.overlap || !gap.is_final || !(gap.distance > 0) || gap.distance > s.margin) return;
    const Vec3 outwards = (gap.on_a - gap.on_b) / gap.distance;
    if (s.triangle.leans_too_far(outwards, gap.on_b)) return;
    region.normal = -outwards;
    region.add(gap.on_a, gap.distance, feature_name({6u, s.triangle.index}));
}

}  // namespace

bool collide_polytope_triangle(const Convex& convex, const PlacedTriangle& triangle, double margin,
                               ContactRegion& region) {
    thread_local TriangleScratch scratch;
    const Vec3 size = convex.bounds.size();
    TriangleSearch s{convex, convex.polytope, triangle, margin, 1e-4 * std::min({size.x, size.y, size.z}), 0, {}};
    if (!find_triangle_axis(s, scratch.heights)) return false;
    if (s.best.kind == TriangleAxis::Kind::edges) add_crossing(s, region);
    if (s.best.kind == TriangleAxis::Kind::face) add_before_face(s, region);
    if (!region.points.empty()) return false;
    add_over_triangle(s, scratch, region);
    if (!region.points.empty()) return true;
    add_nearest(s, region);
    return false;
}

}  // namespace embody::physics::collision
