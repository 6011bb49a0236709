// SPDX-License-Identifier: MIT
#include "physics/collision/pairs/curve_crossing.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/shapes/rim.h"

namespace embody::physics::collision {

namespace {

// Directions within this sine of a side's or an edge's normal plane are taken to mean the side or the edge.
constexpr double beside = 0.05;
// Lines at a smaller angle than this count as parallel.
constexpr double min_sine = 0.03;  // of the angle between lines: 1.7 degrees

/// A point (tangent zero), a straight line, or the circle of a rim; and the point on it where the search begins.
struct Curve {
    bool is_circle = false;
    Vec3 center, axis, outward;  ///< of a circle
    double radius = 0;           ///< of a circle
    double reach = 0;            ///< of the solid's core around the curve
    Vec3 point, tangent;
    Vec3 from, to;  ///< ends of a line, along the tangent

    [[nodiscard]] bool is_line() const { return !is_circle && tangent != Vec3{}; }
    // The distance to the nearer end of the line; negative beyond its ends.
    [[nodiscard]] double room() const { return std::min(dot(point - from, tangent), dot(to - point, tangent)); }
    [[nodiscard]] bool is_beyond_end() const { return is_line() && room() < 0; }
    // The point of the solid's core that is farthest in the direction n, around a line perpendicular to it.
    [[nodiscard]] Vec3 on_surface(Vec3 n) const {
        return reach == 0 ? point : point + normalized(n - tangent * dot(n, tangent)) * reach;
    }
    void stay_within() {
        if (is_beyond_end()) point = dot(point - from, tangent) < 0 ? from : to;
    }
    // Moves along the tangent and back to the curve.
    void go(double displacement) {
        point += tangent * displacement;
        if (!is_circle) return;
        const Vec3 from_center = point - center;
        outward = normalized(from_center - axis * dot(axis, from_center), outward);
        point = center + outward * radius;
        tangent = cross(axis, outward);
    }
    // How much faster than with the tangent the distance to the other curve grows, by the circle's own curvature.
    [[nodiscard]] double curvature(Vec3 direction_to_other) const {
        return is_circle ? dot(direction_to_other, outward) / radius : 0;
    }
};

void set_axis(const PlacedConvex& round, Curve& curve) {
    curve.tangent = round.rotation.y;
    curve.from = round.to_frame({0, -round.shape->half_height, 0});
    curve.to = round.to_frame({0, round.shape->half_height, 0});
}

bool get_round_curve(const PlacedConvex& round, Vec3 direction, Curve& curve) {
    const Convex& shape = *round.shape;
    const Vec3 d = round.direction_to_local(direction);
    const RimStart start = rim_start(d);
    const bool is_cone = shape.kind == ConvexKind::cone;
    if (is_cone) {
        const ConeSlope slope = cone_slope(shape);
        const double across = dot(d, start.along) * slope.axial - d.y * slope.radial;
        if (std::fabs(across) < beside) {
            // The line of the side that faces the direction.
            curve.from = round.to_frame(start.along * shape.radius - Vec3{0, shape.half_height, 0});
            curve.to = round.to_frame({0, shape.half_height, 0});
            curve.point = curve.from;
            curve.tangent = normalized(curve.to - curve.from);
            return true;
        }
        if (across < 0) {
            curve.point = round.to_frame({0, shape.half_height, 0});
            return true;
        }
    } else if (std::fabs(d.y) < beside) {
        curve.point = round.position;
        set_axis(round, curve);
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
        curve.from = placed.to_frame(polytope.vertices[edge.from]);
        curve.to = placed.to_frame(polytope.vertices[edge.to]);
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
                set_axis(convex, curve);
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
    constexpr int max_steps = 12;  // of Newton's method; what needs more has no one crossing
    const double size = 1e-300 + p.radius + q.radius + length(q.point - p.point);
    for (int step = 0; step < max_steps; ++step) {
        const Vec3 gap = q.point - p.point;
        const double cosine = dot(p.tangent, q.tangent);
        const double slope_p = dot(gap, p.tangent), slope_q = dot(gap, q.tangent);
        const double curved_p = 1 + p.curvature(gap), curved_q = 1 - q.curvature(gap);
        const double determinant = curved_p * curved_q - cosine * cosine;
        if (!(std::fabs(determinant) > 1e-7)) return false;
        const double displacement_p = (curved_q * slope_p - cosine * slope_q) / determinant;
        const double displacement_q = (cosine * slope_p - curved_p * slope_q) / determinant;
        if (!(std::fabs(displacement_p) + std::fabs(displacement_q) < 16 * size)) return false;
        p.go(displacement_p);
        q.go(displacement_q);
        if (std::fabs(displacement_p) + std::fabs(displacement_q) < 1e-9 * size) return true;
    }
    return false;
}

// Moves to the nearest points of two segments whose lines are nearest beyond an end, or of a segment and a close curve.
void stay_within(Curve& p, Curve& q) {
    p.stay_within();
    if (q.is_line()) q.point += q.tangent * dot(p.point - q.point, q.tangent);
    q.stay_within();
    if (p.is_line()) p.point += p.tangent * dot(q.point - p.point, p.tangent);
    p.stay_within();
}

// The feature at the end of a line: the rim of a side, at its point nearest to the other curve, or the end itself.
void turn_to_end(Curve& curve, Vec3 other) {
    if (!curve.is_line() || curve.room() > 0) return;
    if (curve.reach == 0) {
        curve.tangent = {};
        return;
    }
    const Vec3 displacement = other - curve.point, axis = curve.tangent;
    const Vec3 outward = normalized(displacement - axis * dot(displacement, axis), any_perpendicular(axis));
    curve = {.is_circle = true, .center = curve.point, .axis = axis, .outward = outward, .radius = curve.reach};
    curve.point = curve.center + outward * curve.radius;
    curve.tangent = cross(axis, outward);
}

// Moves to the middle of the common part of two parallel lines, or to the ends that are nearest.
void meet_halfway(Curve& p, Curve& q) {
    const double whole = dot(p.to - p.from, p.tangent);
    const double s = std::clamp(dot(q.from - p.from, p.tangent), 0.0, whole);
    const double t = std::clamp(dot(q.to - p.from, p.tangent), 0.0, whole);
    p.point = p.from + p.tangent * (0.5 * (s + t));
    q.point += q.tangent * dot(p.point - q.point, q.tangent);
    q.stay_within();
}

// The normal across both tangents; where one has none, or they are nearly parallel, along the gap, unless the gap is
// too short: then zero.
Vec3 common_normal(const Curve& p, const Curve& q, Vec3 direction, double shortest) {
    const Vec3 across = cross(p.tangent, q.tangent), gap = q.point - p.point;
    const double sine = length(across), apart = length(gap);
    if (sine <= min_sine && !(apart > shortest)) return {};
    const Vec3 n = sine > min_sine ? across / sine : gap / apart;
    return dot(n, direction) < 0 ? -n : n;
}

/// How much of the difference of two solids a curve contains around its point: see is_best_crossing.
struct Hold {
    double depth, width;
};
Hold hold_of(const Curve& curve, double square) {
    if (curve.is_circle) return {0.2 * curve.radius * square, 0.4 * curve.radius * square};
    const double width = curve.room() * std::sqrt(square);
    return {width, width};
}

// Whether the normal n of two curves that cross at a depth d is the best one. It is if the difference b - a holds the
// ball of radius d around the origin, for it touches that ball at -d n: if it reaches as far as d along each unit k.
// Let k lean from -n by an angle x, towards a unit vector w across n. Some pair of points of the curves reaches d cos x
// plus what one of them adds, with t the cosine between its tangent and w:
//     a line that goes on by l to both sides                          l t sin x
//     a circle of radius r, points up to t r / sqrt(2) aside at least 0.2 t^2 r sin x, or 0.36 t^2 r (1 - cos x)
// (a point s aside lies at most 0.536 s^2 / r inside of the tangent while s <= r / 2). Of two tangents at an angle y
// one has t >= sin(y / 2). So up to a right angle the depth must be at most l t and 0.2 t^2 r, for 1 - cos x <= sin x.
// Beyond it, at x = 90 degrees + z, the curves reach width cos z - d sin z, with the width l t or 0.4 t^2 r: far enough
// until tan(45 degrees - z / 2) = d / width. From there on the balls inside the two solids must reach that far.
bool is_best_crossing(const PlacedConvex& a, const PlacedConvex& b, const Curve& p, const Curve& q, Vec3 n) {
    if (p.tangent == Vec3{} || q.tangent == Vec3{} || length_squared(cross(p.tangent, q.tangent)) < min_sine * min_sine)
        return false;
    const double d = dot(n, p.point - q.point), square = 0.5 * (1 - std::fabs(dot(p.tangent, q.tangent)));
    const Hold of_p = hold_of(p, square), of_q = hold_of(q, square);
    if (!(d > 0 && d <= std::min(of_p.depth, of_q.depth))) return false;

    const double ratio = d / std::min(of_p.width, of_q.width), squared = ratio * ratio;
    const Vec3 displacement = interior_point(b) - interior_point(a);
    const double along = dot(displacement, n), aside = length(displacement - n * along);
    const double radii = a.shape->inner + b.shape->inner;
    return along >= 0 && along * (1 - squared) - 2 * ratio * aside + (radii - d) * (1 + squared) >= 0;
}

}  // namespace

bool cross_curves(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction, CurveCrossing& crossing) {
    Curve p, q;
    if (!get_curve(a, direction, p) || !get_curve(b, -direction, q)) return false;
    const auto offer_points = [&](Vec3 n) {
        crossing = {p.on_surface(n), q.on_surface(-n), n};
        return true;
    };
    if (p.is_line() && q.is_line() && length_squared(cross(p.tangent, q.tangent)) < min_sine * min_sine) {
        meet_halfway(p, q);
        return offer_points(direction);
    }
    if (!approach(p, q)) return false;
    if (p.is_beyond_end() || q.is_beyond_end()) {
        stay_within(p, q);
        offer_points(direction);
        const Vec3 on_p = p.point, on_q = q.point;
        turn_to_end(p, on_q);
        turn_to_end(q, on_p);
        if (!approach(p, q) || p.is_beyond_end() || q.is_beyond_end()) return true;
    }
    const double radii = rounding(*a.shape) + rounding(*b.shape);
    const Vec3 n = common_normal(p, q, direction, 1e-6 * (p.radius + q.radius + p.reach + q.reach + radii));
    if (n == Vec3{}) return false;
    offer_points(n);
    crossing.is_within = true;
    crossing.is_best = p.reach + q.reach + radii == 0 && is_best_crossing(a, b, p, q, n);
    return true;
}

}  // namespace embody::physics::collision
