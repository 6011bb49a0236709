// SPDX-License-Identifier: MIT
// Sphere against any convex by closed forms: of a polytope the face, or the nearest of the edges visible from the
// centre.
// Round shapes are treated in the half plane of distance from the axis and height: a rectangle (cylinder) or a
// triangle (cone) there.
#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/queries/ball_touch.h"
#include "physics/collision/shapes/polytope_query.h"

namespace embody::physics::collision {

namespace {

/// A point or direction in the half plane of a round shape.
struct HalfPlane {
    double radial = 0, axial = 0;
};

Vec3 outward_at(Vec3 local_point) { return normalized({local_point.x, 0, local_point.z}, {1, 0, 0}); }

Vec3 from_half_plane(HalfPlane d, Vec3 outward) { return outward * d.radial + Vec3{0, d.axial, 0}; }

SurfaceDistance to_point(Vec3 from, Vec3 point, Vec3 fallback) {
    const Vec3 away = point - from;
    return {normalized(away, fallback), length(away)};
}

SurfaceDistance distance_from_capsule(const Convex& capsule, Vec3 p) {
    const double y = std::fmax(-capsule.half_height, std::fmin(capsule.half_height, p.y));
    SurfaceDistance result = to_point({0, y, 0}, p, {1, 0, 0});
    result.distance -= capsule.radius;
    return result;
}

SurfaceDistance distance_from_cylinder(const Convex& cylinder, Vec3 p) {
    const Vec3 outward = outward_at(p);
    const double beyond_side = std::sqrt(p.x * p.x + p.z * p.z) - cylinder.radius;
    const double beyond_cap = std::fabs(p.y) - cylinder.half_height;
    const Vec3 cap_normal{0, p.y < 0 ? -1.0 : 1.0, 0};

    // Beyond both, the rim is nearest; else the side or the cap, whichever is less deep.
    if (beyond_side > 0 && beyond_cap > 0) {
        const double distance = std::sqrt(beyond_side * beyond_side + beyond_cap * beyond_cap);
        return {(outward * beyond_side + cap_normal * beyond_cap) / distance, distance};
    }
    if (beyond_side > beyond_cap) return {outward, beyond_side};
    return {cap_normal, beyond_cap};
}

SurfaceDistance distance_from_cone(const Convex& cone, Vec3 p) {
    const Vec3 outward = outward_at(p);
    const double rho = std::sqrt(p.x * p.x + p.z * p.z), h = cone.half_height, r = cone.radius;
    const ConeSlope slope = cone_slope(cone);
    const double beyond_base = -h - p.y;
    const double beyond_side = (rho - r) * slope.radial + (p.y + h) * slope.axial;
    const Vec3 side_normal = from_half_plane({slope.radial, slope.axial}, outward);

    // Inside: the nearer of side and base.
    if (beyond_base <= 0 && beyond_side <= 0) {
        return beyond_side > beyond_base ? SurfaceDistance{side_normal, beyond_side}
                                         : SurfaceDistance{{0, -1, 0}, beyond_base};
    }
    // Outside: along the slope from the rim (0) to the apex (slant length), or over the base, the apex, the rim.
    const double slant = std::sqrt(4 * h * h + r * r);
    const double along = (rho - r) * -slope.axial + (p.y + h) * slope.radial;
    if (beyond_side > 0 && along >= 0 && along <= slant) return {side_normal, beyond_side};
    if (along > slant) return to_point({0, h, 0}, p, {0, 1, 0});
    if (rho <= r) return {{0, -1, 0}, beyond_base};
    return to_point(outward * r + Vec3{0, -h, 0}, p, outward);
}

SurfaceDistance distance_from_box(const Convex& box, Vec3 p) {
    const Vec3 h = box.bounds.upper, beyond = abs(p) - h;
    const Vec3 side{p.x < 0 ? -1.0 : 1.0, p.y < 0 ? -1.0 : 1.0, p.z < 0 ? -1.0 : 1.0};
    const int outside = (beyond.x > 0 ? 1 : 0) + (beyond.y > 0 ? 1 : 0) + (beyond.z > 0 ? 1 : 0);

    // Over a face or inside: the face that is nearest, by its exact normal. Else an edge or a corner.
    if (outside <= 1) {
        if (beyond.x >= beyond.y && beyond.x >= beyond.z) return {{side.x, 0, 0}, beyond.x};
        if (beyond.y >= beyond.z) return {{0, side.y, 0}, beyond.y};
        return {{0, 0, side.z}, beyond.z};
    }
    const Vec3 away = scale(side, max(beyond, {0, 0, 0}));
    const double distance = length(away);
    return {away / distance, distance};
}

// Whether the point stands over a face: on the inner side of each of its sides, by at least `inset` (m, >= 0).
bool is_over_face(const Polytope& polytope, const Polytope::Face& face, Vec3 p, double inset) {
    for (std::uint32_t i = 0; i < face.count; ++i) {
        const Vec3 u = polytope.vertices[polytope.loops[face.first + i]];
        const Vec3 v = polytope.vertices[polytope.loops[face.first + (i + 1 == face.count ? 0 : i + 1)]];
        const double beyond = dot(cross(v - u, face.normal), p - u);
        if (beyond > 0 || beyond * beyond < inset * inset * length_squared(v - u)) return false;
    }
    return true;
}

// The nearest point of the edges that the point sees: edges beside a face that it is above.
Vec3 nearest_on_seen_edges(const Polytope& polytope, const std::vector<double>& heights, Vec3 p) {
    Vec3 nearest;
    double least = 1e300;
    for (const Polytope::Edge& edge : polytope.edges) {
        if (heights[edge.left] <= 0 && heights[edge.right] <= 0) continue;
        const Vec3 from = polytope.vertices[edge.from], travel = polytope.vertices[edge.to] - from;
        const double fraction = std::clamp(dot(p - from, travel) / length_squared(travel), 0.0, 1.0);
        const Vec3 on_edge = from + travel * fraction;
        const double squared = length_squared(p - on_edge);
        if (squared >= least) continue;
        least = squared;
        nearest = on_edge;
    }
    return nearest;
}

SurfaceDistance distance_from_polytope(const Convex& convex, Vec3 p, double enough) {
    thread_local std::vector<double> heights;
    const Polytope& polytope = convex.polytope;
    heights.resize(polytope.normal_lanes.size());
    const double most = heights_over_faces(polytope, p, heights.data());
    std::uint32_t nearest = 0;
    while (heights[nearest] < most) ++nearest;
    const Polytope::Face& face = polytope.faces[nearest];
    if (most <= 0 || most > enough) return {face.normal, most, nearest};

    // Outside: the face with the largest height of the point, if the point is over that face (its normal is exact),
    // since no plane is farther. Else an edge or a vertex that it sees.
    if (is_over_face(polytope, face, p, 0)) return {face.normal, most, nearest};
    return to_point(nearest_on_seen_edges(polytope, heights, p), p, face.normal);
}

}  // namespace

SurfaceDistance distance_from_surface(const Convex& convex, Vec3 p, double enough) {
    switch (convex.kind) {
        case ConvexKind::sphere: {
            SurfaceDistance result = to_point({}, p, {0, 1, 0});
            result.distance -= convex.radius;
            return result;
        }
        case ConvexKind::capsule:
            return distance_from_capsule(convex, p);
        case ConvexKind::cylinder:
            return distance_from_cylinder(convex, p);
        case ConvexKind::cone:
            return distance_from_cone(convex, p);
        case ConvexKind::polytope:
            break;
    }
    return convex.is_box ? distance_from_box(convex, p) : distance_from_polytope(convex, p, enough);
}

namespace {

// Whether a sphere that meets the surface at `gap` meets the same face while its centre `p` moves by less than
// Manifold::whole_travel.
bool stays_over_face(const Convex& convex, Vec3 p, const SurfaceDistance& gap) {
    if (!convex.is_box) {
        const Polytope& polytope = convex.polytope;
        return gap.face != Polytope::no_face &&
               is_over_face(polytope, polytope.faces[gap.face], p, Manifold::whole_travel);
    }
    const Vec3 inset = convex.bounds.upper - abs(p);
    int sides_within = 0;
    for (int k = 0; k < 3; ++k) sides_within += gap.normal[k] == 0 && inset[k] >= Manifold::whole_travel ? 1 : 0;
    return sides_within == 2;
}

// Whether the normal leans from every face, or side of a round shape, by more than the bend of a smooth surface.
bool leans_over_edge(const Convex& convex, Vec3 normal) {
    static const double smooth_cosine = std::cos(smooth_edge_angle);
    const double radial = std::sqrt(normal.x * normal.x + normal.z * normal.z);
    switch (convex.kind) {
        case ConvexKind::sphere:
        case ConvexKind::capsule:
            return false;
        case ConvexKind::cylinder:
            return std::max(radial, std::fabs(normal.y)) < smooth_cosine;
        case ConvexKind::cone: {
            const ConeSlope slope = cone_slope(convex);
            return std::max(radial * slope.radial + normal.y * slope.axial, -normal.y) < smooth_cosine;
        }
        case ConvexKind::polytope:
            break;
    }
    return dot(convex.polytope.faces[support_face(convex, normal)].normal, normal) < smooth_cosine;
}

}  // namespace

void collide_sphere(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory,
                    ContactRegion& region) {
    const double radius = a.shape->radius;
    const Vec3 local = b.to_local(a.position);
    const SurfaceDistance gap = distance_from_surface(*b.shape, local, radius + margin);
    const double separation = gap.distance - radius;
    if (separation > margin) {
        memory.part_along(a.direction_to_local(-b.direction_to_frame(gap.normal)), separation);
        return;
    }
    region.normal = -b.direction_to_frame(gap.normal);
    region.add(a.position + region.normal * radius, separation, 0);
    region.is_on_edge = leans_over_edge(*b.shape, gap.normal);
    const bool is_flat = b.shape->kind == ConvexKind::polytope && stays_over_face(*b.shape, local, gap);
    memory.kind = PairMemory::Kind::nothing;
    if (is_flat) {
        memory.kind = PairMemory::Kind::face_of_b;
        region.has_all_corners = true;
        memory.feature_b = static_cast<std::uint16_t>(support_face(*b.shape, gap.normal));
    }
}

}  // namespace embody::physics::collision
