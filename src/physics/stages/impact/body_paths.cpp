// SPDX-License-Identifier: MIT
#include "physics/stages/impact/body_paths.h"

#include <algorithm>
#include <cmath>

#include "foundation/task_pool.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/state/contact_state.h"
#include "physics/state/impact_memory.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

constexpr std::uint32_t not_remembered = 0xFFFFFFFFu;  // no path

// Turns by `omega` in whole substeps and the rest of one, either way: as drift() does. All these Cayley turns have one
// axis, so they are one quaternion (vector · ω h/2, scalar): each multiplies it by (ω h/2, 1).
Quat turn_evenly(Quat rotation, Vec3 omega, double time, double substep) {
    const Vec3 half = omega * (time < 0 ? -substep / 2 : substep / 2);
    const double square = length_squared(half);
    double scalar = 1, vector = 0;
    for (double left = std::fabs(time) / substep; left > 0; left -= 1) {
        const double portion = std::min(left, 1.0), last = scalar;
        scalar -= square * portion * vector;
        vector += portion * last;
    }
    return normalized(Quat{half.x * vector, half.y * vector, half.z * vector, scalar} * rotation);
}

}  // namespace

BodyPaths::BodyPaths(const ImpactAccess& world)
    : world_(world),
      memory_(world.impacts),
      step_(world.settings.time_step),
      substep_(step_ / world.settings.substeps),
      states_(static_cast<std::size_t>(world.settings.substeps)) {
    memory_.is_supported.assign(world.rigid.motion.size(), 0);
    for (const ContactSummary& contact : world.contacts.summaries) {
        if (contact.was_loaded) memory_.is_supported[contact.a] = memory_.is_supported[contact.b] = 1;
    }
    memory_.path_of_body.assign(world.rigid.motion.size(), not_remembered);
    memory_.path_states.clear();
}

Vec3 BodyPaths::free_acceleration(std::uint32_t body) const {
    const bool is_free = world_.rigid.motion[body].inverse_mass > 0 && !memory_.is_supported[body];
    return is_free ? world_.rigid.constants[body].acceleration : Vec3{};
}

bool BodyPaths::turns_evenly(std::uint32_t body, const BodyState& state) const {
    return state.inverse_mass == 0 || memory_.is_supported[body] ||
           !has_gyroscopic_torque(state, world_.rigid.constants[body], step_);
}

void BodyPaths::move_evenly(std::uint32_t body, BodyState& state, double time) const {
    const Vec3 acceleration = free_acceleration(body);
    state.center += state.linear_velocity * time + acceleration * (time * time / 2);
    state.linear_velocity += acceleration * time;
    if (state.angular_velocity == Vec3{}) return;
    state.rotation = turn_evenly(state.rotation, state.angular_velocity, time, substep_);
    state.turn = state.rotation * conjugate(state.start_rotation);
    if (state.inverse_mass > 0) refresh_inertia(state, world_.rigid.constants[body]);
}

BodyState BodyPaths::state_at(std::uint32_t body, double time) const {
    BodyState state = world_.rigid.motion[body];
    if (time == 0) return state;
    if (turns_evenly(body, state)) {
        move_evenly(body, state, time);
        return state;
    }

    // From the end of the last whole substep on.
    const auto whole = std::min(static_cast<std::size_t>(time / substep_), states_);
    const std::uint32_t path = memory_.path_of_body[body];
    const BodyConstants& constants = world_.rigid.constants[body];
    if (path != not_remembered && whole > 0) {
        state = memory_.path_states[path + whole - 1];
    } else {
        for (std::size_t k = 0; k < whole; ++k) move_freely(state, constants, substep_);
    }
    const double rest = time - static_cast<double>(whole) * substep_;
    if (rest > 0) move_freely(state, constants, rest);
    refresh_inertia(state, constants);
    return state;
}

BodyPaths::Motion BodyPaths::motion_about(std::uint32_t body, double time) const {
    const auto motion_of = [](const BodyState& state) {
        return Motion{state.center - state.start_center, state.linear_velocity, state.angular_velocity, state.turn};
    };
    const std::uint32_t path = memory_.path_of_body[body];
    if (path == not_remembered) return motion_of(state_at(body, time));
    const auto whole = std::min(static_cast<std::size_t>(time / substep_), states_);
    const BodyState& before = whole == 0 ? world_.rigid.motion[body] : memory_.path_states[path + whole - 1];
    Motion motion = motion_of(before);
    const double rest = time - static_cast<double>(whole) * substep_;
    if (whole == states_ || rest <= 0) return motion;

    // The spin changes linearly from here to the end of the substep.
    const Vec3 change = memory_.path_states[path + whole].angular_velocity - motion.spin;
    const Vec3 acceleration = free_acceleration(body), spin = motion.spin + change * (rest / substep_);
    motion.shift += (motion.velocity + acceleration * (rest / 2)) * rest;
    motion.velocity += acceleration * rest;
    motion.turn = cayley((motion.spin + spin) * (rest / 2)) * motion.turn;
    motion.spin = spin;
    return motion;
}

const BodyState& BodyPaths::kept_state_at(std::uint32_t body, double time) {
    std::size_t place = 0;
    while (place < kept_.size() && (kept_[place].body != body || kept_[place].time != time)) ++place;
    if (place == kept_.size()) {
        place = next_kept_;
        kept_[place] = {body, time, state_at(body, time)};
    }

    // The state found last is kept: two bodies are examined side by side.
    if (place == next_kept_) next_kept_ = (next_kept_ + 1) % kept_.size();
    return kept_[place].state;
}

Transform BodyPaths::pose_at(std::uint32_t body, double time) {
    return body_pose(kept_state_at(body, time), world_.rigid.constants[body].local_center);
}

void BodyPaths::lead_through(std::uint32_t body, BodyState state, double time) {
    if (turns_evenly(body, state)) {
        move_evenly(body, state, -time);
    } else {
        const auto whole = std::min(static_cast<std::size_t>(time / substep_), states_);
        const double rest = time - static_cast<double>(whole) * substep_;
        if (rest > 0) move_freely(state, world_.rigid.constants[body], -rest);
        for (std::size_t k = 0; k < whole; ++k) move_freely(state, world_.rigid.constants[body], -substep_);
        refresh_inertia(state, world_.rigid.constants[body]);
    }
    begin_anew(body, state);
}

void BodyPaths::change_velocities(std::uint32_t body, Vec3 linear, Vec3 angular, double time) {
    BodyState state = world_.rigid.motion[body];
    state.center -= linear * time;
    state.rotation = turn_evenly(state.rotation, angular, -time, substep_);
    state.turn = state.rotation * conjugate(state.start_rotation);
    state.linear_velocity += linear;
    state.angular_velocity += angular;
    refresh_inertia(state, world_.rigid.constants[body]);
    begin_anew(body, state);
}

void BodyPaths::begin_anew(std::uint32_t body, const BodyState& state) {
    world_.rigid.motion[body] = state;
    for (KeptState& kept : kept_) {
        if (kept.body == body) kept.body = not_remembered;
    }
    if (memory_.path_of_body[body] != not_remembered) fill_path(body);
}

void BodyPaths::fill_path(std::uint32_t body) {
    BodyState state = world_.rigid.motion[body];
    const std::size_t first = memory_.path_of_body[body];
    for (std::size_t k = 0; k < states_; ++k) {
        move_freely(state, world_.rigid.constants[body], substep_);
        memory_.path_states[first + k] = state;
    }
}

void BodyPaths::remember(std::span<const std::uint32_t> bodies) {
    constexpr std::size_t min_parallel_count = 200;  // bodies: below, waking the workers costs more
    std::vector<std::uint32_t>& remembered = memory_.remembered_bodies;
    remembered.clear();
    for (const std::uint32_t body : bodies) {
        if (memory_.path_of_body[body] != not_remembered || turns_evenly(body, world_.rigid.motion[body])) continue;
        memory_.path_of_body[body] = static_cast<std::uint32_t>(memory_.path_states.size());
        memory_.path_states.resize(memory_.path_states.size() + states_);
        remembered.push_back(body);
    }
    parallel_for(world_.workers, remembered.size(), remembered.size() >= min_parallel_count,
                 [&](int, IndexRange range) {
                     for (std::size_t i = range.first; i < range.last; ++i) fill_path(remembered[i]);
                 });
}

}  // namespace embody::physics::stages
