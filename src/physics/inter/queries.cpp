// SPDX-License-Identifier: MIT
#include "physics/inter/queries.h"

#include <algorithm>
#include <cmath>

#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

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
        if (separation(*solid.value(), pose, *world.rigid.record(body).shape, world.rigid.pose(body), 0) > 0) return;
        found.push_back(world.rigid.bodies.handle_at(body));
    });
    return found;
}

namespace {

// Conservative advancement straight down: the gap to the other body bounds the distance that the body can move.
std::optional<double> drop_onto(const WorldState& world, std::uint32_t body, std::uint32_t other, double limit) {
    constexpr double touch = 1e-6;       // m
    constexpr int max_iterations = 256;  // of conservative advancement; the body stays above the ground then
    const CollisionShape& shape = *world.rigid.record(body).shape;
    const CollisionShape& ground = *world.rigid.record(other).shape;
    Transform pose = world.rigid.pose(body);
    const double start = pose.position.y;
    double fallen = 0;
    for (int iteration = 0; iteration < max_iterations && fallen <= limit; ++iteration) {
        const double gap = separation(shape, pose, ground, world.rigid.pose(other), limit);
        if (gap <= touch) return fallen;
        fallen += gap;
        pose.position.y = start - fallen;
    }
    return fallen <= limit ? std::optional(fallen) : std::nullopt;
}

}  // namespace

std::optional<double> drop_distance(const WorldState& world, std::uint32_t body, double max_distance,
                                    const std::function<bool(BodyHandle)>& ignores) {
    const BodyRecord& record = world.rigid.record(body);
    if (!record.shape || is_static_only(record.shape->definition()) || !(max_distance > 0)) return std::nullopt;
    Bounds swept = record.shape->bounds(world.rigid.pose(body));
    swept.lower.y -= max_distance;
    std::optional<double> least;
    world.contacts.broad_phase.query(swept, [&](std::uint32_t other) {
        if (other == body || (ignores && ignores(world.rigid.bodies.handle_at(other)))) return;
        const auto distance = drop_onto(world, body, other, least ? *least : max_distance);
        if (distance && (!least || *distance < *least)) least = distance;
    });
    return least;
}

}  // namespace embody::physics
