// SPDX-License-Identifier: MIT
#include "physics/stages/impact/impact_paths.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/parallel_for_awake.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

ImpactPaths::ImpactPaths(const ImpactAccess& world, const BodyPaths& bodies)
    : world_(world),
      bodies_(bodies),
      memory_(world.impacts),
      step_(world.settings.time_step),
      substep_(step_ / world.settings.substeps),
      settings_(world.settings.solver.constraint.impact),
      max_pile_bounces_(settings_.budget.pile_bounces +
                        world.activity.awake.size() / settings_.budget.bodies_per_pile_bounce) {
    memory_.pile_bounces = 0;
    const std::size_t count = world.rigid.motion.size();
    memory_.last_time.assign(count, 0);
    memory_.remaining_restitution.assign(count, 1);

    // Maximum by which the end of a free path can be faster than its start.
    memory_.speed_gain.assign(count, 0);
    for_each_awake(world, [&](std::uint32_t body) {
        const double turning =
            length_squared(world.rigid.motion[body].angular_velocity) * world.rigid.record(body).reach;
        memory_.speed_gain[body] = static_cast<float>(step_ * (length(bodies.free_acceleration(body)) + turning));
    });
}

double ImpactPaths::earliest_time(const Contact& contact) const {
    return std::max(memory_.last_time[contact.a], memory_.last_time[contact.b]);
}

Material ImpactPaths::material_of(const Contact& contact) const {
    return combine(world_.rigid.record(contact.a).definition.material,
                   world_.rigid.record(contact.b).definition.material, world_.rigid.surface_pairs);
}

bool ImpactPaths::bounces(const Contact& contact) const {
    if (memory_.pile_bounces >= max_pile_bounces_ && hits_pile(contact)) return false;
    const double min_remaining_restitution = settings_.budget.min_remaining_restitution;
    return contact.bounces && memory_.remaining_restitution[contact.a] > min_remaining_restitution &&
           memory_.remaining_restitution[contact.b] > min_remaining_restitution;
}

void ImpactPaths::note_bounce(const Contact& contact) {
    if (hits_pile(contact) && ++memory_.pile_bounces == max_pile_bounces_) {
        world_.report.limits |= static_cast<std::uint32_t>(StepLimit::impact_iterations_exhausted);
    }
    const double restitution = material_of(contact).restitution;
    for (const std::uint32_t body : {contact.a, contact.b}) {
        if (world_.rigid.motion[body].inverse_mass > 0) memory_.remaining_restitution[body] *= restitution;
    }
}

bool ImpactPaths::hits_pile(const Contact& contact) const {
    const auto is_carried = [&](std::uint32_t body) {
        return memory_.is_supported[body] && world_.rigid.motion[body].inverse_mass > 0;
    };
    return is_carried(contact.a) || is_carried(contact.b);
}

// Classification (paper, eq. 4): slower contacts rest. Loaded contacts and contacts that do not bounce must be far
// faster to count as a collision: the contact solver stops them as well as an impact would. If they also touch already,
// there is no impact to come. Nor is there between balls of a pile that do not bounce: their contact turns with their
// centres, so that the substeps stop them where they meet, and nobody is put back along its path into its neighbours.
double ImpactPaths::slowest_speed(const Contact& contact) const {
    const bool can_bounce = bounces(contact);
    if (contact.was_touching && !can_bounce) return never;
    if (contact.are_balls && !can_bounce && hits_pile(contact)) return never;
    const double acceleration = dot(contact.normal, world_.settings.gravity);
    const double slowest =
        std::max(settings_.min_impact_speed, settings_.min_impact_substeps * std::fabs(acceleration) * substep_);
    return contact.was_loaded || !can_bounce ? settings_.loaded_speed_ratio * slowest : slowest;
}

bool ImpactPaths::is_surely_slow(const ContactSummary& summary) const {
    if (summary.was_touching && !summary.bounces) return true;
    const double ratio = summary.was_loaded || !summary.bounces ? settings_.loaded_speed_ratio : 1;
    const double slowest = ratio * settings_.min_impact_speed;
    return summary.approach_speed + memory_.speed_gain[summary.a] + memory_.speed_gain[summary.b] < slowest;
}

// Prediction needs no more of a path than half a millimetre; a body that turns slowly turns evenly to that accuracy.
ImpactPaths::Motion ImpactPaths::motion_at(std::uint32_t body, double time) const {
    const auto with_tilt = [](const BodyPaths::Motion& motion) {
        const Quat& turn = motion.turn;
        return Motion{motion, (turn.w < 0 ? -2 : 2) * Vec3{turn.x, turn.y, turn.z}};
    };
    const BodyState& now = world_.rigid.motion[body];
    BodyPaths::Motion motion{now.center - now.start_center, now.linear_velocity, now.angular_velocity, now.turn};
    if (time <= 0) return with_tilt(motion);
    if (turns_far(body)) return with_tilt(bodies_.motion_about(body, time));
    const Vec3 acceleration = bodies_.free_acceleration(body);
    motion.shift += (now.linear_velocity + acceleration * (time / 2)) * time;
    motion.velocity += acceleration * time;
    if (now.angular_velocity != Vec3{}) motion.turn = cayley(now.angular_velocity * time) * now.turn;
    return with_tilt(motion);
}

bool ImpactPaths::turns_far(std::uint32_t body) const {
    const TouchBody& touch = world_.contacts.touch.bodies[body];
    const Vec3 turn = world_.rigid.motion[body].angular_velocity * step_;
    return !touch.is_ball && length_squared(turn) * touch.size / 2 > settings_.patch_gap;
}

namespace {

// Displacement and velocity of the surface point at `arm`.
template <class Motion>
void move_point(const Motion& motion, Vec3 arm, bool is_round, Vec3& displacement, Vec3& velocity) {
    const Vec3 turned = is_round ? arm : rotate(motion.turn, arm);
    displacement = motion.shift + (is_round ? cross(motion.tilt, arm) : turned - arm);
    velocity = motion.velocity + cross(motion.spin, turned);
}

template <class Motion>
ImpactPaths::Gap gap_between(const Contact& contact, const ContactPoint& point, const Motion& a, const Motion& b) {
    Vec3 displacement_a, displacement_b, velocity_a, velocity_b;
    move_point(a, point.arm_a, contact.a_is_round, displacement_a, velocity_a);
    move_point(b, point.arm_b, contact.b_is_round, displacement_b, velocity_b);
    return {point.separation + dot(contact.normal, displacement_b - displacement_a),
            dot(contact.normal, velocity_b - velocity_a)};
}

// Whether the point closes as fast as an impact now and is still apart at the end of the step: the next step's impact.
void mark_open(ContactPoint& point, bool stays_open, double step) {
    const auto to_the_end = static_cast<float>(step);
    if (stays_open) {
        point.inactive_until = to_the_end;
    } else if (point.inactive_until >= to_the_end) {
        point.inactive_until = 0;
    }
}

}  // namespace

ImpactPaths::Gap ImpactPaths::gap_at(const Contact& contact, const ContactPoint& point, double time) const {
    return gap_between(contact, point, motion_at(contact.a, time), motion_at(contact.b, time));
}

ImpactPaths::Gaps ImpactPaths::gaps_at(const Contact& contact, double time) const {
    const Motion a = motion_at(contact.a, time), b = motion_at(contact.b, time);
    Gaps gaps;
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
        gaps[i] = gap_between(contact, contact.points[i], a, b);
    }
    return gaps;
}

// The first time from `start` on at which a point touches whose gap is `first` then and `last` at the end of the step;
// `never` if it does not.
double ImpactPaths::touch_time(const Contact& contact, const ContactPoint& point, double start, Gap first,
                               Gap last) const {
    if (first.size <= settings_.touch_gap) return start;
    if (last.size > 0) {
        // Open at both ends; a parabola that opens upwards may dip through in between.
        const double acceleration = step_ > start ? (last.rate - first.rate) / (step_ - start) : 0;
        const double discriminant = first.rate * first.rate - 2 * acceleration * first.size;
        if (first.rate >= 0 || discriminant < 0) return never;
        const double time = start + 2 * first.size / (-first.rate + std::sqrt(discriminant));
        return time <= step_ ? time : never;
    }

    // Closed at the end: the root between, by the regula falsi (Illinois).
    double low = start, high = step_, at_low = first.size, at_high = last.size;
    double time = high;
    for (int i = 0; i < settings_.root_iterations; ++i) {
        time = low + (high - low) * at_low / (at_low - at_high);
        const double gap = gap_at(contact, point, time).size;
        if (std::fabs(gap) < settings_.touch_gap) break;
        (gap > 0 ? low : high) = time;
        (gap > 0 ? at_low : at_high) = gap;
        (gap > 0 ? at_high : at_low) /= 2;
    }
    return time;
}

ImpactPaths::Prediction ImpactPaths::predict_straight(Contact& contact) {
    const double slowest = slowest_speed(contact);
    if (slowest == never) return {};

    const Motion a = motion_at(contact.a, 0), b = motion_at(contact.b, 0);
    const Deviation deviation = deviation_of(contact, a, b);
    const double start = earliest_time(contact);
    Prediction first{.is_open = true};
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const Gap now = gap_between(contact, point, a, b);
        const double end = now.size + now.rate * step_;
        const bool may_meet = now.size <= settings_.touch_gap || std::min(now.size, end) < deviation.distance;
        if (may_meet && now.rate - deviation.speed < -slowest) first.is_certain = false;
        const bool parts = start > 0 && now.rate > deviation.speed && end > deviation.distance;
        if (may_meet && !parts) first.is_open = false;
        mark_open(point, now.rate < -slowest && now.size > 0 && end > 0, step_);
        if (now.rate < -slowest && end <= 0) first.time = std::min(first.time, std::max(start, now.size / -now.rate));
    }
    const bool is_enough = hits_pile(contact) && !bounces(contact);
    if (first.is_certain && !is_enough) first.time = never;
    first.is_certain = first.is_certain || is_enough;
    return first;
}

ImpactPaths::Deviation ImpactPaths::deviation_of(const Contact& contact, const Motion& a, const Motion& b) const {
    double arm_a = 0, arm_b = 0;
    for (int i = 0; i < contact.count; ++i) {
        const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        arm_a = std::max<double>(arm_a, length_squared(point.arm_a));
        arm_b = std::max<double>(arm_b, length_squared(point.arm_b));
    }
    const double acceleration = length_squared(a.spin) * std::sqrt(arm_a) + length_squared(b.spin) * std::sqrt(arm_b) +
                                length(bodies_.free_acceleration(contact.a) - bodies_.free_acceleration(contact.b));
    return {acceleration * step_ * step_ / 2, acceleration * step_};
}

ImpactPaths::Prediction ImpactPaths::predict_exactly(Contact& contact) {
    struct Motions {
        Motion a, b;
    };
    const double slowest = slowest_speed(contact);
    const auto at = [&](double time) { return Motions{motion_at(contact.a, time), motion_at(contact.b, time)}; };
    const double start = earliest_time(contact);
    const Motions now = at(0), end = at(step_), begin = start > 0 ? at(start) : now;
    Motions at_first;
    double first = never, nearest = never;
    for (int i = 0; i < contact.count; ++i) {
        ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
        const auto gap = [&](const Motions& m) { return gap_between(contact, point, m.a, m.b); };
        const Gap gap_now = gap(now), gap_end = gap(end);
        mark_open(point, gap_now.rate < -slowest && gap_now.size > 0 && gap_end.size > 0, step_);
        nearest = std::min(nearest, std::min(gap_now.size, gap_end.size));

        // Whatever is still apart when an earlier point touches comes later.
        if (first < never && gap(at_first).size > settings_.touch_gap) continue;
        const double time = touch_time(contact, point, start, start > 0 ? gap(begin) : gap_now, gap_end);
        if (time >= first) continue;
        const Motions then = at(time);
        if (gap(then).rate >= -slowest) continue;
        first = time;
        at_first = then;
    }
    if (first < never) return {.time = first};
    const double farthest_turn = settings_.max_followed_turn / step_;
    const auto is_fast = [&](std::uint32_t body, const Motion& m) {
        return !world_.contacts.touch.bodies[body].is_ball && length_squared(m.spin) > farthest_turn * farthest_turn;
    };
    const bool is_clear = start == 0 && nearest > deviation_of(contact, now.a, now.b).distance;
    return {.is_open = is_clear || keeps_apart(contact, start),
            .may_hide = is_fast(contact.a, now.a) || is_fast(contact.b, now.b)};
}

// Whether the surfaces separate at `start` or are apart then, and stay so: checked at the ends of the substeps.
bool ImpactPaths::keeps_apart(const Contact& contact, double start) const {
    for (int k = 0; k <= world_.settings.substeps; ++k) {
        const double time = k == 0 ? start : k * substep_;
        if (k > 0 && time <= start) continue;
        const Gaps gaps = gaps_at(contact, time);
        for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
            const bool parts = k == 0 && gaps[i].rate > settings_.min_impact_speed;
            if (gaps[i].size <= settings_.touch_gap && !parts) return false;
        }
    }
    return true;
}

void ImpactPaths::leave_open(Contact& contact) {
    const double slowest = slowest_speed(contact);
    if (slowest == never) return;
    const Gaps now = gaps_at(contact, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(contact.count); ++i) {
        mark_open(contact.points[i], now[i].rate < -slowest && now[i].size > 0, step_);
    }
}

}  // namespace embody::physics::stages
