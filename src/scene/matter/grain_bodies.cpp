// SPDX-License-Identifier: MIT
#include "scene/matter/grain_bodies.h"

#include <algorithm>

namespace embody::scene {

using physics::BodyHandle;
using physics::SleepState;

Result<std::unique_ptr<GrainBodies>> GrainBodies::create(physics::World& world, const GrainDefinition& definition) {
    std::unique_ptr<GrainBodies> made(new GrainBodies(world, definition.diameter / 2));
    const Result<physics::ShapeHandle> shape = world.create_shape(physics::SphereShape{made->radius_});
    if (!shape.ok()) return Error{"simulated_diameter", shape.error().why, shape.error().remedy};
    made->shape_ = shape.value();
    made->balls_.reserve(definition.centers.size());
    const Transform frame{definition.body.position, definition.body.rotation};
    physics::BodyDefinition ball = definition.body;
    ball.force = definition.body.force / static_cast<double>(definition.centers.size());
    ball.torque = {};
    ball.shape = made->shape_;
    for (const Vec3& center : definition.centers) {
        ball.position = transform_point(frame, center);
        ball.linear_velocity =
            definition.body.linear_velocity + cross(definition.body.angular_velocity, ball.position - frame.position);
        const Result<BodyHandle> body = world.create_body(ball);
        if (!body.ok()) return body.error();
        made->balls_.push_back(body.value());
    }
    return made;
}

// No other body uses the shape, and no other owner destroys the bodies, so that the world does not refuse.
GrainBodies::~GrainBodies() {
    (void)world_.destroy_bodies(balls_).ok();
    if (!shape_.is_null()) (void)world_.destroy_shape(shape_).ok();
}

Result<void> GrainBodies::set_definition(const PointsDefinition& definition) {
    const physics::BodyDefinition& body = std::get<GrainDefinition>(definition).body;
    return world_.change_bodies(balls_, [&](physics::BodyDefinition& ball) {
        const physics::BodyDefinition now = ball;
        ball = body;
        ball.force = body.force / static_cast<double>(balls_.size());
        ball.torque = {};
        ball.shape = shape_;
        ball.position = now.position;
        ball.rotation = now.rotation;
        ball.linear_velocity = now.linear_velocity;
        ball.angular_velocity = now.angular_velocity;
        ball.start_asleep = false;
    });
}

void GrainBodies::read(std::vector<Vec3>& positions) const {
    positions.clear();
    for (const BodyHandle ball : balls_) positions.push_back(world_.center_of_mass(ball));
}

SleepState GrainBodies::state() const {
    SleepState state = SleepState::asleep;
    for (const BodyHandle ball : balls_) {
        state = std::min(state, world_.sleep_state(ball));
        if (state == SleepState::active) break;
    }
    return state;
}

Vec3 GrainBodies::linear_velocity() const {
    Vec3 sum;
    for (const BodyHandle ball : balls_) sum += world_.linear_velocity(ball);
    return sum / static_cast<double>(balls_.size());
}

Vec3 GrainBodies::center_of_mass() const {
    Vec3 sum;
    for (const BodyHandle ball : balls_) sum += world_.center_of_mass(ball);
    return sum / static_cast<double>(balls_.size());
}

double GrainBodies::mass() const { return world_.mass(balls_.front()) * static_cast<double>(balls_.size()); }

Bounds GrainBodies::bounds() const {
    Bounds bounds;
    for (const BodyHandle ball : balls_) bounds.add(world_.center_of_mass(ball));
    return enlarged(bounds, radius_);
}

std::optional<double> GrainBodies::drop_distance(double max_distance) const {
    std::vector<bool> is_own;
    for (const BodyHandle ball : balls_) {
        if (ball.index >= is_own.size()) is_own.resize(ball.index + 1);
        is_own[ball.index] = true;
    }
    const auto ignores = [&](BodyHandle other) { return other.index < is_own.size() && is_own[other.index]; };
    std::optional<double> min_distance;
    for (const BodyHandle ball : balls_) {
        const std::optional<double> drop = world_.drop_distance(ball, min_distance.value_or(max_distance), ignores);
        if (drop && (!min_distance || *drop < *min_distance)) min_distance = drop;
    }
    return min_distance;
}

BodyHandle GrainBodies::hold(Vec3 position) {
    return *std::ranges::min_element(
        balls_, {}, [&](BodyHandle ball) { return length_squared(world_.center_of_mass(ball) - position); });
}

Result<void> GrainBodies::move(const Transform& motion) {
    return world_.change_bodies(balls_, [&](physics::BodyDefinition& ball) {
        ball.position = transform_point(motion, ball.position);
        ball.rotation = normalized(motion.rotation * ball.rotation);
        ball.linear_velocity = ball.angular_velocity = {};
        ball.start_asleep = false;
    });
}

Result<void> GrainBodies::set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) {
    if (positions.size() != balls_.size() || velocities.size() != balls_.size())
        return Error{"positions", "must be " + std::to_string(balls_.size()) + ", one a grain"};
    std::size_t next = 0;
    return world_.change_bodies(balls_, [&](physics::BodyDefinition& ball) {
        ball.position = positions[next];
        ball.linear_velocity = velocities[next++];
        ball.angular_velocity = {};
        ball.start_asleep = false;
    });
}

Result<void> GrainBodies::set_velocity(Vec3 linear, Vec3 angular) {
    const Vec3 center = center_of_mass();
    for (const BodyHandle ball : balls_) {
        const Vec3 velocity = linear + cross(angular, world_.center_of_mass(ball) - center);
        if (Result<void> set = world_.set_velocity(ball, velocity, angular); !set.ok()) return set;
    }
    return {};
}

Result<void> GrainBodies::apply_impulse(Vec3 impulse) {
    const Vec3 per_ball = impulse / static_cast<double>(balls_.size());
    for (const BodyHandle ball : balls_)
        if (Result<void> pushed = world_.apply_impulse(ball, per_ball); !pushed.ok()) return pushed;
    return {};
}

Result<void> GrainBodies::apply_force(Vec3 force) {
    const Vec3 per_ball = force / static_cast<double>(balls_.size());
    for (const BodyHandle ball : balls_)
        if (Result<void> pushed = world_.apply_force(ball, per_ball); !pushed.ok()) return pushed;
    return {};
}

Result<void> GrainBodies::set_enabled(bool enabled) {
    return world_.change_bodies(balls_, [enabled](physics::BodyDefinition& ball) { ball.enabled = enabled; });
}

}  // namespace embody::scene
