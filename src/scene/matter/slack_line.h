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

/// Where a slack rope begins.
struct SlackRope {
    std::vector<Vec3> line;      ///< its nodes without slack, m
    std::vector<HeldNode> held;  ///< on the line where the rope does not reach their places
    double slack = 0;            ///< how much longer it is than the way along the line: a share of that
    Vec3 down{0, -1, 0};         ///< unit
};

/// As many places (m), evenly along arcs from one held node to the next, each longer than its part of the line by the
/// slack. An arc hangs down where it is free; else it goes sideways, upwards, or in waves along the line, the first of
/// these that is free, or the one that is most so. `is_blocked`: whether something stands where a node would be, or the
/// middle between two. The line itself without slack.
std::vector<Vec3> slack_line(const SlackRope& rope, const std::function<bool(Vec3)>& is_blocked);

}  // namespace embody::scene
