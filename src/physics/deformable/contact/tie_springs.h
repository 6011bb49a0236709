// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/contact/touch_springs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A tie of a sheet or rope to another that is in the same solve.
struct PlacedTie {
    const Nodes *own = nullptr, *other = nullptr;
    std::uint32_t own_first = 0, other_first = 0;  ///< number of the first node of each among those of all
    const Tie* tie = nullptr;
    Vec3* pull = nullptr;  ///< force at the last substep's end, N, on its own node; gets the new one
};

/// Ties as springs of two to four nodes with memory, like TouchSprings, but in every direction. Their forces are equal
/// and opposite.
class TieSprings {
public:
    /// Begins a substep of h seconds. `gravity`: m/s². Separated ends are drawn together no faster than recovery_speed.
    void begin(std::span<const PlacedTie> ties, double h, double gravity, const ThinContactSettings& settings);
    /// Remembers the forces of the springs.
    void finish(std::span<const Vec3> moves);
    [[nodiscard]] std::span<const TouchSpring> springs() const { return springs_; }

private:
    std::vector<TouchSpring> springs_;
    std::vector<Vec3*> pulls_;  // of these
};

}  // namespace embody::physics::deformable
