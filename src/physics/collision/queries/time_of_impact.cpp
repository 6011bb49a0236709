// SPDX-License-Identifier: MIT
// Conservative advancement: B. Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996: time advances
// by the gap over the highest speed at which any point can approach along the gap's own direction.
#include <algorithm>
#include <array>
#include <cmath>

#include "foundation/assert.h"
#include "physics/collision/queries/gjk.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {

namespace {

/// Two convex parts of two shapes: pieces, or a triangle of b; 0 for a plane.
struct PartPair {
    std::uint32_t a = 0, b = 0;
    friend bool operator==(const PartPair&, const PartPair&) = default;
};

/// Distance between two convex parts and the direction from a's to b's, zero where they overlap.
struct Gap {
    double distance = 0;
    Vec3 direction;
    PartPair parts;
};

/// Two shapes at one moment, in world axes at a's position.
struct PosedShapes {
    const CollisionShape::Data& a;
    const CollisionShape::Data& b;
    Transform pose_a, pose_b;

    [[nodiscard]] PlacedConvex placed_a(std::uint32_t piece) const {
        return place(a.pieces[piece], pose_a, pose_a.position);
    }
    [[nodiscard]] PlacedConvex placed_b(std::uint32_t piece) const {
        return place(b.pieces[piece], pose_b, pose_a.position);
    }
    // A triangle as a flat convex; valid until the next call on this thread.
    [[nodiscard]] PlacedConvex placed_triangle(std::uint32_t index) const {
        thread_local Convex flat{ConvexKind::polytope, 0, 0, triangle_polytope({}, {1, 0, 0}, {0, 0, 1}), {}};
        const auto [p, q, r] = b.surface->corners(index);
        set_triangle(flat.polytope, p, q, r);
        return {&flat, to_matrix(pose_b.rotation), pose_b.position - pose_a.position};
    }
    [[nodiscard]] Vec3 plane_normal() const { return rotate(pose_b.rotation, b.plane_normal); }
    // Height of a piece over b's plane.
    [[nodiscard]] double height_over_plane(const PlacedConvex& piece) const {
        const Vec3 n = plane_normal();
        const double offset = b.plane_offset + dot(n, pose_b.position - pose_a.position);
        return dot(n, core_support(piece, -n)) - rounding(*piece.shape) - offset;
    }
    // Gap of two parts along the direction from a to b in which they met. For a triangle its own normal counts,
    // whatever the direction: nothing passes it without getting behind it, and a body that slides on from the triangle
    // before meets its edge head on.
    [[nodiscard]] double gap_along(const PartPair& parts, Vec3 direction) const {
        const PlacedConvex piece = placed_a(parts.a);
        if (b.is_plane) return height_over_plane(piece);
        if (!b.surface) return separation_along(piece, placed_b(parts.b), direction);
        const PlacedConvex triangle = placed_triangle(parts.b);
        return separation_along(piece, triangle,
                                -triangle.direction_to_frame(triangle.shape->polytope.faces[0].normal));
    }
};

Gap gap_between(const PlacedConvex& a, const PlacedConvex& b, double enough, PartPair parts) {
    const double radii = rounding(*a.shape) + rounding(*b.shape);
    const CoreDistance gap = core_distance(Core(a), Core(b), enough + radii);
    return {gap.distance - radii, gap.distance > 0 ? (gap.on_b - gap.on_a) / gap.distance : Vec3{}, parts};
}

// Bounds of a piece and of all places on its `path` (world axes), in the frame of b's surface.
Bounds bounds_in_surface(const PosedShapes& s, const PlacedConvex& piece, Vec3 displacement) {
    const Vec3 h = piece.shape->bounds.half_extents();
    const Mat3 r = to_matrix(conjugate(s.pose_b.rotation)) * piece.rotation;
    const Vec3 c = inverse_transform_point(s.pose_b, s.pose_a.position + piece.to_frame(piece.shape->bounds.center()));
    const Vec3 e = abs(r.x) * h.x + abs(r.y) * h.y + abs(r.z) * h.z;
    Bounds bounds{c - e, c + e};
    const Vec3 there = rotate_inverse(s.pose_b.rotation, displacement);
    bounds.add(Bounds{bounds.lower + there, bounds.upper + there});
    return bounds;
}

/// The reach of the search: gaps up to `enough`; of a surface only triangles within `beside` of the path.
struct Reach {
    double enough = 0;
    Vec3 displacement;
    double beside = 0;
};

// Calls visit(gap) for each pair of convex parts within reach; a has pieces.
template <class Visit>
void for_each_gap(const PosedShapes& s, const Reach& reach, Visit&& visit) {
    for (std::uint32_t i = 0; i < s.a.pieces.size(); ++i) {
        const PlacedConvex piece = s.placed_a(i);
        if (s.b.is_plane) {
            visit(Gap{s.height_over_plane(piece), -s.plane_normal(), {i, 0}});
        } else if (s.b.surface) {
            // Triangles that show their front; one by one as flat convexes.
            thread_local std::vector<std::uint32_t> near;
            near.clear();
            s.b.surface->find(enlarged(bounds_in_surface(s, piece, reach.displacement), std::min(reach.beside, 1e7)),
                              near);
            for (const std::uint32_t index : near) {
                const PlacedConvex triangle = s.placed_triangle(index);
                const Polytope& flat = triangle.shape->polytope;
                const Vec3 inside = triangle.to_local(interior_point(piece));
                if (dot(flat.faces[0].normal, inside - flat.vertices[0]) <= 0) continue;
                visit(gap_between(piece, triangle, reach.enough, {i, index}));
            }
        } else {
            for (std::uint32_t k = 0; k < s.b.pieces.size(); ++k) {
                visit(gap_between(piece, s.placed_b(k), reach.enough, {i, k}));
            }
        }
    }
}

/// A moving shape: the centre on a line, the rotation along the shortest arc (normalised linear interpolation).
struct Motion {
    Quat start_rotation, end_rotation;
    Vec3 center, start_center, displacement;
    double turn_bound = 0;  ///< largest angular speed, rad per unit of time

    explicit Motion(const Sweep& sweep)
        : start_rotation(sweep.start.rotation),
          end_rotation(sweep.end.rotation),
          center(sweep.center),
          start_center(transform_point(sweep.start, sweep.center)),
          displacement(transform_point(sweep.end, sweep.center) - start_center) {
        if (dot(start_rotation, end_rotation) < 0) {
            end_rotation = {-end_rotation.x, -end_rotation.y, -end_rotation.z, -end_rotation.w};
        }
        // The angle is 2 asin(s); asin(s) <= s + (pi/2 - 1) s³. The interpolation is at most 4/pi times faster halfway.
        const Quat q = conjugate(start_rotation) * end_rotation;
        const double s = std::fmin(1.0, std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z));
        turn_bound = 2 * (s + 0.5707963267948967 * s * s * s) * 1.2732395447351628;
    }
    [[nodiscard]] Transform at(double t) const {
        const Quat p = start_rotation, q = end_rotation;
        const Quat mixed = normalized(
            Quat{p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t, p.z + (q.z - p.z) * t, p.w + (q.w - p.w) * t});
        return {start_center + displacement * t - rotate(mixed, center), mixed};
    }
    // No point of the shape moves faster than this by rotation.
    [[nodiscard]] double turn_speed(const CollisionShape& shape) const {
        return turn_bound > 0 ? turn_bound * shape.radius_about(center) : 0;
    }
};

/// Conservative advancement of two shapes.
struct Advancement {
    const CollisionShape& a;
    const CollisionShape& b;
    Motion motion_a, motion_b;
    ImpactSearch search;
    Vec3 displacement = motion_a.displacement - motion_b.displacement;  ///< of a seen from b
    double turn_speed = motion_a.turn_speed(a) + motion_b.turn_speed(b);
    double tolerance = std::fmax(1e-3 * std::fabs(search.target_separation), 1e-9 * (1 + length(displacement)));
    std::vector<PartPair> passed_over;

    [[nodiscard]] PosedShapes at(double time) const {
        return {a.data(), b.data(), motion_a.at(time), motion_b.at(time)};
    }
    // The parts that may be met in the rest of the time.
    [[nodiscard]] Reach reach_at(double time) const {
        const double near = turn_speed * (1 - time) + search.target_separation + tolerance;
        return {length(displacement) * (1 - time) + near, displacement * (1 - time), near};
    }
    // Passes over what touches at the start. Returns whether any other parts may be met on the whole path.
    [[nodiscard]] bool pass_over_touching() {
        if (search.touching_at_start < 0) return true;
        Reach reach = reach_at(0);
        reach.beside = std::fmax(reach.beside, search.touching_at_start);
        bool may_meet = turn_speed > 0;  // a triangle may come to show its front
        for_each_gap(at(0), reach, [&](const Gap& gap) {
            if (gap.distance <= search.touching_at_start) {
                passed_over.push_back(gap.parts);
            } else {
                may_meet = may_meet || gap.distance <= reach.enough;
            }
        });
        return may_meet;
    }
    [[nodiscard]] bool is_passed_over(const PartPair& parts) const {
        return std::find(passed_over.begin(), passed_over.end(), parts) != passed_over.end();
    }
};

}  // namespace

double separation(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
                  double enough) {
    if (is_static_only(a.definition())) return separation(b, pose_b, a, pose_a, enough);
    EMBODY_ASSERT(!is_static_only(a.definition()));
    double least = std::fmax(enough, 0);
    for_each_gap({a.data(), b.data(), pose_a, pose_b}, {enough, {}, enough},
                 [&least](const Gap& gap) { least = std::fmin(least, gap.distance); });
    return least;
}

std::optional<double> time_of_impact(const CollisionShape& a, const Sweep& path_a, const CollisionShape& b,
                                     const Sweep& path_b, const ImpactSearch& search) {
    EMBODY_ASSERT(!is_static_only(a.definition()));
    constexpr int max_iterations = 128;  // of conservative advancement; the time so far, which is early, serves then
    constexpr double harmless_step = 0.125;  // after which a harmless touch is looked at again
    Advancement advance{a, b, Motion(path_a), Motion(path_b), search};
    if (!advance.pass_over_touching()) return std::nullopt;
    const PosedShapes end = advance.at(1);
    double time = 0;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        double step = 1;
        bool touches = false;
        for_each_gap(advance.at(time), advance.reach_at(time), [&](const Gap& gap) {
            // Parts that move away from each other are no impact, even if they touch now.
            // Overlapping ones have no direction.
            const bool has_direction = length_squared(gap.direction) > 0;
            const double speed = dot(advance.displacement, gap.direction) + advance.turn_speed;
            if ((speed <= 0 && has_direction) || advance.is_passed_over(gap.parts)) return;
            const double left = gap.distance - search.target_separation;
            const bool is_near = left <= std::fmax(advance.tolerance, harmless_step * speed);
            const bool can_tell = has_direction || b.data().surface;
            if (is_near && can_tell && end.gap_along(gap.parts, gap.direction) >= -search.harmless_depth) {
                step = std::fmin(step, harmless_step);
                return;
            }
            touches = touches || left <= advance.tolerance;
            if (speed > 0) step = std::fmin(step, left / speed);
        });
        if (touches) return time;
        time += step;
        if (time >= 1) return std::nullopt;
    }
    return time;
}

std::optional<double> time_of_impact(const CollisionShape& a, const Transform& pose_a_start,
                                     const Transform& pose_a_end, const CollisionShape& b, const Transform& pose_b,
                                     double target_separation) {
    return time_of_impact(a, {pose_a_start, pose_a_end, {}}, b, {pose_b, pose_b, {}}, {target_separation});
}

}  // namespace embody::physics::collision
