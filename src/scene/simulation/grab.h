// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>

#include "math/quat.h"
#include "math/vec3.h"
#include "physics/inter/world.h"

namespace embody::scene {

/// Where a hand was in the last moments, in simulated time.
class HandPath {
public:
    /// Once a step. A jump of more than a metre is no motion: the path begins anew there, at rest.
    void add(double time, Vec3 position, Quat rotation);
    /// Forgets the past: the hand is at rest where it is told next.
    void clear() { samples_.clear(); }
    [[nodiscard]] Vec3 velocity() const;          ///< mean of the last 50 ms, m/s
    [[nodiscard]] Vec3 angular_velocity() const;  ///< the same, rad/s, world axes

private:
    struct Sample {
        double time;  ///< s
        Vec3 position;
        Quat rotation;
    };
    std::deque<Sample> samples_;
};

/// A spring from a hand to a body.
struct Grab {
    physics::BodyHandle body;
    Vec3 local_point;              ///< where it is held, in the body's frame
    Vec3 target;                   ///< the hand, world
    std::optional<Quat> rotation;  ///< that the body should have; empty: it hangs from the point
    Vec3 velocity, spin;           ///< of the hand, m/s and rad/s
    double strength = 400;         ///< greatest force, N
    double closing_speed = 5;      ///< at which what is far from the hand comes to it at most, m/s
    double frequency = 60;         ///< ω, rad/s
};

/// Pulls in the next step, as one of so many hands at this body. Stable for any mass, lever arm and step: spring and
/// damper use the effective mass of the point and are evaluated at the step's end (implicit Euler).
void pull(physics::World& world, const Grab& grab, int hands_at_body);

}  // namespace embody::scene
