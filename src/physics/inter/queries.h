// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "physics/state/world_state.h"

namespace embody::physics {

/// The nearest body that the ray meets; see World::cast_ray().
std::optional<RayHit> cast_ray(const state::WorldState& world, Vec3 origin, Vec3 direction, double max_distance,
                               BodyHandle ignore);

/// Bodies whose shapes overlap the box; see World::overlap_box().
std::vector<BodyHandle> overlap_box(const state::WorldState& world, const Bounds& box);

using IgnoresBody = std::function<bool(BodyHandle)>;

/// A shape that moves on a straight line without turning; `direction` is unit.
struct ShapeCast {
    const collision::CollisionShape* shape = nullptr;
    Transform pose;
    Vec3 direction;
};

/// The distance that the shape can move until it touches a body; see World::cast_shape().
std::optional<double> cast_shape(const state::WorldState& world, const ShapeCast& cast, double max_distance,
                                 const IgnoresBody& ignores);

/// Whether the shape overlaps a body; see World::overlaps().
bool overlaps(const state::WorldState& world, const collision::CollisionShape& shape, const Transform& pose,
              const IgnoresBody& ignores);

}  // namespace embody::physics
