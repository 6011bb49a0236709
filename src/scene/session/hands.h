// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/session/impacts.h"
#include "scene/simulation/grab.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

/// A client's hand, by the name that the client gives it.
struct HandName {
    std::uint64_t client = 0;
    std::string name;
    friend auto operator<=>(const HandName&, const HandName&) = default;
};

/// Where a hand is told to be, world.
struct HandPlace {
    Vec3 position;
    std::optional<Quat> rotation;
};

/// What struck a hand, or what it holds.
struct Strike {
    HandName hand;
    EntityIndex held = 0;   ///< 0: the hand itself was struck
    EntityIndex other = 0;  ///< 0: another hand
    Vec3 position;          ///< world, m
    double impulse = 0;     ///< N s
};

/// All clients' hands: each may hold one thing, several may hold one thing together, and each may push things as a
/// ball. A hand that holds something pushes with that only: its ball is away until it has left what it held.
class Hands {
public:
    /// Holds it at the point with this strength (N). A hand that holds something lets go of it first. An error where it
    /// cannot be held.
    Result<void> grab(Simulation& simulation, const HandName& hand, EntityIndex entity, Vec3 point, double strength);
    /// Where what it holds is pulled to from now on. What it holds turns as the hand turns after its first rotation.
    Result<void> move(Simulation& simulation, const HandName& hand, const HandPlace& place);
    void release(Simulation& simulation, const HandName& hand);

    struct Ball {
        HandPlace place;
        double radius = 0.05;  ///< m, of a fist
    };
    /// From the next step on.
    Result<void> touch(Simulation& simulation, const HandName& hand, const Ball& ball);
    void stop_touching(Simulation& simulation, const HandName& hand);

    void forget(Simulation& simulation, std::uint64_t client);
    /// For a new simulation: none of them is there any more.
    void clear() { hands_.clear(); }
    /// They are at rest, wherever they are told next: while the simulation was paused they moved in no time.
    void rest();

    /// Pulls and pushes in the next step, and forgets what is not in the world any more.
    void before_step(Simulation& simulation);
    /// What struck them, strongest of the last thirtieth of a second.
    std::vector<Strike> after_step(const Simulation& simulation);

private:
    struct Held {
        EntityIndex entity = 0;
        Grab grab;
        HandPath path;
        std::optional<Quat> hand_rotation;  ///< as it was told last; empty: the hand does not turn it
        Quat offset;                        ///< of the body's rotation from the hand's
    };
    struct Touching {
        double radius = 0;  ///< of the ball, m
        HandPath path;
        physics::BodyHandle body;  ///< null while it is away
    };
    struct Hand {
        std::optional<Held> held;
        std::optional<Touching> touching;
        EntityIndex left = 0;  ///< what it let go of last and may still be in; 0: nothing
        std::optional<Strike> strike;
        Pace pace{30};
    };
    Result<Hand*> take(const HandName& hand);
    [[nodiscard]] Hand* find(const HandName& hand);
    void remove_if_idle(const HandName& hand);
    void let_go(Simulation& simulation, Hand& hand);
    void forget_gone(Simulation& simulation);
    void steer(Simulation& simulation, Hand& hand);
    [[nodiscard]] int hands_at(physics::BodyHandle body) const;

    std::map<HandName, Hand> hands_;
};

}  // namespace embody::scene
