// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "math/bounds.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Box in floats that holds a box in doubles: 10 km from the origin it is a millimetre larger.
struct FloatBox {
    static constexpr double farthest = 1e38;  ///< m
    float lower[3] = {}, upper[3] = {};

    FloatBox() = default;
    explicit FloatBox(const Bounds& bounds) {
        for (int k = 0; k < 3; ++k) {
            const auto low = static_cast<float>(std::clamp(bounds.lower[k], -farthest, farthest));
            const auto high = static_cast<float>(std::clamp(bounds.upper[k], -farthest, farthest));
            lower[k] = low - (std::fabs(low) * 1.2e-7f + 1e-30f);
            upper[k] = high + (std::fabs(high) * 1.2e-7f + 1e-30f);
        }
    }
    [[nodiscard]] bool contains(const Bounds& b) const {
        return lower[0] <= b.lower.x && lower[1] <= b.lower.y && lower[2] <= b.lower.z && upper[0] >= b.upper.x &&
               upper[1] >= b.upper.y && upper[2] >= b.upper.z;
    }
    [[nodiscard]] Bounds bounds() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }
};

/// Box that travels along a straight line by m: at the fraction s of the step, 0 … 1, it is at `box` + s m. Of one body
/// m = min_displacement = max_displacement; a box around several has all displacements between the two, m.
struct MovingBox {
    FloatBox box;
    float min_displacement[3] = {}, max_displacement[3] = {};  ///< m

    MovingBox() = default;
    explicit MovingBox(const FloatBox& at_rest) : box(at_rest) {}
    MovingBox(const FloatBox& start, Vec3 displacement) : box(start) {
        for (int k = 0; k < 3; ++k) min_displacement[k] = max_displacement[k] = static_cast<float>(displacement[k]);
    }
    [[nodiscard]] bool moves() const {
        bool any = false;
        for (int k = 0; k < 3; ++k) any = any || min_displacement[k] != 0 || max_displacement[k] != 0;
        return any;
    }
    [[nodiscard]] Vec3 displacement() const { return {max_displacement[0], max_displacement[1], max_displacement[2]}; }
    /// All places that it passes.
    [[nodiscard]] FloatBox swept() const {
        FloatBox all = box;
        for (int k = 0; k < 3; ++k) {
            all.lower[k] += std::min(0.0f, min_displacement[k]);
            all.upper[k] += std::max(0.0f, max_displacement[k]);
        }
        return all;
    }
    /// Whether the two may meet while both travel: only their motion relative to each other counts, so that things that
    /// fly side by side are as far apart as at rest. The same for (a, b) and (b, a), to the last bit.
    [[nodiscard]] bool meets(const MovingBox& b) const {
        bool meet = true;
        for (int k = 0; k < 3; ++k) {
            meet = meet &&
                   box.lower[k] - b.box.upper[k] <= std::max(0.0f, b.max_displacement[k] - min_displacement[k]) &&
                   b.box.lower[k] - box.upper[k] <= std::max(0.0f, max_displacement[k] - b.min_displacement[k]);
        }
        return meet;
    }
};

}  // namespace embody::physics::collision
