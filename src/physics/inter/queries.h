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

/// The distance that a body can move down; see World::drop_distance().
std::optional<double> drop_distance(const state::WorldState& world, std::uint32_t body, double max_distance,
                                    const std::function<bool(BodyHandle)>& ignores);

}  // namespace embody::physics
