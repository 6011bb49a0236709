// SPDX-License-Identifier: MIT
#include "foundation/task_pool.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// Whether the body is as it was when the last step began (docs/physics/direct-solver.md: at rest).
bool stands(const PairsAccess& world, std::uint32_t body) {
    const BodyState& state = world.rigid.motion[body];
    return state.linear_velocity == Vec3{} && state.angular_velocity == Vec3{} && state.center == state.start_center &&
           state.rotation == state.start_rotation && state.inverse_mass > 0 &&
           world.rigid.constants[body].acceleration == world.contacts.touch.bodies[body].acceleration &&
           world.rigid.constants[body].torque == Vec3{};
}

// All places of the body while it turns in this step by the angle θ: a surface point leaves its first place by at most
// r θ, and stays in the ball around the centre of mass.
Bounds turned_bounds(const PairsAccess& world, std::uint32_t body, const Bounds& now, double angle) {
    const BodyState& state = world.rigid.motion[body];
    const double reach = world.rigid.record(body).reach;
    const Bounds near = enlarged(now, reach * angle), ball = enlarged({state.center, state.center}, reach);
    Bounds bounds = now;
    bounds.add(Bounds{max(near.lower, ball.lower), min(near.upper, ball.upper)});
    return bounds;
}

// The same with tighter bounds for θ < 1: a point leaves the straight line between its first and its last place by at
// most r θ²/8, and gyroscopic torque, which changes ω by less than ω² dt, puts its last place off by less than r θ²/3.
Bounds close_turned_bounds(const PairsAccess& world, std::uint32_t body, const Bounds& now, double angle) {
    const BodyState& state = world.rigid.motion[body];
    const BodyRecord& record = world.rigid.record(body);
    const Quat last = cayley(state.angular_velocity * world.settings.time_step) * state.rotation;
    Bounds bounds = record.shape->bounds({state.center - rotate(last, world.rigid.constants[body].local_center), last});
    bounds.add(now);
    return enlarged(bounds, record.reach * angle * angle / 2);
}

// Lists which of a range of the awake bodies have left their bounds, and the new bounds that they need.
void list_leaving(const PairsAccess& world, IndexRange range, std::vector<LeavingBody>& leaving) {
    const double dt = world.settings.time_step;
    // Two balls' contacts are looked for this far ahead, in radii; each has half of it. Else it would be chance, and
    // the frame's motion, how early they are found: bounds are kept until the bodies leave them. Test: MovingFrames.
    const double ball_margin = world.settings.solver.collision.ball_margin_fraction / 2;
    for (std::size_t i = range.first; i < range.last; ++i) {
        const std::uint32_t body = world.activity.awake[i];
        TouchBody& touch = world.contacts.touch.bodies[body];
        touch.stands = stands(world, body);
        if (touch.stands) continue;
        const BodyRecord& record = world.rigid.record(body);
        if (!record.shape) continue;
        const Vec3 motion =
            world.rigid.motion[body].linear_velocity * dt + world.rigid.constants[body].acceleration * (dt * dt / 2);

        // What the body may meet on its path must be a pair before it gets there.
        Bounds now = record.shape->bounds(world.rigid.pose(body));
        if (record.is_ball) now = enlarged(now, ball_margin * touch.size);
        const double angle = record.is_ball ? 0 : length(world.rigid.motion[body].angular_velocity) * dt;
        Bounds wanted = angle > 0 ? turned_bounds(world, body, now, angle) : now;
        if (world.contacts.broad_phase.holds(body, wanted, motion)) continue;
        if (angle > 0 && angle < 1) {
            wanted = close_turned_bounds(world, body, now, angle);
            if (world.contacts.broad_phase.holds(body, wanted, motion)) continue;
        }
        leaving.push_back({body, wanted, motion});
    }
}

}  // namespace

void find_pairs(const PairsAccess& world) {
    // Bounds of moving bodies, and their travel.
    world.contacts.leaving.resize(static_cast<std::size_t>(world.workers.workers()));
    for (std::vector<LeavingBody>& leaving : world.contacts.leaving) leaving.clear();
    parallel_for_awake(world, [&](int worker, IndexRange range) {
        list_leaving(world, range, world.contacts.leaving[static_cast<std::size_t>(worker)]);
    });

    // In the order of the bodies, whichever worker had them.
    for (const std::vector<LeavingBody>& leaving : world.contacts.leaving) {
        for (const LeavingBody& l : leaving) world.contacts.broad_phase.move(l.body, l.bounds, l.motion);
    }
    world.contacts.pairs = &world.contacts.broad_phase.update_pairs(world.workers);
    if (world.contacts.broad_phase.has_too_many_pairs()) {
        world.report.limits |= static_cast<std::uint32_t>(StepLimit::too_many_pairs);
    }
    world.report.pairs = static_cast<std::uint32_t>(world.contacts.pairs->size());
}

}  // namespace embody::physics::stages
