// SPDX-License-Identifier: MIT
// A line enters a convex once. Each part of its surface gives the points where the ray meets it from outside; those
// that lie on the part itself count, and the nearest is the hit. A ray from inside thus meets nothing.
#include <cmath>

#include "physics/collision/queries/cast_at_convex.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {

namespace {

/// The nearest entry found so far, in the frame of the shape that is asked.
struct RayProbe {
    Vec3 origin, direction;
    double max_distance;
    std::optional<ShapeRayHit> hit;

    [[nodiscard]] Vec3 at(double t) const { return origin + direction * t; }
    void offer(double t, Vec3 normal) {
        const double limit = hit ? hit->distance : max_distance;
        if (t >= 0 && t <= limit && dot(normal, direction) < 0) hit = ShapeRayHit{t, normal};
    }
};

// False only where the ray's whole length lies on one side of the box.
bool may_meet(const RayProbe& ray, const Bounds& box) {
    constexpr double slack = 1e-9;  // of the numbers' size
    const Vec3 end = ray.at(ray.max_distance);
    for (int axis = 0; axis < 3; ++axis) {
        const double a = ray.origin[axis], b = end[axis], margin = slack * (1 + std::fabs(a));
        if (std::max(a, b) < box.lower[axis] - margin || std::min(a, b) > box.upper[axis] + margin) return false;
    }
    return true;
}

// Smaller root of a t² + 2 b t + c, where the ray enters; false if there is none.
bool first_root(double a, double b, double c, double& t) {
    const double disc = b * b - a * c;
    if (!(disc >= 0) || a == 0) return false;
    const double root = std::sqrt(disc);
    // Avoids cancellation for either sign of b.
    const double q = b < 0 ? root - b : -root - b;
    const double t0 = q / a, t1 = q != 0 ? c / q : t0;
    t = std::fmin(t0, t1);
    return true;
}

bool meets_sphere(const RayProbe& ray, Vec3 center, double radius, double& t) {
    // Computed from the point of the ray nearest to the centre, which keeps the digits of far origins.
    const double nearest = dot(center - ray.origin, ray.direction);
    const double off = length_squared(ray.at(nearest) - center);
    if (off > radius * radius) return false;
    t = nearest - std::sqrt(radius * radius - off);
    return true;
}

bool meets_round_side(const RayProbe& ray, double radius, double& t) {
    const Vec3 o = ray.origin, d = ray.direction;
    return first_root(d.x * d.x + d.z * d.z, o.x * d.x + o.z * d.z, o.x * o.x + o.z * o.z - radius * radius, t);
}

void offer_cap(RayProbe& ray, double y, double radius, Vec3 normal) {
    if (ray.direction.y == 0) return;
    const double t = (y - ray.origin.y) / ray.direction.y;
    const Vec3 p = ray.at(t);
    if (p.x * p.x + p.z * p.z <= radius * radius) ray.offer(t, normal);
}

void cast_at_capsule(RayProbe& ray, double radius, double half_height) {
    double t = 0;
    if (meets_round_side(ray, radius, t)) {
        const Vec3 p = ray.at(t);
        if (std::fabs(p.y) <= half_height) ray.offer(t, normalized(Vec3{p.x, 0, p.z}));
    }
    for (const double y : {-half_height, half_height}) {
        if (!meets_sphere(ray, {0, y, 0}, radius, t)) continue;
        const Vec3 p = ray.at(t);
        if (std::fabs(p.y) >= half_height && p.y * y >= 0) ray.offer(t, normalized(p - Vec3{0, y, 0}));
    }
}

void cast_at_cylinder(RayProbe& ray, double radius, double half_height) {
    double t = 0;
    if (meets_round_side(ray, radius, t)) {
        const Vec3 p = ray.at(t);
        if (std::fabs(p.y) <= half_height) ray.offer(t, normalized(Vec3{p.x, 0, p.z}));
    }
    offer_cap(ray, half_height, radius, {0, 1, 0});
    offer_cap(ray, -half_height, radius, {0, -1, 0});
}

void cast_at_cone(RayProbe& ray, const Convex& cone) {
    // The double cone about the apex: distance from the axis = slope * height below the apex.
    const double slope = cone.radius / (2 * cone.half_height), k = slope * slope;
    const Vec3 o = ray.origin - Vec3{0, cone.half_height, 0}, d = ray.direction;
    const double a = d.x * d.x + d.z * d.z - k * d.y * d.y;
    const double b = o.x * d.x + o.z * d.z - k * o.y * d.y;
    const double c = o.x * o.x + o.z * o.z - k * o.y * o.y;
    const double disc = b * b - a * c;
    const ConeSlope side = cone_slope(cone);
    const auto offer_side = [&](double t) {
        const Vec3 p = ray.at(t);
        if (!std::isfinite(t) || std::fabs(p.y) > cone.half_height) return;
        const Vec3 outward = normalized({p.x, 0, p.z}, {1, 0, 0});
        ray.offer(t, outward * side.radial + Vec3{0, side.axial, 0});
    };
    // Both roots: the nearer one may lie on the mirrored cone above the apex.
    if (disc >= 0) {
        const double q = b < 0 ? std::sqrt(disc) - b : -std::sqrt(disc) - b;
        offer_side(q / a);
        if (q != 0) offer_side(c / q);
    }
    offer_cap(ray, -cone.half_height, cone.radius, {0, -1, 0});
}

void cast_at_polytope(RayProbe& ray, const Polytope& polytope) {
    double enter = -1, leave = ray.max_distance;
    Vec3 normal;
    for (const Polytope::Face& face : polytope.faces) {
        const double height = dot(face.normal, ray.origin) - face.offset, speed = dot(face.normal, ray.direction);
        if (height > 0 && height + speed * ray.max_distance > 0) return;  // wholly in front of this face
        if (speed == 0) continue;
        const double t = -height / speed;
        if (speed > 0) {
            leave = std::fmin(leave, t);
        } else if (t > enter) {
            enter = t;
            normal = face.normal;
        }
    }
    if (enter >= 0 && enter <= leave) ray.offer(enter, normal);
}

void cast_at_convex(RayProbe& ray, const Convex& convex) {
    double t = 0;
    switch (convex.kind) {
        case ConvexKind::sphere:
            if (meets_sphere(ray, {}, convex.radius, t)) ray.offer(t, normalized(ray.at(t)));
            return;
        case ConvexKind::capsule:
            return cast_at_capsule(ray, convex.radius, convex.half_height);
        case ConvexKind::cylinder:
            return cast_at_cylinder(ray, convex.radius, convex.half_height);
        case ConvexKind::cone:
            return cast_at_cone(ray, convex);
        case ConvexKind::polytope:
            return cast_at_polytope(ray, convex.polytope);
    }
}

void cast_at_surface(RayProbe& ray, const TriangleSurface& surface) {
    // T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997; front sides only.
    const auto visit = [&](std::uint32_t index, double limit) {
        const auto [a, b, c] = surface.corners(index);
        const Vec3 ab = b - a, ac = c - a;
        const Vec3 p = cross(ray.direction, ac);
        const double det = dot(ab, p);
        if (!(det > 0)) return limit;
        const Vec3 from = ray.origin - a;
        const double u = dot(from, p);
        const Vec3 q = cross(from, ab);
        const double v = dot(ray.direction, q);
        // A slack of rounding, so that no ray slips through between two triangles.
        const double slack = 1e-12 * det;
        if (u < -slack || v < -slack || u + v > det + slack) return limit;
        ray.offer(dot(ac, q) / det, surface.normal(index));
        return ray.hit ? std::fmin(limit, ray.hit->distance) : limit;
    };
    surface.find_along_ray(ray.origin, ray.direction, ray.max_distance, visit);
}

}  // namespace

std::optional<ShapeRayHit> cast_ray(const Convex& convex, Vec3 origin, Vec3 direction, double max_distance) {
    RayProbe ray{origin, direction, max_distance, std::nullopt};
    if (may_meet(ray, convex.bounds)) cast_at_convex(ray, convex);
    return ray.hit;
}

std::optional<ShapeRayHit> cast_ray(const CollisionShape& shape, const Transform& pose, Vec3 origin, Vec3 direction,
                                    double max_distance) {
    const CollisionShape::Data& data = shape.data();
    // In the frame of a part, then with its normal turned back.
    std::optional<ShapeRayHit> best;
    const auto cast_in = [&](const Transform& frame, auto&& cast) {
        RayProbe ray{inverse_transform_point(frame, origin), rotate_inverse(frame.rotation, direction),
                     best ? best->distance : max_distance, std::nullopt};
        cast(ray);
        if (ray.hit) best = ShapeRayHit{ray.hit->distance, rotate(frame.rotation, ray.hit->normal)};
    };
    if (data.is_plane) {
        cast_in(pose, [&](RayProbe& ray) {
            const double speed = dot(data.plane_normal, ray.direction);
            if (speed == 0) return;
            ray.offer((data.plane_offset - dot(data.plane_normal, ray.origin)) / speed, data.plane_normal);
        });
    }
    if (data.surface) cast_in(pose, [&](RayProbe& ray) { cast_at_surface(ray, *data.surface); });
    for (const ConvexPiece& piece : data.pieces) {
        cast_in(pose * piece.local, [&](RayProbe& ray) {
            if (may_meet(ray, piece.convex.bounds)) cast_at_convex(ray, piece.convex);
        });
    }
    return best;
}

}  // namespace embody::physics::collision
