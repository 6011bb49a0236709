// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <set>

#include "scene/session/session_state.h"

namespace embody::scene {

/// The shape of a thing that is tried at poses in the present world without being in it.
class PlacementProbe {
public:
    /// `ignored` are not there for it; it outlives the probe.
    static Result<PlacementProbe> make(const SessionState& state, const Entity& entity,
                                       const std::set<EntityIndex>& ignored);

    /// World bounds of its shape; empty, or not finite, where there is none.
    [[nodiscard]] Bounds bounds(const Transform& pose) const;
    [[nodiscard]] bool has_bounds(const Transform& pose) const;
    /// How far it can go along the unit `direction` until it touches something; none if it meets nothing.
    [[nodiscard]] std::optional<double> travel(const Transform& pose, Vec3 direction, double most) const;
    /// The same downwards, where what is soft or liquid holds it, too.
    [[nodiscard]] std::optional<double> fall(const Transform& pose) const;
    [[nodiscard]] bool overlaps(const Transform& pose) const;
    /// The first hit of a ray; `direction` is unit.
    [[nodiscard]] std::optional<Simulation::RayHit> cast_ray(Vec3 origin, Vec3 direction, double most) const;
    [[nodiscard]] bool is_movable(EntityIndex entity) const { return simulation_->is_movable(entity); }

private:
    PlacementProbe(const Simulation& simulation, physics::ShapeHandle shape, const std::set<EntityIndex>& ignored)
        : simulation_(&simulation), shape_(shape), ignored_(&ignored) {}
    [[nodiscard]] physics::World::IgnoresBody filter() const;
    [[nodiscard]] std::optional<double> fall_on_points(const Bounds& from) const;

    const Simulation* simulation_;
    physics::ShapeHandle shape_;
    const std::set<EntityIndex>* ignored_;
};

}  // namespace embody::scene
