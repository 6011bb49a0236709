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

Bounds World::bounds(ShapeHandle shape, const Transform& pose) const {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    return record ? record->shape->bounds(pose) : Bounds{};
}

std::optional<double> World::drop_distance(BodyHandle body, double max_distance, const IgnoresBody& ignores) const {
    if (!contains(body) || !state_->rigid.record(body.index).shape) return std::nullopt;
    const auto skips = [&](BodyHandle other) { return other == body || (ignores && ignores(other)); };
    const ShapeCast cast{state_->rigid.record(body.index).shape, state_->rigid.pose(body.index), {0, -1, 0}};
    return physics::cast_shape(*state_, cast, max_distance, skips);
}

std::optional<double> World::cast_shape(ShapeHandle shape, const Transform& pose, Vec3 direction, double max_distance,
                                        const IgnoresBody& ignores) const {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    if (!record) return std::nullopt;
    return physics::cast_shape(*state_, {record->shape.get(), pose, direction}, max_distance, ignores);
}

bool World::overlaps(ShapeHandle shape, const Transform& pose, const IgnoresBody& ignores) const {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    return record && physics::overlaps(*state_, *record->shape, pose, ignores);
}

}  // namespace embody::physics
