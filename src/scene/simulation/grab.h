// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <optional>

#include "math/quat.h"
#include "math/vec3.h"
#include "physics/inter/world.h"

namespace embody::scene {

/// Where a hand was told to be in the last moments, in simulated time, and where it is between two reports.
class HandPath {
public:
    struct Motion {
        Vec3 position;
        Quat rotation;
        Vec3 velocity;  ///< mean of the last 50 ms, or of the last two reports where these are further apart, m/s
        Vec3 spin;      ///< the same, rad/s, world axes
    };
    /// The hand is there at this time (s). Of two reports at one time the later counts. After a jump of more than a
    /// metre, or a quarter of a second without a report, the path begins anew: the hand is at rest there.
    void report(double time, Vec3 position, Quat rotation);
    /// The hand is at rest where it was told last, and may be told elsewhere at the same time.
    void rest();
    /// It goes on as it moved until the next report is overdue, and is then at rest where it was told last. Not before
    /// the last report; needs one.
    [[nodiscard]] Motion at(double time) const;

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
