// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "physics/constraint/rolling/ball_path.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// Memory of the stage that rolls balls: nothing in it outlives a step.
struct BallMemory {
    /// A ball that, as far as known, touches nothing but immovable ground and other such balls.
    struct Candidate {
        std::uint32_t body = 0;
        bool is_free = true;       ///< touches nothing else
        bool has_company = false;  ///< has a pair with another candidate
        bool has_rolled = false;
        std::vector<std::uint32_t> contacts;  ///< with the ground
        BallSurroundings surroundings;
        RolledBall rolled;
        std::uint32_t parent = 0;  ///< union-find over pairs: candidates

        // Only of balls in pairs.
        std::optional<BallPath> path;
        BallPlace at, next;
        Vec3 received;  ///< impulses of the other balls, N s
    };
    /// Two balls with a contact region, touching or within the margin.
    struct Pair {
        std::uint32_t contact = 0, a = 0, b = 0;  ///< candidates
        Vec3 impulse;                             ///< on b, N s
        double energy_change = 0;                 ///< J, <= 0
        std::uint32_t root = 0;                   ///< of its cluster
    };
    std::vector<Candidate> candidates;
    std::size_t count = 0;               ///< of candidates in use
    std::vector<std::uint32_t> of_body;  ///< candidate + 1, by body
    std::vector<Pair> pairs;             ///< sorted by the root of their balls
    std::vector<std::uint32_t> members;  ///< of the present cluster: candidates, ascending
    std::vector<RolledBall> rolled;      ///< ascending by body
};

}  // namespace embody::physics::state
