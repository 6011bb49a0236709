// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/collision/queries/ball_touch.h"
#include "physics/constraint/rolling/rolling_ball.h"
#include "physics/dynamic/body_state.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// Where a ball that rolls alone ends the step.
struct RolledBall {
    std::uint32_t body = 0;
    std::uint32_t contact = 0;  ///< index: of its contacts the one that lies most as the ball stands in the end
    BodyState state;
    Vec3 impulse;  ///< of the ground, N s
};

/// Memory of the stage that rolls balls: nothing in it outlives a step.
struct BallMemory {
    /// What a ball may touch, and where it is near that, while its path is followed.
    struct Ground {
        std::uint32_t body = 0;
        const CollisionShape* shape = nullptr;
        Transform pose;
        BallFriction friction;
    };
    struct Surroundings {
        std::vector<Ground> grounds;
        std::vector<BallTouch> touches;
        std::vector<std::size_t> ground_of;  ///< by touch
    };
    std::vector<Surroundings> surroundings;  ///< by worker

    /// A ball that touches nothing but still ground, as far as known.
    struct Candidate {
        std::uint32_t body = 0;
        bool is_alone = true, has_rolled = false;
        std::vector<std::uint32_t> contacts;
        RolledBall rolled;
    };
    std::vector<Candidate> candidates;
    std::size_t count = 0;               ///< of candidates in use
    std::vector<std::uint32_t> of_body;  ///< candidate + 1, by body
    std::vector<RolledBall> rolled;      ///< ascending by body
};

}  // namespace embody::physics::state
