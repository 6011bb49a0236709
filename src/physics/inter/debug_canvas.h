// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "math/bounds.h"
#include "physics/inter/debug_draw.h"

namespace embody::physics {

/// The canvas of the parts of debug_draw.cpp: it counts lines and points, and leaves out those beyond the limits.
class DebugCanvas {
public:
    DebugCanvas(DebugDraw& draw, const DebugDrawOptions& wanted) : options(wanted), draw_(draw) {}

    void line(Vec3 from, Vec3 to, DebugColor color) {
        if (count_.lines >= options.max_lines) {
            ++count_.lines_left_out;
            return;
        }
        ++count_.lines;
        draw_.line(from, to, color);
    }
    void point(Vec3 at, DebugColor color) {
        if (count_.points >= options.max_points) {
            ++count_.points_left_out;
            return;
        }
        ++count_.points;
        draw_.point(at, color);
    }
    /// Draws the box's twelve edges; nothing of an empty box.
    void box(const Bounds& box, DebugColor color);
    /// Draws a line with a head of two lines.
    void arrow(Vec3 from, Vec3 to, DebugColor color);

    [[nodiscard]] const DebugDrawCount& count() const { return count_; }
    [[nodiscard]] bool is_wanted(DebugDrawFlag flag) const {
        return (options.flags & static_cast<std::uint32_t>(flag)) != 0;
    }

    /// Whether things with this user data are drawn.
    [[nodiscard]] bool is_meant(std::uint64_t user_data) const {
        return options.only.empty() || std::ranges::binary_search(options.only, user_data);
    }

    const DebugDrawOptions& options;

private:
    DebugDraw& draw_;
    DebugDrawCount count_;
};

}  // namespace embody::physics
