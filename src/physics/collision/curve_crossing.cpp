// SPDX-License-Identifier: MIT
#include "physics/collision/curve_crossing.h"

#include <cmath>

#include "physics/collision/rim.h"

namespace embody::physics {

namespace {

// Directions within this sine of a side's or an edge's normal plane are taken to mean the side or the edge.
constexpr double beside = 0.05;

/// A point (tangent zero), a straight line, or the circle of a rim; and the point on it where the other is looked for.
struct Curve {
    bool is_circle = false;
    Vec3 center, axis, outward;  ///< of a circle
    double radius = 0;           ///< of a circle
    double reach = 0;            ///< of the solid's core around the curve
    Vec3 point, tangent;

    // Goes along the tangent and back to the curve.
    void go(double way) {
        point += tangent * way;
        if (!is_circle) return;
        const Vec3 from_center = point - center;
        outward = normalized(from_center - axis * dot(axis, from_center), outward);
        point = center + outward * radius;
        tangent = cross(axis, outward);
    }
    // How much faster than the tangent's the distance to the other curve grows, by the circle's own bend.
    [[nodiscard]] double bend(Vec3 way_to_other) const { return is_circle ? dot(way_to_other, outward) / radius : 0; }
};

bool get_round_curve(const PlacedConvex& round, Vec3 direction, Curve& curve) {
    const Convex& shape = *round.shape;
    const Vec3 d = round.direction_to_local(direction);
    const RimStart start = rim_start(d);
    const bool is_cone = shape.kind == ConvexKind::cone;
    if (is_cone) {
        const ConeSlope slope = cone_slope(shape);
        const double across = dot(d, start.along) * slope.axial - d.y * slope.radial;
        if (std::fabs(across) < beside) return false;
        if (across < 0) {
            curve.point = round.to_frame({0, shape.half_height, 0});
            return true;
        }
    } else if (std::fabs(d.y) < beside) {
        curve.point = round.position;
        curve.tangent = round.rotation.y;
        curve.reach = shape.radius;
        return true;
    }
    const Vec3 base{0, is_cone || d.y < 0 ? -shape.half_height : shape.half_height, 0};
    curve.is_circle = true;
    curve.center = round.to_frame(base);
    curve.axis = round.rotation.y;
    curve.radius = shape.radius;
    curve.outward = round.direction_to_frame(start.along);
    curve.point = curve.center + curve.outward * curve.radius;
    curve.tangent = cross(curve.axis, curve.outward);
    return true;
}

// Of the edges at the farthest vertex the one most across the direction, or else the vertex.
void get_corner_curve(const PlacedConvex& placed, Vec3 direction, Curve& curve) {
    const Polytope& polytope = placed.shape->polytope;
    const Vec3 d = placed.direction_to_local(direction);
    const std::uint32_t vertex = support_vertex(polytope, d);
    curve.point = placed.to_frame(polytope.vertices[vertex]);
    double least = beside;
    for (const Polytope::Edge& edge : polytope.edges) {
        if (edge.from != vertex && edge.to != vertex) continue;
        const Vec3 e = normalized(polytope.vertices[edge.to] - polytope.vertices[edge.from]);
        const double slope = std::fabs(dot(e, d));
        if (slope >= least) continue;
        least = slope;
        curve.tangent = placed.direction_to_frame(e);
    }
}

bool get_curve(const PlacedConvex& convex, Vec3 direction, Curve& curve) {
    switch (convex.shape->kind) {
        case ConvexKind::sphere:
            curve.point = convex.position;
            return true;
        case ConvexKind::capsule: {
            const double up = dot(convex.rotation.y, direction), h = convex.shape->half_height;
            curve.point = convex.position;
            if (std::fabs(up) < beside) {
                curve.tangent = convex.rotation.y;
            } else {
                curve.point += convex.rotation.y * (up < 0 ? -h : h);
            }
            return true;
        }
        case ConvexKind::polytope:
            get_corner_curve(convex, direction, curve);
            return true;
        case ConvexKind::cylinder:
        case ConvexKind::cone:
            break;
    }
    return get_round_curve(convex, direction, curve);
}

// Newton's method on half the squared distance of two points on the curves; false where it does not converge.
bool approach(Curve& p, Curve& q) {
    constexpr int most_steps = 12;
    const double size = 1e-300 + p.radius + q.radius + length(q.point - p.point);
    for (int step = 0; step < most_steps; ++step) {
        const Vec3 gap = q.point - p.point;
        const double cosine = dot(p.tangent, q.tangent);
        const double slope_p = dot(gap, p.tangent), slope_q = dot(gap, q.tangent);
        const double bent_p = 1 + p.bend(gap), bent_q = 1 - q.bend(gap);
        const double determinant = bent_p * bent_q - cosine * cosine;
        if (!(std::fabs(determinant) > 1e-3)) return false;
        const double way_p = (bent_q * slope_p - cosine * slope_q) / determinant;
        const double way_q = (cosine * slope_p - bent_p * slope_q) / determinant;
        if (!(std::fabs(way_p) + std::fabs(way_q) < 16 * size)) return false;
        p.go(way_p);
        q.go(way_q);
        if (std::fabs(way_p) + std::fabs(way_q) < 1e-9 * size) return true;
    }
    return false;
}

}  // namespace

bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing) {
    constexpr double least_sine = 0.03;
    Curve p, q;
    if (!get_curve(a, direction, p) || !get_curve(b, -direction, q) || !approach(p, q)) return false;

    // Across both tangents; where one has none, or they are nearly parallel, along the gap.
    const Vec3 across = cross(p.tangent, q.tangent), gap = q.point - p.point;
    const double sine = length(across), apart = length(gap);
    const double scale = p.radius + q.radius + p.reach + q.reach + rounding(*a.shape) + rounding(*b.shape);
    const bool is_crossing = sine > least_sine;
    if (!is_crossing && !(apart > 1e-6 * scale)) return false;
    Vec3 n = is_crossing ? across / sine : gap / apart;
    if (dot(n, direction) < 0) n = -n;
    crossing = {p.point + n * p.reach, q.point - n * q.reach, n};
    return true;
}

}  // namespace embody::physics
