// SPDX-License-Identifier: MIT
// Hands in the world: what they hold, and the balls that they push with.
#include <algorithm>
#include <cmath>

#include "scene/simulation/simulation_state.h"

namespace embody::scene {

using physics::BodyHandle;

namespace {

/// Mass of a forearm with its hand, kg: 2.2 % of 75 kg (D. A. Winter, "Biomechanics and Motor Control of Human
/// Movement", 4th ed., 2009, table 4.1). It limits how hard a hand strikes.
constexpr double arm_mass = 0.022 * 75;
/// The same about the elbow, as of a rod of 0.25 m, kg m²: friction hardly turns it.
constexpr double arm_inertia = arm_mass * 0.25 * 0.25 / 3;
constexpr double skin_friction = 0.8;  // about what dry skin has on wood, plastics and cloth
/// What a hand has let go of is left when its points are farther from the ball than this: cloth has points about so far
/// apart, m.
constexpr double left_behind = 0.05;

std::string called(const Entity& entity) {
    return entity.name.empty() ? "entity " + std::to_string(entity.index) : entity.name;
}

}  // namespace

const HandBall* Simulation::State::hand(BodyHandle body) const {
    const auto found = std::ranges::find(hands, body, &HandBall::body);
    return found == hands.end() ? nullptr : &*found;
}

// A ray goes on behind each hand's ball: nothing else is within it.
std::optional<physics::RayHit> Simulation::State::cast_ray(Vec3 origin, Vec3 direction, double max_distance,
                                                           BodyHandle ignore) const {
    double passed = 0;  // m
    while (passed < max_distance) {
        auto hit = world->cast_ray(origin + passed * direction, direction, max_distance - passed, ignore);
        if (!hit) return hit;
        hit->distance += passed;
        const HandBall* ball = hand(hit->body);
        if (!ball) return hit;
        // Where the ray leaves the ball, and a little farther.
        const Vec3 to_center = world->center_of_mass(ball->body) - origin;
        const double nearest = dot(to_center, direction);
        const double off = length_squared(to_center) - nearest * nearest;
        const double half_chord = std::sqrt(std::max(0.0, ball->radius * ball->radius - off));
        passed = std::max(hit->distance, nearest + half_chord) + 1e-6;
    }
    return std::nullopt;
}

Result<BodyHandle> Simulation::hold(EntityIndex entity, Vec3 position) {
    const LiveEntity* found = state_->find(entity);
    if (!found) return Error{"index", "entity " + std::to_string(entity) + " is not in the world"};
    if (found->points && found->points->is_liquid())
        return Error{"index", called(found->definition) + " is a liquid, which no hand can hold",
                     "hold the vessel that it is in, or push it with simulation.touch"};
    if (!is_movable(entity))
        return Error{"index", called(found->definition) + " does not move", "hold a thing whose kind is not static"};
    const BodyHandle held = found->points ? found->points->hold(position) : found->body;
    if (held.is_null()) return Error{"index", called(found->definition) + " cannot be held there"};
    return held;
}

void Simulation::let_go(EntityIndex entity, BodyHandle held) {
    const LiveEntity* found = state_->find(entity);
    if (found && found->points) found->points->let_go(held);
}

Result<BodyHandle> Simulation::add_hand(Vec3 position, double radius) {
    const auto shape = state_->world->create_shape(physics::SphereShape{radius});
    if (!shape.ok()) return shape.error();
    physics::BodyDefinition ball;
    ball.shape = shape.value();
    ball.position = position;
    ball.mass.mass = arm_mass;
    ball.mass.inertia = Mat3::diagonal({arm_inertia, arm_inertia, arm_inertia});
    ball.material.friction_static = ball.material.friction_dynamic = skin_friction;
    ball.gravity_factor = 0;
    ball.allow_sleep = false;
    ball.continuous = true;
    ball.collision_group = 0xFFFFFFFFu;
    const Result<BodyHandle> body = state_->world->create_body(ball);
    if (!body.ok()) {
        (void)state_->world->destroy_shape(shape.value()).ok();
        return body.error();
    }
    state_->hands.push_back({body.value(), shape.value(), radius});
    return body.value();
}

void Simulation::remove_hand(BodyHandle hand) {
    const HandBall* found = state_->hand(hand);
    if (!found) return;
    // Body and shape are in the world, so that it does not refuse.
    (void)state_->world->destroy_body(found->body).ok();
    (void)state_->world->destroy_shape(found->shape).ok();
    state_->hands.erase(state_->hands.begin() + (found - state_->hands.data()));
}

bool Simulation::is_touched(EntityIndex entity, Vec3 place, double radius) const {
    const LiveEntity* found = state_->find(entity);
    if (!found) return false;
    if (found->points) {
        std::vector<Vec3> positions;
        found->points->read(positions);
        const double reach = radius + found->points->radius() + left_behind;
        return std::ranges::any_of(positions, [&](Vec3 p) { return length_squared(p - place) < reach * reach; });
    }
    const Vec3 half{radius, radius, radius};
    const std::vector<BodyHandle> there = state_->world->overlap_box({place - half, place + half});
    return std::ranges::find(there, found->body) != there.end();
}

}  // namespace embody::scene
