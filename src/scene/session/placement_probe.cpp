// SPDX-License-Identifier: MIT
#include "scene/session/placement_probe.h"

#include <algorithm>

#include "scene/session/placement.h"

namespace embody::scene {

Result<PlacementProbe> PlacementProbe::make(const SessionState& state, const Entity& entity,
                                            const std::set<EntityIndex>& ignored) {
    const Result<physics::ShapeHandle> shape = state.simulation->solid_shape(entity);
    if (!shape.ok()) return shape.error();
    return PlacementProbe(*state.simulation, shape.value(), ignored);
}

physics::World::IgnoresBody PlacementProbe::filter() const {
    if (ignored_->empty()) return {};
    return [this](physics::BodyHandle body) { return ignored_->contains(simulation_->entity(body)); };
}

Bounds PlacementProbe::bounds(const Transform& pose) const { return simulation_->world().bounds(shape_, pose); }

bool PlacementProbe::has_bounds(const Transform& pose) const {
    const Bounds its = bounds(pose);
    return !its.is_empty() && is_finite(its.size()) && length(its.size()) < max_ray_length;
}

std::optional<double> PlacementProbe::travel(const Transform& pose, Vec3 direction, double most) const {
    return simulation_->world().cast_shape(shape_, pose, direction, most, filter());
}

bool PlacementProbe::overlaps(const Transform& pose) const {
    return simulation_->world().overlaps(shape_, pose, filter());
}

std::optional<Simulation::RayHit> PlacementProbe::cast_ray(Vec3 origin, Vec3 direction, double most) const {
    constexpr int max_ignored = 100;  // surfaces of things that are not there, one behind the other
    constexpr double past = 1e-5;     // m, behind such a surface the ray goes on
    double gone = 0;
    for (int i = 0; i < max_ignored; ++i) {
        auto hit = simulation_->cast_ray(origin + direction * gone, direction, most - gone);
        if (!hit) return hit;
        hit->distance += gone;
        if (!ignored_->contains(hit->entity)) return hit;
        gone = hit->distance + past;
        if (gone >= most) return std::nullopt;
    }
    return std::nullopt;
}

// Rays down from its base to what is no body: cushions, cloths, liquids.
std::optional<double> PlacementProbe::fall_on_points(const Bounds& from) const {
    constexpr int rays = 5;  // each way
    std::optional<double> least;
    for (const EntityIndex index : simulation_->entities()) {
        const MovingPoints* points = simulation_->points(index);
        if (!points || ignored_->contains(index)) continue;
        const Bounds its = points->bounds();
        if (its.is_empty() || its.lower.y > from.upper.y || its.lower.x > from.upper.x || its.upper.x < from.lower.x ||
            its.lower.z > from.upper.z || its.upper.z < from.lower.z)
            continue;
        for (int i = 0; i < rays * rays; ++i) {
            const double x = (i % rays + 0.5) / rays, z = (i / rays + 0.5) / rays;
            const Vec3 start{from.lower.x + x * from.size().x, from.upper.y, from.lower.z + z * from.size().z};
            const auto hit = points->cast_ray(start, {0, -1, 0}, max_ray_length);
            if (!hit) continue;
            const double drop = std::max(0.0, hit->distance - from.size().y);
            if (!least || drop < *least) least = drop;
        }
    }
    return least;
}

std::optional<double> PlacementProbe::fall(const Transform& pose) const {
    const std::optional<double> on_bodies = travel(pose, {0, -1, 0}, max_ray_length);
    const std::optional<double> on_points = fall_on_points(bounds(pose));
    if (!on_bodies || !on_points) return on_bodies ? on_bodies : on_points;
    return std::min(*on_bodies, *on_points);
}

}  // namespace embody::scene
