// SPDX-License-Identifier: MIT

#include "physics/inter/queries.h"
#include "physics/inter/world.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

std::optional<RayHit> World::cast_ray(Vec3 origin, Vec3 direction, double max_distance, BodyHandle ignore) const {
    return physics::cast_ray(*state_, origin, direction, max_distance, ignore);
}

std::vector<BodyHandle> World::overlap_box(const Bounds& box) const { return physics::overlap_box(*state_, box); }

Bounds World::bounds(BodyHandle body) const {
    if (!contains(body) || !state_->rigid.record(body.index).shape) return {};
    return state_->rigid.record(body.index).shape->bounds(state_->rigid.pose(body.index));
}

std::optional<double> World::drop_distance(BodyHandle body, double max_distance,
                                           const std::function<bool(BodyHandle)>& ignores) const {
    if (!contains(body)) return std::nullopt;
    return physics::drop_distance(*state_, body.index, max_distance, ignores);
}

}  // namespace embody::physics
