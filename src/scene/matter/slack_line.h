// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "math/vec3.h"

namespace embody::scene {

/// A node and the place where it is held, m.
struct HeldNode {
    std::uint32_t node = 0;
    Vec3 place;
};

/// The initial state of a slack rope.
struct SlackRope {
    std::vector<Vec3> line;      ///< its nodes without slack, m
    std::vector<HeldNode> held;  ///< on the line where the rope does not reach their places
    double slack = 0;            ///< additional length, as a fraction of the path length along the line
    Vec3 down{0, -1, 0};         ///< unit
};

/// As many places (m) as nodes, evenly along arcs from one held node to the next, each longer than its part of the line
/// by the slack. An arc hangs down where that is free; else it goes sideways, upwards, or in waves along the line: the
/// first of these that is free, or else the one with the fewest blocked places. `is_blocked`: whether something is at
/// the place of a node, or at the middle between two. Returns the line itself without slack.
std::vector<Vec3> slack_line(const SlackRope& rope, const std::function<bool(Vec3)>& is_blocked);

}  // namespace embody::scene
