// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "math/vec3.h"

#include "physics/constraint/namespace.h"

namespace embody::physics::constraint {

/// A ball on a surface, of unit mass: `inertia` is I/(m r²), 2/5 of a solid one.
struct BallMotion {
    Vec3 velocity, spin;
    double radius = 0, inertia = 0.4;

    /// Velocity of the ball's matter where it touches, the normal pointing from there to its centre, m/s.
    [[nodiscard]] Vec3 slip(Vec3 normal) const { return velocity - cross(spin, normal) * radius; }
    [[nodiscard]] double energy() const;  ///< kinetic, J/kg
};

/// Coefficients of what it touches.
struct BallFriction {
    double at_rest = 0, sliding = 0;    ///< of Coulomb
    double rolling = 0, torsional = 0;  ///< lever arms, m
};

/// Effect of a push along the surface.
struct BallPush {
    Vec3 mean_velocity;  ///< m/s
    double work = 0;     ///< of friction, <= 0, J/kg
    bool sticks = false;
};

/// Pushes a ball that moves along the surface for `time` (s) by the acceleration along it and by friction under the
/// load (m/s², of unit mass): the ball rolls where friction can hold it. Exact on a plane.
BallPush push_along(BallMotion& ball, Vec3 normal, Vec3 acceleration, double load, const BallFriction& friction,
                    double time);

/// Turns the motion along the surface with its normal. The surface's push does no work. Of a rolling ball, the spin
/// about the normal and the velocity along the axis of the turn change into each other (see the source).
void turn_with_normal(BallMotion& ball, Vec3 from, Vec3 to, bool rolls);

/// Sets the ball's kinetic energy (J/kg) by another speed along the surface; of a rolling ball the spin changes, too,
/// but not that about the normal. False where no energy is left: then the ball stands.
bool set_energy(BallMotion& ball, Vec3 normal, double energy, bool rolls);

/// One of two balls that collide on still ground.
struct CollidingBall {
    BallMotion& motion;
    double mass = 0;  ///< kg
    Vec3 ground;      ///< normal of its ground, towards its centre
};

/// How they meet.
struct BallCollision {
    Vec3 direction;  ///< from a's centre to b's, unit
    double restitution = 0, friction = 0;
    double max_parting_speed = 0;  ///< m/s: a ball that leaves its ground faster is lifted off it
};

/// Collides two balls that approach each other, with the ground under each. Returns the impulse on b, N s; none, with
/// nothing changed, where it would lift one of them off its ground.
std::optional<Vec3> collide_balls(const CollidingBall& a, const CollidingBall& b, const BallCollision& collision);

}  // namespace embody::physics::constraint
