// SPDX-License-Identifier: MIT
#include "physics/inter/queries.h"

#include <algorithm>
#include <cmath>

#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

/// Gaps beyond this need not be known where only overlaps count, m; at 0 separation() cannot tell a gap from a touch.
constexpr double far_enough = 1e-3;

}  // namespace

std::optional<RayHit> cast_ray(const WorldState& world, Vec3 origin, Vec3 direction, double max_distance,
                               BodyHandle ignore) {
    const Vec3 unit = normalized(direction);
    if (unit == Vec3{} || !is_finite(unit) || !is_finite(origin) || !(max_distance > 0)) return std::nullopt;
    std::optional<RayHit> nearest;
    world.contacts.broad_phase.query_ray(origin, unit, max_distance, [&](std::uint32_t body, double limit) {
        const BodyHandle handle = world.rigid.bodies.handle_at(body);
        if (handle == ignore) return limit;
        const auto hit = cast_ray(*world.rigid.record(body).shape, world.rigid.pose(body), origin, unit, limit);
        if (!hit || (nearest && hit->distance >= nearest->distance)) return limit;
        nearest = RayHit{handle, origin + unit * hit->distance, hit->normal, hit->distance};
        return hit->distance;
    });
    return nearest;
}

std::vector<BodyHandle> overlap_box(const WorldState& world, const Bounds& box) {
    std::vector<BodyHandle> found;
    if (box.is_empty() || !is_finite(box.lower) || !is_finite(box.upper)) return found;

    // A thin box is made a little thicker: the narrow phase needs a solid.
    constexpr double thinnest = 1e-6;
    const Vec3 half = max(box.half_extents(), Vec3{thinnest, thinnest, thinnest});
    const auto solid = CollisionShape::create(BoxShape{half});
    if (!solid) return found;
    const Transform pose{box.center(), Quat{}};
    world.contacts.broad_phase.query(box, [&](std::uint32_t body) {
        if (separation(*solid.value(), pose, *world.rigid.record(body).shape, world.rigid.pose(body), far_enough) > 0)
            return;
        found.push_back(world.rigid.bodies.handle_at(body));
    });
    return found;
}

namespace {

// The distance that the shape can move along the unit direction until it touches the other one.
std::optional<double> cast_at(const ShapeCast& cast, const CollisionShape& other, const Transform& pose, double limit) {
    const Transform end{cast.pose.position + cast.direction * limit, cast.pose.rotation};
    const auto time = time_of_impact(*cast.shape, cast.pose, end, other, pose, 0);
    return time ? std::optional(*time * limit) : std::nullopt;
}

}  // namespace

std::optional<double> cast_shape(const WorldState& world, const ShapeCast& cast, double max_distance,
                                 const IgnoresBody& ignores) {
    const double size = length(cast.direction);
    if (!(max_distance > 0) || !std::isfinite(max_distance) || !(std::fabs(size - 1) < 1e-6)) return std::nullopt;
    if (is_static_only(cast.shape->definition())) return std::nullopt;
    const Bounds start = cast.shape->bounds(cast.pose);
    Bounds swept = start;
    swept.add(Bounds{start.lower + cast.direction * max_distance, start.upper + cast.direction * max_distance});
    std::optional<double> least;
    world.contacts.broad_phase.query(swept, [&](std::uint32_t other) {
        if (ignores && ignores(world.rigid.bodies.handle_at(other))) return;
        const auto distance =
            cast_at(cast, *world.rigid.record(other).shape, world.rigid.pose(other), least ? *least : max_distance);
        if (distance && (!least || *distance < *least)) least = std::fmax(*distance, 1e-300);
    });
    return least;
}

bool overlaps(const WorldState& world, const CollisionShape& shape, const Transform& pose, const IgnoresBody& ignores) {
    if (is_static_only(shape.definition())) return false;
    bool found = false;
    world.contacts.broad_phase.query(shape.bounds(pose), [&](std::uint32_t other) {
        if (found || (ignores && ignores(world.rigid.bodies.handle_at(other)))) return;
        found = separation(shape, pose, *world.rigid.record(other).shape, world.rigid.pose(other), far_enough) <= 0;
    });
    return found;
}

}  // namespace embody::physics
