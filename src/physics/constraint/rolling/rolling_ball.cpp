// SPDX-License-Identifier: MIT
//
// Rolling: v = r ω × n, so ω = n × v / r + σ n. With the surface's force F (unit mass), k = I/(m r²):
//     dv/dt = F + a,   k r dω/dt = −n × F.
// Along a plane F stops the slip s = v − r ω × n: an impulse J changes it by J (1 + 1/k).
// Where n turns, n · dω/dt = 0 gives
//     (1 + k) (dv/dt)_t = k r σ n × dn/dt + a_t,   r dσ/dt = −v · (n × dn/dt).
// For n that turns by φ about the axis t, without a: with u = v·t, w = r σ, κ = k/(1 + k)
//     du/dφ = κ w,   dw/dφ = −u,   so u² + κ w² stays;   v across t stays and turns along.
// Two balls that collide: an impulse P along the line of centres c meets the response of the ground, which takes the
// part into it, so the inverse mass of each is (1 − (c·n)²)/m, and P (1 + e) conserves energy for e = 1. For spheres it
// does not change the slip, and friction not the approach, so eq. (3) of the paper ends in min(µ P, what stops the
// slip). Sources: E. Routh, "Advanced dynamics", 1905, chapter V (a sphere that rolls on a surface); M. Gualtieri et
// al., "Golfer's dilemma", 2006 (the same in a cylinder).
#include "physics/constraint/rolling/rolling_ball.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::constraint {

double BallMotion::energy() const {
    return (length_squared(velocity) + inertia * radius * radius * length_squared(spin)) / 2;
}

namespace {

// Shortens v by at most `most`.
Vec3 slowed(Vec3 v, double most) {
    const double size = length(v);
    return size > most ? v * (1 - most / size) : Vec3{};
}

// The moments that resist rolling and spinning, under the load for the time.
void resist(BallMotion& ball, Vec3 normal, double impulse, const BallFriction& friction, bool rolls) {
    const double own = ball.inertia * ball.radius * ball.radius;
    const double about = dot(ball.spin, normal);
    const Vec3 across = slowed(ball.spin - normal * about,
                               friction.rolling * impulse / (rolls ? own + ball.radius * ball.radius : own));
    const Vec3 spinning = slowed(normal * about, friction.torsional * impulse / own);
    ball.spin = across + spinning;
    if (rolls) ball.velocity = cross(across, normal) * ball.radius;
}

}  // namespace

BallPush push_along(BallMotion& ball, Vec3 normal, Vec3 acceleration, double load, const BallFriction& friction,
                    double time) {
    const Vec3 start = ball.velocity, start_slip = ball.slip(normal);
    ball.velocity += acceleration * time;
    const Vec3 slip = ball.slip(normal);
    Vec3 impulse = slip * (-ball.inertia / (1 + ball.inertia));
    const double wanted = length(impulse);
    const bool sticks = load > 0 && wanted <= friction.at_rest * load * time;
    if (!sticks && wanted > 0) impulse *= std::min(1.0, friction.sliding * load * time / wanted);
    ball.velocity += impulse;
    ball.spin -= cross(normal, impulse) / (ball.inertia * ball.radius);
    BallPush push{.work = std::min(0.0, dot(impulse, start_slip + ball.slip(normal)) / 2), .sticks = sticks};
    if (friction.rolling > 0 || friction.torsional > 0) {
        const double before = ball.energy();
        resist(ball, normal, load * time, friction, sticks);
        push.work += std::min(0.0, ball.energy() - before);
    }
    push.mean_velocity = (start + ball.velocity) * 0.5;
    return push;
}

void turn_with_normal(BallMotion& ball, Vec3 from, Vec3 to, bool rolls) {
    constexpr double min_sine = 1e-15;  // rounding: below, the axis of the turn has no direction
    const Vec3 turning = cross(from, to);
    const double sine = length(turning);
    if (sine < min_sine) return;
    const Vec3 axis = turning / sine, ahead = cross(axis, from), ahead_after = cross(axis, to);
    const double across = dot(ball.velocity, ahead), along = dot(ball.velocity, axis);
    if (!rolls) {
        ball.velocity = axis * along + ahead_after * across;
        return;
    }
    const double root = std::sqrt(ball.inertia / (1 + ball.inertia));
    const double angle = std::atan2(sine, dot(from, to)) * root, c = std::cos(angle), s = std::sin(angle);
    const double whirl = ball.radius * dot(ball.spin, from);
    ball.velocity = axis * (along * c + root * whirl * s) + ahead_after * across;
    const double whirl_after = whirl * c - along / root * s;
    ball.spin = (cross(to, ball.velocity) + to * whirl_after) / ball.radius;
}

bool set_energy(BallMotion& ball, Vec3 normal, double energy, bool rolls) {
    const double whirl = ball.radius * dot(ball.spin, normal);
    const double kept = rolls ? ball.inertia * whirl * whirl / 2
                              : ball.inertia * ball.radius * ball.radius * length_squared(ball.spin) / 2;
    const double wanted = 2 * (energy - kept) / (rolls ? 1 + ball.inertia : 1), now = length_squared(ball.velocity);
    const bool has_energy = wanted >= 0 && now > 0;
    ball.velocity *= has_energy ? std::sqrt(wanted / now) : 0;
    if (rolls) ball.spin = (cross(normal, ball.velocity) + normal * whirl) / ball.radius;
    return has_energy;
}

std::optional<Vec3> collide_balls(const CollidingBall& a, const CollidingBall& b, const BallCollision& collision) {
    const Vec3 direction = collision.direction;
    const auto yielding_along = [&](const CollidingBall& ball) {
        const double into_ground = dot(direction, ball.ground);
        return (1 - into_ground * into_ground) / ball.mass;
    };
    const auto surface_velocity = [&](const CollidingBall& ball, double side) {
        return ball.motion.velocity + cross(ball.motion.spin, direction * (side * ball.motion.radius));
    };
    const double closing = dot(direction, a.motion.velocity - b.motion.velocity);
    const double normal = (1 + collision.restitution) * closing / (yielding_along(a) + yielding_along(b));

    // Only friction changes the slip of spheres.
    Vec3 slip = surface_velocity(b, -1) - surface_velocity(a, 1);
    slip -= direction * dot(direction, slip);
    const double speed = length(slip);
    const double yielding = (1 + 1 / a.motion.inertia) / a.mass + (1 + 1 / b.motion.inertia) / b.mass;
    const Vec3 friction_impulse =
        speed > 0 ? slip * (-std::min(1 / yielding, collision.friction * normal / speed)) : Vec3{};
    const Vec3 impulse = direction * normal + friction_impulse;
    const double max_lift = collision.max_parting_speed;
    if (-dot(impulse, a.ground) > max_lift * a.mass || dot(impulse, b.ground) > max_lift * b.mass) return std::nullopt;
    const auto push = [&](const CollidingBall& ball, double sign) {
        BallMotion& motion = ball.motion;
        const Vec3 change = impulse * (sign / ball.mass);
        motion.velocity += change - ball.ground * dot(change, ball.ground);
        motion.spin -= cross(direction, friction_impulse) / (motion.inertia * motion.radius * ball.mass);
    };
    push(a, -1);
    push(b, 1);
    return impulse;
}

}  // namespace embody::physics::constraint
