// SPDX-License-Identifier: MIT
#include "physics/collision/curve_crossing.h"

#include <cmath>

#include "physics/collision/rim.h"

namespace embody::physics {

namespace {

/// A straight edge, or the circle of a rim, with the point on it where the other curve is looked for.
struct Curve {
    bool is_circle = false;
    Vec3 center, axis;  ///< of a circle
    double radius = 0;
    Vec3 point, tangent;

    // Goes along the tangent and back to the curve.
    void go(double way) {
        point += tangent * way;
        if (!is_circle) return;
        const Vec3 from_center = point - center;
        const Vec3 outward = normalized(from_center - axis * dot(axis, from_center), tangent);
        point = center + outward * radius;
        tangent = cross(axis, outward);
    }
};

bool get_rim(const PlacedConvex& round, Vec3 direction, Curve& curve) {
    const Convex& shape = *round.shape;
    const Vec3 d = round.direction_to_local(direction);
    const bool is_cone = shape.kind == ConvexKind::cone;
    const RimStart start = rim_start(d);
    const Vec3 base{0, is_cone || d.y < 0 ? -shape.half_height : shape.half_height, 0};
    // Of a cone the apex may lie farther, which has no rim.
    if (is_cone && d.y * shape.half_height > dot(d, start.along * shape.radius + base)) return false;
    curve.is_circle = true;
    curve.center = round.to_frame(base);
    curve.axis = round.rotation.y;
    curve.radius = shape.radius;
    curve.point = round.to_frame(base + start.along * shape.radius);
    curve.tangent = cross(curve.axis, round.direction_to_frame(start.along));
    return true;
}

// Of the edges at the farthest vertex, the one most across the direction.
bool get_edge(const PlacedConvex& placed, Vec3 direction, Curve& curve) {
    const Polytope& polytope = placed.shape->polytope;
    const Vec3 d = placed.direction_to_local(direction);
    const std::uint32_t vertex = support_vertex(polytope, d);
    double least = 2;
    Vec3 along;
    for (const Polytope::Edge& edge : polytope.edges) {
        if (edge.from != vertex && edge.to != vertex) continue;
        const Vec3 e = normalized(polytope.vertices[edge.to] - polytope.vertices[edge.from]);
        const double slope = std::fabs(dot(e, d));
        if (slope >= least) continue;
        least = slope;
        along = e;
    }
    if (least > 1) return false;
    curve.is_circle = false;
    curve.point = placed.to_frame(polytope.vertices[vertex]);
    curve.tangent = placed.direction_to_frame(along);
    return true;
}

bool get_curve(const PlacedConvex& convex, Vec3 direction, Curve& curve) {
    switch (convex.shape->kind) {
        case ConvexKind::sphere:
        case ConvexKind::capsule:
            return false;
        case ConvexKind::polytope:
            return get_edge(convex, direction, curve);
        case ConvexKind::cylinder:
        case ConvexKind::cone:
            break;
    }
    return get_rim(convex, direction, curve);
}

}  // namespace

bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing) {
    constexpr int most_steps = 8;
    constexpr double least_sine_squared = 1e-3;
    Curve p, q;
    if (!get_curve(a, direction, p) || !get_curve(b, -direction, q)) return false;

    // Nearest points of the two tangents, again and again.
    for (int step = 0; step < most_steps; ++step) {
        const double cosine = dot(p.tangent, q.tangent);
        const double sine_squared = 1 - cosine * cosine;
        if (sine_squared < least_sine_squared) return false;
        const Vec3 gap = q.point - p.point;
        const double along_p = dot(gap, p.tangent), along_q = dot(gap, q.tangent);
        const double way_p = (along_p - cosine * along_q) / sine_squared;
        const double way_q = (cosine * along_p - along_q) / sine_squared;
        if (p.is_circle && std::fabs(way_p) > 4 * p.radius) return false;
        if (q.is_circle && std::fabs(way_q) > 4 * q.radius) return false;
        p.go(way_p);
        q.go(way_q);
        if (std::fabs(way_p) + std::fabs(way_q) < 1e-10 * (p.radius + q.radius)) break;
    }
    const Vec3 across = cross(p.tangent, q.tangent);
    const double sine = length(across);
    if (sine * sine < least_sine_squared) return false;
    crossing = {p.point, q.point, across * ((dot(across, direction) < 0 ? -1 : 1) / sine)};
    return true;
}

}  // namespace embody::physics
