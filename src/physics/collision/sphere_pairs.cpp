// SPDX-License-Identifier: MIT
// Sphere against any convex: closed forms but for a polytope's edges and vertices (GJK). Round shapes are looked at in
// the half plane of distance from the axis and height: a rectangle (cylinder) or a triangle (cone) there.
#include <cmath>

#include "physics/collision/convex_pairs.h"
#include "physics/collision/gjk.h"

namespace embody::physics {

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

    // Beyond both the rim is nearest; else the side or the cap, whichever is less deep.
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

SurfaceDistance distance_from_polytope(const Convex& convex, Vec3 p) {
    const Polytope& polytope = convex.polytope;
    std::uint32_t nearest = 0;
    double most = -1e300;
    for (std::uint32_t f = 0; f < polytope.faces.size(); ++f) {
        const double height = dot(polytope.faces[f].normal, p) - polytope.faces[f].offset;
        if (height > most) {
            most = height;
            nearest = f;
        }
    }
    if (most <= 0) return {polytope.faces[nearest].normal, most};

    // Outside: the face itself where the point stands over it (its normal is exact), else an edge or a vertex.
    const Polytope::Face& face = polytope.faces[nearest];
    bool over_face = true;
    for (std::uint32_t i = 0; i < face.count && over_face; ++i) {
        const Vec3 u = polytope.vertices[polytope.loops[face.first + i]];
        const Vec3 v = polytope.vertices[polytope.loops[face.first + (i + 1) % face.count]];
        over_face = dot(cross(v - u, face.normal), p - u) <= 0;
    }
    if (over_face) return {face.normal, most};
    Convex point;
    const CoreDistance gap = core_distance(Core({&convex, {}, {}}), Core({&point, {}, p}));
    return to_point(gap.on_a, p, face.normal);
}

}  // namespace

SurfaceDistance distance_from_surface(const Convex& convex, Vec3 p) {
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
    return convex.is_box ? distance_from_box(convex, p) : distance_from_polytope(convex, p);
}

void collide_sphere(const PlacedConvex& a, const PlacedConvex& b, double margin, ContactRegion& region) {
    const double radius = a.shape->radius;
    const SurfaceDistance gap = distance_from_surface(*b.shape, b.to_local(a.position));
    const double separation = gap.distance - radius;
    if (separation > margin) return;
    region.normal = -b.direction_to_frame(gap.normal);
    region.add(a.position + region.normal * radius, separation, 0);
}

}  // namespace embody::physics
