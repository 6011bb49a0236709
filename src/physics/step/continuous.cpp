// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/dynamic/equations_of_motion.h"
#include "physics/step/step.h"

namespace embody::physics {

namespace {

// A body that moves less than its thickness cannot have passed through another one unseen.
bool may_tunnel(const WorldState& world, std::uint32_t body) {
    const BodyRecord& record = world.record(body);
    if (!record.shape || !record.definition.enabled || !world.is_dynamic(body)) return false;
    const double moved = distance(world.motion[body].center, world.motion[body].start_center);
    return moved > (record.definition.continuous ? 0.25 : 1.0) * record.inner_radius;
}

bool collides(const BodyDefinition& a, const BodyDefinition& b) {
    return b.enabled && (a.collision_group & b.collision_mask) && (b.collision_group & a.collision_mask);
}

// The share of the step's motion after which the body first touches something, 1 if it is free.
double first_touch(const WorldState& world, std::uint32_t body) {
    const BodyRecord& record = world.record(body);
    const BodyState& state = world.motion[body];
    BodyState start = state;
    start.center = state.start_center;
    start.rotation = state.start_rotation;
    const Transform from = body_pose(start, world.constants[body].local_center), to = world.pose(body);
    Bounds swept = record.shape->bounds(from);
    swept.add(record.shape->bounds(to));

    // What the body touched at the start is the contact solver's; only what it meets on the way counts.
    constexpr double gap = 1e-3;
    double first = 1;
    world.broad_phase.query(swept, [&](std::uint32_t other) {
        if (other == body || !collides(record.definition, world.record(other).definition)) return;
        const bool jointed = world.jointed_pairs.contains({std::min(body, other), std::max(body, other)});
        const bool other_is_fast = world.is_dynamic(other) && !record.definition.continuous;
        if (jointed || other_is_fast) return;
        const CollisionShape& shape = *world.record(other).shape;
        if (separation(*record.shape, from, shape, world.pose(other), 2 * gap) <= gap) return;
        const auto time = time_of_impact(*record.shape, from, to, shape, world.pose(other), gap / 2);
        if (time) first = std::min(first, *time);
    });
    return first;
}

}  // namespace

void stop_tunnelling(WorldState& world) {
    for (const std::uint32_t body : world.awake) {
        if (!may_tunnel(world, body)) continue;
        const double share = first_touch(world, body);
        if (share >= 1) continue;

        // Put back to the touch; the velocity stays, so that the next step's impact stage sees the collision. It stays
        // as the body's axes see it: in the world's, the inertia that turns back would take or give energy.
        BodyState& state = world.motion[body];
        const Vec3 spin = rotate_inverse(state.rotation, state.angular_velocity);
        state.center = state.start_center + (state.center - state.start_center) * share;
        const Quat end = dot(state.rotation, state.start_rotation) < 0
                             ? Quat{-state.rotation.x, -state.rotation.y, -state.rotation.z, -state.rotation.w}
                             : state.rotation;
        const Quat& begin = state.start_rotation;
        state.rotation = normalized(Quat{begin.x + share * (end.x - begin.x), begin.y + share * (end.y - begin.y),
                                         begin.z + share * (end.z - begin.z), begin.w + share * (end.w - begin.w)});
        state.angular_velocity = rotate(state.rotation, spin);
        refresh_inertia(state, world.constants[body]);
    }
}

}  // namespace embody::physics
