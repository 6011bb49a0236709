// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "physics/deformable/contact/thin_pairs.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Two features, as places of their nodes when a substep begins, m, and moves in it, m: those of the first feature
/// first, as in ThinPoints. A node on an edge has no fourth.
struct MovingFeatures {
    ThinFeature kind = ThinFeature::node_on_triangle;
    std::array<Vec3, 4> start, move;
};

/// The moment at which two features are too near to go on.
struct Impact {
    double time = 0;                 ///< of the substep, 0 … 1
    std::array<double, 4> weight{};  ///< as of ThinPoints: Σ weight x is the vector from the second to the first
    Vec3 normal;                     ///< its direction then, unit
};

/// When two features that move straight come so near that they might meet: nearer than a tenth of `distance` (m, > 0)
/// or of the distance that they began with, whichever is less, but not below a hundredth of `distance`, and a tenth of
/// what is left. Nothing is missed, whatever the moves: places in between are tried as far as the features cannot meet
/// (M. Li, D. Kaufman, C. Jiang, "Codimensional incremental potential contact", 2021, algorithm 1). None for those that
/// begin nearer than that hundredth, which have no side of each other: only what was put there does.
std::optional<Impact> first_impact(const MovingFeatures& features, double distance);

}  // namespace embody::physics::deformable
