// SPDX-License-Identifier: MIT
// What a take records of a simulation, and how a simulation goes on from what a take has.
#include "scene/simulation/moment.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scene/matter/soft_nodes.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

constexpr std::uint8_t asleep_state = 2;

Result<void> put_points(MovingPoints& points, const EntityMoment& was, double interval) {
    std::vector<Vec3> positions;
    was.points->read(positions);
    std::vector<Vec3> velocities(positions.size());
    if (was.point_steps && interval > 0 && was.point_steps->size() == 3 * positions.size()) {
        const double scale = 1 / (RecordedPoints::units_per_metre * interval);
        const std::vector<std::int32_t>& steps = *was.point_steps;
        for (std::size_t i = 0; i < velocities.size(); ++i)
            velocities[i] = scale * Vec3{static_cast<double>(steps[3 * i]), static_cast<double>(steps[3 * i + 1]),
                                         static_cast<double>(steps[3 * i + 2])};
    }
    return points.set_points(positions, velocities);
}

}  // namespace

void Simulation::visit(const std::function<void(const EntityMotion&)>& look) const {
    const physics::World& world = *state_->world;
    EntityMotion motion;
    for (const auto& [index, entity] : state_->live) {
        motion.entity = index;
        motion.pose = state_->pose_of(entity);
        motion.points = entity.points.get();
        motion.linear_velocity = motion.angular_velocity = {};
        if (entity.points) {
            motion.state = static_cast<std::uint8_t>(entity.points->state());
            if (motion.state != asleep_state) {
                motion.linear_velocity = entity.points->linear_velocity();
                motion.angular_velocity = entity.points->angular_velocity();
            }
        } else {
            motion.state = std::isfinite(world.mass(entity.body))
                               ? static_cast<std::uint8_t>(world.sleep_state(entity.body))
                               : std::uint8_t{3};
            motion.linear_velocity = world.linear_velocity(entity.body);
            motion.angular_velocity = world.angular_velocity(entity.body);
        }
        look(motion);
    }
}

Result<void> Simulation::restore_moment(const Moment& moment, const ActionsDone& done) {
    State& state = *state_;
    std::map<EntityIndex, const EntityMoment*> were;
    for (const EntityMoment& was : moment.entities) were[was.motion.entity] = &was;

    // What is there.
    std::vector<EntityIndex> gone;
    for (const auto& [index, entity] : state.live)
        if (!were.contains(index) && done.removed.contains(index)) gone.push_back(index);
    state.remove_all(gone);
    for (const auto& [index, entity] : done.spawned) {
        state.next_spawned = std::max(state.next_spawned, index + 1);
        const auto was = were.find(index);
        if (was == were.end() || state.live.contains(index)) continue;
        Entity copy = entity;
        copy.pose = was->second->motion.pose;
        if (Result<void> added = state.add(copy); !added.ok()) return added;
    }

    // Where it is and how it moves: bodies together, then points.
    std::vector<physics::BodyHandle> bodies;
    for (const auto& [index, entity] : state.live)
        if (!entity.points && were.contains(index)) bodies.push_back(entity.body);
    Result<void> placed = state.world->change_bodies(bodies, [&](physics::BodyDefinition& body) {
        const EntityMotion& motion = were.at(static_cast<EntityIndex>(body.user_data))->motion;
        body.position = motion.pose.position;
        body.rotation = motion.pose.rotation;
        body.linear_velocity = motion.linear_velocity;
        body.angular_velocity = motion.angular_velocity;
        body.start_asleep = motion.state == asleep_state;
    });
    if (!placed.ok()) return placed;
    for (auto& [index, entity] : state.live) {
        const auto was = were.find(index);
        if (!entity.points || was == were.end()) continue;
        entity.frame = was->second->motion.pose;
        SoftNodes* soft = as_soft(entity.points.get());
        if (soft != nullptr && done.torn.contains(index)) {
            if (Result<void> torn = soft->tear(done.torn.at(index)); !torn.ok())
                return of_entity(entity.definition, torn.error());
        }
        // What was one body then, and is points now, goes there as a whole.
        Result<void> put = was->second->points ? put_points(*entity.points, *was->second, moment.interval)
                                               : state.place(entity, entity.frame);
        if (!put.ok()) return of_entity(entity.definition, put.error());
    }

    state.world->set_clock(moment.time, moment.step);
    state.actions->resume(moment.time, done.fired);
    return {};
}

}  // namespace embody::scene
