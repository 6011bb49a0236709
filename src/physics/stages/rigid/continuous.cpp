// SPDX-License-Identifier: MIT
// Bodies that move or turn by more than their thickness in a step, seen from what is near them, are swept over their
// whole path, and put back to where they first touch what they would pass through. Their velocities stay: the next step
// finds the touch and solves it as an impact, so momentum is kept whatever is hit. Slow worlds cost one comparison a
// body.
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

/// A body's path through the step, the fraction of it that the body may move, and by how much it then goes along with
/// what it met, m.
struct FastBody {
    std::uint32_t body = 0;
    double fraction = 1;
    Vec3 along;
};

/// A fast body and another one that it may pass through.
struct Passing {
    std::size_t first = 0;    ///< among the fast bodies
    std::uint32_t other = 0;  ///< body
    std::size_t second = 0;   ///< among the fast bodies; their number where the other is none
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

// Whether the step may have moved the body; of others nobody notes where they were at its start.
bool takes_part(const ContinuousAccess& world, std::uint32_t body) {
    return world.rigid.record(body).definition.kind != BodyKind::static_body && !world.activity.is_asleep(body);
}

// The displacement of a point fixed to the body that is at `start` when the step begins.
Vec3 carried(const ContinuousAccess& world, std::uint32_t body, Vec3 start) {
    if (!takes_part(world, body)) return {};
    const BodyState& state = world.rigid.motion[body];
    const Vec3 arm = start - state.start_center;
    if (world.rigid.record(body).is_ball) return state.center - state.start_center;  // its turn sweeps nothing
    return state.center + rotate(state.rotation * conjugate(state.start_rotation), arm) - start;
}

// The displacement of a body seen from another one, which may turn: what lies on a lorry or in a drum stays where it
// is.
Vec3 displacement_from(const ContinuousAccess& world, std::uint32_t body, std::uint32_t other) {
    const BodyState& state = world.rigid.motion[body];
    return state.center - state.start_center - carried(world, other, state.start_center);
}

// Bodies that move side by side do not pass through each other.
bool may_pass(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const BodyRecord &ra = world.rigid.record(a), &rb = world.rigid.record(b);
    if (turns_fast(world, ra, world.rigid.motion[a])) return true;
    if (world.rigid.is_dynamic(b) && turns_fast(world, rb, world.rigid.motion[b])) return true;
    double thickness = thickness_of(world, ra);
    if (world.rigid.is_dynamic(b)) thickness = std::min(thickness, thickness_of(world, rb));
    return length_squared(displacement_from(world, a, b)) > thickness * thickness;
}

bool may_meet(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const BodyDefinition &da = world.rigid.record(a).definition, &db = world.rigid.record(b).definition;
    if (!db.enabled || !(da.collision_group & db.collision_mask) || !(db.collision_group & da.collision_mask))
        return false;
    return !world.joints.jointed_pairs.contains({std::min(a, b), std::max(a, b)});
}

Sweep sweep_of(const ContinuousAccess& world, std::uint32_t body) {
    if (!takes_part(world, body)) return {world.rigid.pose(body), world.rigid.pose(body), {}};
    BodyState start = world.rigid.motion[body];
    start.center = start.start_center;
    if (!world.rigid.record(body).is_ball) start.rotation = start.start_rotation;  // a ball's turn sweeps nothing
    const Vec3 center = world.rigid.constants[body].local_center;
    return {body_pose(start, center), world.rigid.pose(body), center};
}

// Bounds of all that the body turns through, as if its centre stayed where it was at the step's start: balls around it
// where it turns much.
Bounds turned_bounds(const ContinuousAccess& world, std::uint32_t body, const Sweep& sweep, Vec3 motion) {
    const BodyRecord& record = world.rigid.record(body);
    Bounds turned = record.shape->bounds(sweep.start);
    if (record.is_ball) return turned;
    const Bounds end = record.shape->bounds(sweep.end);
    turned.add(Bounds{end.lower - motion, end.upper - motion});
    const BodyState& state = world.rigid.motion[body];
    if (length(Vec3{state.turn.x, state.turn.y, state.turn.z}) < 0.05) return turned;
    const Vec3 reach{record.reach, record.reach, record.reach};
    turned.add(Bounds{state.start_center - reach, state.start_center + reach});
    return turned;
}

// The broad phase has the paths that were expected when the step began. Tells it of those that bodies took instead:
// what hit something, or was hit.
void follow_paths(const ContinuousAccess& world) {
    std::vector<std::vector<LeavingBody>>& leaving = world.contacts.leaving;
    leaving.resize(static_cast<std::size_t>(world.workers.workers()));
    for (std::vector<LeavingBody>& of_worker : leaving) of_worker.clear();
    parallel_for_awake(world, [&](int worker, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            const std::uint32_t body = world.activity.awake[i];
            const BodyRecord& record = world.rigid.record(body);
            if (!record.shape || !record.definition.enabled) continue;
            const BodyState& state = world.rigid.motion[body];
            const Vec3 motion = state.center - state.start_center;
            const Bounds bounds = turned_bounds(world, body, sweep_of(world, body), motion);
            if (world.contacts.broad_phase.holds(body, bounds, motion)) continue;
            leaving[static_cast<std::size_t>(worker)].push_back({body, bounds, motion});
        }
    });
    for (const std::vector<LeavingBody>& of_worker : leaving) {
        for (const LeavingBody& l : of_worker) world.contacts.broad_phase.move(l.body, l.bounds, l.motion);
    }
    world.contacts.pairs = &world.contacts.broad_phase.update_pairs(world.workers);
}

// Whether the balls around two bodies tell that they do not meet: they stay further apart than a touch on the whole
// path, or are the bodies themselves and touch from the start, which counts as no impact.
bool do_not_meet(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const BodyRecord &ra = world.rigid.record(a), &rb = world.rigid.record(b);
    if (ra.reach == 0 || rb.reach == 0) return false;  // planes and surfaces have no ball
    const auto start_of = [&](std::uint32_t body) {
        const BodyState& state = world.rigid.motion[body];
        return takes_part(world, body) ? state.start_center : state.center;
    };
    const double touch = ra.reach + rb.reach + world.settings.solver.collision.continuous_gap;
    const Vec3 apart = start_of(b) - start_of(a);
    if (ra.is_ball && rb.is_ball && length_squared(apart) <= touch * touch) return true;
    const Vec3 moved = world.rigid.motion[b].center - start_of(b) - (world.rigid.motion[a].center - start_of(a));
    const double squared = length_squared(moved);
    const double nearest = squared > 0 ? std::clamp(-dot(apart, moved) / squared, 0.0, 1.0) : 0;
    return length_squared(apart + nearest * moved) > touch * touch;
}

std::optional<double> meeting_time(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    if (do_not_meet(world, a, b)) return std::nullopt;
    // Maximum depth at which sliding or rolling along a body ends in it.
    const BodyRecord& record = world.rigid.record(a);
    const CollisionSettings& settings = world.settings.solver.collision;
    const double harmless = record.definition.continuous ? 0 : settings.continuous_slide_fraction * record.inner_radius;
    return time_of_impact(*record.shape, sweep_of(world, a), *world.rigid.record(b).shape, sweep_of(world, b),
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

// Puts a body back to where it met something, and lets it go along from there. The spin stays constant in the body's
// axes: with a constant spin in the world's axes, turning the inertia back would change the energy.
void put_back(const ContinuousAccess& world, const FastBody& fast) {
    const auto& [body, fraction, along] = fast;
    if (fraction >= 1) return;
    BodyState& state = world.rigid.motion[body];
    const Vec3 spin = rotate_inverse(state.rotation, state.angular_velocity);
    const Vec3 back = (state.start_center - state.center) * (1 - fraction) + along;
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

// The fast bodies and what they may pass through, in the order of the pairs.
std::vector<Passing> list_passings(const ContinuousAccess& world, const std::vector<FastBody>& fast) {
    const std::size_t none = fast.size();
    std::vector<std::size_t> place(world.rigid.motion.size(), none);
    for (std::size_t i = 0; i < fast.size(); ++i) place[fast[i].body] = i;
    std::vector<Passing> passings;
    for (const BroadPhase::Pair& pair : *world.contacts.pairs) {
        if (place[pair.a] == none && place[pair.b] == none) continue;
        const bool a_is_fast = place[pair.a] != none;
        const std::uint32_t body = a_is_fast ? pair.a : pair.b, other = a_is_fast ? pair.b : pair.a;
        if (may_pass(world, body, other) && may_meet(world, body, other))
            passings.push_back({place[body], other, place[other]});
    }
    return passings;
}

// When the bodies of each passing that `counts` meet, by its number.
template <class Counts>
std::vector<std::optional<double>> meeting_times(const ContinuousAccess& world, const std::vector<Passing>& passings,
                                                 const std::vector<FastBody>& fast, Counts counts) {
    constexpr std::size_t min_parallel_count = 32;  // passings; waking the workers costs as many
    std::vector<std::optional<double>> times(passings.size());
    parallel_for(world.workers, passings.size(), passings.size() >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t k = range.first; k < range.last; ++k) {
            if (counts(passings[k])) times[k] = meeting_time(world, fast[passings[k].first].body, passings[k].other);
        }
    });
    return times;
}

// For the rest of the step two that met go along with their common centre of mass, as if they stuck to each other: else
// what meets in a heap that flies would fall behind the heap.
Vec3 common_motion(const ContinuousAccess& world, std::uint32_t a, std::uint32_t b) {
    const auto moved = [&](std::uint32_t body) {
        return world.rigid.motion[body].center - world.rigid.motion[body].start_center;
    };
    const double mass_a = world.rigid.constants[a].mass, mass_b = world.rigid.constants[b].mass;
    return (moved(a) * mass_a + moved(b) * mass_b) / (mass_a + mass_b);
}

// Fast bodies that meet each other stop where they meet, the earliest first; a stopped body is met no more.
void stop_at_meetings(const ContinuousAccess& world, const std::vector<Passing>& passings,
                      std::vector<FastBody>& fast) {
    const auto times = meeting_times(world, passings, fast, [&](const Passing& p) { return p.second != fast.size(); });
    std::vector<Meeting> meetings;
    for (std::size_t k = 0; k < passings.size(); ++k) {
        if (const auto& time = times[k]) meetings.push_back({*time, passings[k].first, passings[k].second});
    }
    std::stable_sort(meetings.begin(), meetings.end(),
                     [](const Meeting& m, const Meeting& n) { return m.time < n.time; });
    for (const Meeting& meeting : meetings) {
        FastBody &first = fast[meeting.first], &second = fast[meeting.second];
        if (first.fraction < 1 || second.fraction < 1) continue;
        first.fraction = second.fraction = meeting.time;
        first.along = second.along = common_motion(world, first.body, second.body) * (1 - meeting.time);
    }
    for (const FastBody& each : fast) put_back(world, each);
}

// On the rest of its path each stops where it first touches something that is not fast itself, and goes along with it.
void stop_at_touches(const ContinuousAccess& world, const std::vector<Passing>& passings, std::vector<FastBody>& fast) {
    // A body that rolls along a surface has followed the surface; a straight line between its ends would cut into
    // edges.
    const auto times = meeting_times(world, passings, fast, [&](const Passing& p) {
        return p.second == fast.size() && !has_rolled_along(world, fast[p.first].body, p.other);
    });
    for (FastBody& each : fast) each.fraction = 1;
    for (std::size_t k = 0; k < passings.size(); ++k) {
        FastBody& each = fast[passings[k].first];
        const auto& time = times[k];
        if (!time || *time >= each.fraction) continue;
        each.fraction = *time;
        const Vec3 start = world.rigid.motion[each.body].start_center;
        each.along = carried(world, passings[k].other, start) * (1 - *time);
    }
    for (const FastBody& each : fast) put_back(world, each);
}

}  // namespace

void stop_tunnelling(const ContinuousAccess& world) {
    std::vector<FastBody> fast = list_fast(world);
    if (fast.empty()) return;
    follow_paths(world);
    const std::vector<Passing> passings = list_passings(world, fast);
    stop_at_meetings(world, passings, fast);
    stop_at_touches(world, passings, fast);
}

}  // namespace embody::physics::stages
