// SPDX-License-Identifier: MIT
// Conservative advancement: B. Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996: time goes on by
// what the gap allows at the highest speed at which any point can approach along the gap's own direction.
#include <algorithm>
#include <array>
#include <cmath>

#include "foundation/assert.h"
#include "physics/collision/collision_shape.h"
#include "physics/collision/collision_shape_data.h"
#include "physics/collision/gjk.h"

namespace embody::physics {

namespace {

/// Distance between two convex parts and the direction from a's to b's, zero where they overlap.
struct Gap {
    double distance = 0;
    Vec3 direction;
};

Gap gap_between(const PlacedConvex& a, const PlacedConvex& b, double enough) {
    const double radii = rounding(*a.shape) + rounding(*b.shape);
    const CoreDistance gap = core_distance(Core(a), Core(b), enough + radii);
    return {gap.distance - radii, gap.distance > 0 ? (gap.on_b - gap.on_a) / gap.distance : Vec3{}};
}

Bounds bounds_in_surface(const PlacedConvex& convex, const Transform& surface_pose, Vec3 origin) {
    // Of a's box turned into the surface's frame.
    const Vec3 h = convex.shape->bounds.half_extents();
    const Mat3 r = to_matrix(conjugate(surface_pose.rotation)) * convex.rotation;
    const Vec3 c = inverse_transform_point(surface_pose, origin + convex.to_frame(convex.shape->bounds.center()));
    const Vec3 e = abs(r.x) * h.x + abs(r.y) * h.y + abs(r.z) * h.z;
    return {c - e, c + e};
}

// Calls visit(gap) for each pair of convex parts nearer than `enough`; a has pieces.
template <class Visit>
void for_each_gap(const CollisionShape::Data& a, const Transform& pose_a, const CollisionShape::Data& b,
                  const Transform& pose_b, double enough, Visit&& visit) {
    const Vec3 origin = pose_a.position;
    for (const ConvexPiece& piece : a.pieces) {
        const PlacedConvex placed = place(piece, pose_a, origin);
        if (b.is_plane) {
            const Vec3 n = rotate(pose_b.rotation, b.plane_normal);
            const double offset = b.plane_offset + dot(n, pose_b.position - origin);
            visit(Gap{dot(n, core_support(placed, -n)) - rounding(piece.convex) - offset, -n});
        } else if (b.surface) {
            // Triangles that show their front; one by one as flat convexes.
            thread_local std::vector<std::uint32_t> near;
            thread_local Convex triangle{ConvexKind::polytope, 0, 0, triangle_polytope({}, {1, 0, 0}, {0, 0, 1}), {}};
            near.clear();
            b.surface->find(enlarged(bounds_in_surface(placed, pose_b, origin), std::min(enough, 1e7)), near);
            const PlacedConvex frame{&triangle, to_matrix(pose_b.rotation), pose_b.position - origin};
            for (const std::uint32_t index : near) {
                const auto [p, q, r] = b.surface->corners(index);
                set_triangle(triangle.polytope, p, q, r);
                const Vec3 inside = frame.to_local(interior_point(placed));
                if (dot(triangle.polytope.faces[0].normal, inside - p) <= 0) continue;
                visit(gap_between(placed, frame, enough));
            }
        } else {
            for (const ConvexPiece& other : b.pieces) {
                visit(gap_between(placed, place(other, pose_b, origin), enough));
            }
        }
    }
}

/// The path of a: its origin on a line, its rotation along the shortest arc (normalised linear interpolation).
struct Motion {
    Transform start, end;
    double turn_bound = 0;  ///< largest angular speed, rad per unit of time

    Motion(const Transform& from, const Transform& to) : start(from), end(to) {
        if (dot(start.rotation, end.rotation) < 0) {
            end.rotation = {-end.rotation.x, -end.rotation.y, -end.rotation.z, -end.rotation.w};
        }
        // The angle is 2 asin(s); asin(s) <= s + (pi/2 - 1) s³. The interpolation is at most 4/pi times faster halfway.
        const Quat q = conjugate(start.rotation) * end.rotation;
        const double s = std::fmin(1.0, std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z));
        turn_bound = 2 * (s + 0.5707963267948967 * s * s * s) * 1.2732395447351628;
    }
    [[nodiscard]] Transform at(double t) const {
        const Quat p = start.rotation, q = end.rotation;
        const Quat mixed{p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t, p.z + (q.z - p.z) * t, p.w + (q.w - p.w) * t};
        return {start.position + (end.position - start.position) * t, normalized(mixed)};
    }
};

}  // namespace

double separation(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
                  double enough) {
    if (is_static_only(a.definition())) return separation(b, pose_b, a, pose_a, enough);
    EMBODY_ASSERT(!is_static_only(a.definition()));
    double least = std::fmax(enough, 0);
    for_each_gap(a.data(), pose_a, b.data(), pose_b, enough,
                 [&least](const Gap& gap) { least = std::fmin(least, gap.distance); });
    return least;
}

std::optional<double> time_of_impact(const CollisionShape& a, const Transform& pose_a_start,
                                     const Transform& pose_a_end, const CollisionShape& b, const Transform& pose_b,
                                     double target_separation) {
    EMBODY_ASSERT(!is_static_only(a.definition()));
    constexpr int most_rounds = 128;
    const Motion motion(pose_a_start, pose_a_end);
    const Vec3 way = pose_a_end.position - pose_a_start.position;
    const double turn_speed = motion.turn_bound * a.radius_about({});
    const double tolerance = std::fmax(1e-3 * std::fabs(target_separation), 1e-9 * (1 + length(way)));

    // Whatever is farther than the whole motion cannot be met.
    double time = 0;
    for (int round = 0; round < most_rounds; ++round) {
        const double reach = (length(way) + turn_speed) * (1 - time) + target_separation + tolerance;
        double step = 1;
        bool touches = false;
        for_each_gap(a.data(), motion.at(time), b.data(), pose_b, reach, [&](const Gap& gap) {
            // Parts that move away from each other are no impact, even if they touch now.
            // Overlapping ones have no direction to tell.
            const double speed = dot(way, gap.direction) + turn_speed;
            if (speed <= 0 && length_squared(gap.direction) > 0) return;
            const double left = gap.distance - target_separation;
            touches = touches || left <= tolerance;
            if (speed > 0) step = std::fmin(step, left / speed);
        });
        if (touches) return time;
        time += step;
        if (time >= 1) return std::nullopt;
    }
    return time;
}

}  // namespace embody::physics
