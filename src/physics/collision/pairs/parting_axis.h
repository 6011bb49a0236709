// SPDX-License-Identifier: MIT
#pragma once

#include "physics/collision/namespace.h"
#include "physics/collision/pairs/pair_memory.h"
#include "physics/collision/shapes/convex.h"

namespace embody::physics::collision {

/// The normal along which a pair separates with the shortest displacement, or is farthest apart.
struct PartingAxis {
    bool found = false;
    Vec3 normal;  ///< unit, a to b
    double separation = 0;
    bool has_witness = false;  ///< on_a and on_b are the nearest points of the cores
    Vec3 on_a, on_b;
};

/// For any two convexes that are not two polytopes with volume. Not found where they are farther apart than `margin`.
PartingAxis find_parting_axis(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory);

/// The smaller one's largest extent: the reference of lengths.
double smaller_size(const PlacedConvex& a, const PlacedConvex& b);

}  // namespace embody::physics::collision
