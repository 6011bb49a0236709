// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// A corner of a contact region in its plane: coordinates along two unit axes, and its depth, m.
struct FlatPoint {
    double x, y, separation;
};

/// Indices of the points of a region to keep.
struct ChosenPoints {
    int count = 0;
    std::array<int, 4> index{};

    [[nodiscard]] bool holds(int i) const {
        for (int k = 0; k < count; ++k) {
            if (index[static_cast<std::size_t>(k)] == i) return true;
        }
        return false;
    }
};

/// At most four of the points: the deepest, then deep ones that span a large area (paper, III.B); points that add no
/// area (twins, or inner ones of a line) are left out. Nearly equal scores go to the earlier point, so that rounding
/// does not choose.
ChosenPoints choose_four(const FlatPoint* points, int count);

/// Whether a point that was not chosen lies lower than the planes through the chosen ones, by more than `tolerance`
/// (m):
/// it would penetrate undetected before they do.
bool leaves_unseen(const FlatPoint* points, int count, const ChosenPoints& chosen, double tolerance);

}  // namespace embody::physics::collision
