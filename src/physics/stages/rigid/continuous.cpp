// SPDX-License-Identifier: MIT
// Bodies that move or turn by more than their thickness in a step are swept over their whole path, and put back to
// where they first touch what they would pass through. Their velocities stay: the next step finds the touch and solves
// it as an impact, so momentum is kept whatever is hit. Nothing else of the world is read, so slow worlds cost one
// comparison a body.
#include <algorithm>
#include <cmath>
#include <optional>

#include "foundation/task_pool.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/stages/rigid/roll_balls.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/joint_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

/// A body's path through the step, and the fraction of it that the body may move.
struct FastBody {
    std::uint32_t body = 0;
    double fraction = 1;
};

/// Two fast bodies that meet on their paths.
struct Meeting {
    double time = 1;
    std::size_t first = 0, second = 0;  ///< among the fast bodies
};

// Maximum travel without passing through another body undetected, m.
double thickness_of(const ContinuousAccess& world, const BodyRecord& record) {
    const double fraction = world.settings.solver.collision.continuous_travel_fraction;
    return (record.definition.continuous ? fraction : 1.0) * record.inner_radius;
}

// Whether a body turns so far that points outside of its inner ball sweep its thickness; the contacts themselves follow
// bodies that turn less.
bool turns_fast(const ContinuousAccess& world, const BodyRecord& record, const BodyState& state) {
    const double half_sine = length(Vec3{state.turn.x, state.turn.y, state.turn.z});
    return half_sine > world.settings.solver.collision.continuous_half_turn &&
           2 * half_sine * (record.reach - record.inner_radius) > thickness_of(world, record);
}

bool may_tunnel(const ContinuousAccess& world, std::uint32_t body) {
    const BodyRecord& record = world.rigid.record(body);
    if (!record.shape || !record.definition.enabled || !world.rigid.is_dynamic(body)) return false;
    const BodyState& state = world.rigid.motion[body];
    const double thickness = thickness_of(world, record);
    return length_squared(state.center - state.start_center) > thickness * thickness ||
           turns_fast(world, record, state);
}

// Bodies that move side by side do not pass through each other.
bool may_pass(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const BodyRecord &ra = world.rigid.record(a), &rb = world.rigid.record(b);
    const BodyState &sa = world.rigid.motion[a], &sb = world.rigid.motion[b];
    const Vec3 displacement = (sa.center - sa.start_center) - (sb.center - sb.start_center);
    const double thickness = std::min(thickness_of(world, ra), thickness_of(world, rb));
    return length_squared(displacement) > thickness * thickness || turns_fast(world, ra, sa) ||
           turns_fast(world, rb, sb);
}

bool may_meet(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const BodyDefinition &da = world.rigid.record(a).definition, &db = world.rigid.record(b).definition;
    if (!db.enabled || !(da.collision_group & db.collision_mask) || !(db.collision_group & da.collision_mask))
        return false;
    return !world.joints.jointed_pairs.contains({std::min(a, b), std::max(a, b)});
}

Sweep sweep_of(const ContinuousAccess& world, std::uint32_t body) {
    BodyState start = world.rigid.motion[body];
    start.center = start.start_center;
    start.rotation = start.start_rotation;
    const Vec3 center = world.rigid.constants[body].local_center;
    return {body_pose(start, center), world.rigid.pose(body), center};
}

// Bounds of all places of the body on its path: balls around its centre where it turns much.
Bounds swept_bounds(const ContinuousAccess& world, std::uint32_t body, const Sweep& sweep) {
    const BodyRecord& record = world.rigid.record(body);
    Bounds swept = record.shape->bounds(sweep.start);
    swept.add(record.shape->bounds(sweep.end));
    const BodyState& state = world.rigid.motion[body];
    if (length(Vec3{state.turn.x, state.turn.y, state.turn.z}) < 0.05) return swept;
    const Vec3 reach{record.reach, record.reach, record.reach};
    swept.add(Bounds{state.start_center - reach, state.start_center + reach});
    swept.add(Bounds{state.center - reach, state.center + reach});
    return swept;
}

std::optional<double> meeting_time(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b, const Sweep& path_a,
                                   const Sweep& path_b) {
    // Maximum depth at which sliding or rolling along a body ends in it.
    const BodyRecord& record = world.rigid.record(a);
    const CollisionSettings& settings = world.settings.solver.collision;
    const double harmless = record.definition.continuous ? 0 : settings.continuous_slide_fraction * record.inner_radius;
    return time_of_impact(*record.shape, path_a, *world.rigid.record(b).shape, path_b,
                          {settings.continuous_gap / 2, settings.continuous_gap, harmless});
}

// The velocity with which a body that has `velocity` under the constant `acceleration` had at the place `back` from
// here: the work of the forces since then is taken back, ½ |v|² − a·x stays. Else each stop of a falling body would add
// potential energy.
Vec3 velocity_before(Vec3 velocity, Vec3 acceleration, Vec3 back) {
    // ½ |v − a t|² = ½ |v|² + a·back, the smaller t; where there is none, the slowest v − a t.
    const double squared = length_squared(acceleration), along = dot(velocity, acceleration);
    if (squared == 0) return velocity;
    const double root = std::sqrt(std::max(0.0, along * along + 2 * squared * dot(acceleration, back)));
    return velocity - acceleration * ((along < 0 ? along + root : along - root) / squared);
}

// Puts a body back to a fraction of its path. The spin stays constant in the body's axes: with a constant spin in the
// world's axes, turning the inertia back would change the energy.
void put_back(const ContinuousAccess& world, std::uint32_t body, double fraction) {
    if (fraction >= 1) return;
    BodyState& state = world.rigid.motion[body];
    const Vec3 spin = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 back = (state.start_center - state.center) * (1 - fraction);
    state.linear_velocity = velocity_before(state.linear_velocity, world.rigid.constants[body].acceleration, back);
    state.center += back;
    const Quat end = dot(state.rotation, state.start_rotation) < 0
                         ? Quat{-state.rotation.x, -state.rotation.y, -state.rotation.z, -state.rotation.w}
                         : state.rotation;
    const Quat& begin = state.start_rotation;
    state.rotation = normalized(Quat{begin.x + fraction * (end.x - begin.x), begin.y + fraction * (end.y - begin.y),
                                     begin.z + fraction * (end.z - begin.z), begin.w + fraction * (end.w - begin.w)});
    state.angular_velocity = rotate(state.rotation, spin);
    refresh_inertia(state, world.rigid.constants[body]);
}

// Calls visit(other, its place among the fast ones or their number) for each body that a body may meet on its path.
template <class Visit>
void for_each_met(const ContinuousAccess& world, std::uint32_t body, const Sweep& sweep,
                  const std::vector<FastBody>& fast, Visit&& visit) {
    world.contacts.broad_phase.query(swept_bounds(world, body, sweep), [&](std::uint32_t other) {
        if (other == body || !may_meet(world, body, other)) return;
        const auto found =
            std::lower_bound(fast.begin(), fast.end(), other,
                             [](const FastBody& each, std::uint32_t index) { return each.body < index; });
        const bool is_fast = found != fast.end() && found->body == other;
        visit(other, is_fast ? static_cast<std::size_t>(found - fast.begin()) : fast.size());
    });
}

// Bodies that may tunnel, in the order of the bodies.
std::vector<FastBody> list_fast(const ContinuousAccess& world) {
    thread_local std::vector<std::vector<FastBody>> kept;
    std::vector<std::vector<FastBody>>& found = kept;  // of this thread, for all workers
    found.resize(static_cast<std::size_t>(world.workers.workers()));
    for (std::vector<FastBody>& of_worker : found) of_worker.clear();
    parallel_for_awake(world, [&](int worker, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            const std::uint32_t body = world.activity.awake[i];
            if (may_tunnel(world, body)) found[static_cast<std::size_t>(worker)].push_back({body});
        }
    });
    std::vector<FastBody> fast = std::move(found[0]);
    for (std::size_t worker = 1; worker < found.size(); ++worker) {
        fast.insert(fast.end(), found[worker].begin(), found[worker].end());
    }
    return fast;
}

// Fast bodies that meet each other stop where they meet, the earliest first; a stopped body is met no more.
void stop_at_meetings(const ContinuousAccess& world, std::vector<FastBody>& fast) {
    std::vector<Meeting> meetings;
    for (std::size_t i = 0; i < fast.size(); ++i) {
        const std::uint32_t body = fast[i].body;
        const Sweep sweep = sweep_of(world, body);
        for_each_met(world, body, sweep, fast, [&](std::uint32_t other, std::size_t place) {
            if (place <= i || place == fast.size() || !may_pass(world, body, other)) return;
            const auto time = meeting_time(world, body, other, sweep, sweep_of(world, other));
            if (time) meetings.push_back({*time, i, place});
        });
    }
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const Meeting& m, const Meeting& n) { return m.time < n.time; });
    for (const Meeting& meeting : meetings) {
        FastBody &first = fast[meeting.first], &second = fast[meeting.second];
        if (first.fraction < 1 || second.fraction < 1) continue;
        first.fraction = second.fraction = meeting.time;
    }
    for (const FastBody& each : fast) put_back(world, each.body, each.fraction);
}

// The fraction of the rest of its path after which a body first touches something that is not fast itself.
double first_touch(const ContinuousAccess& world, std::uint32_t body, const std::vector<FastBody>& fast) {
    const Sweep sweep = sweep_of(world, body);
    double first = 1;
    for_each_met(world, body, sweep, fast, [&](std::uint32_t other, std::size_t place) {
        // A body that rolls along a surface has followed the surface; a straight line between its ends would cut into
        // edges.
        if (place < fast.size() || has_rolled_along(world, body, other)) return;
        const Transform pose = world.rigid.pose(other);
        if (const auto time = meeting_time(world, body, other, sweep, {pose, pose, {}})) first = std::min(first, *time);
    });
    return first;
}

}  // namespace

void stop_tunnelling(const ContinuousAccess& world) {
    std::vector<FastBody> fast = list_fast(world);
    if (fast.empty()) return;
    stop_at_meetings(world, fast);
    for (const FastBody& each : fast) put_back(world, each.body, first_touch(world, each.body, fast));
}

}  // namespace embody::physics::stages
