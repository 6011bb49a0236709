// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// The index of one of many numbers, and its value.
struct Extreme {
    double along = 0;
    std::uint32_t index = 0;
};

/// Minimum and maximum along a direction.
struct Extent {
    double lowest = 0, highest = 0;
};

/// Vectors by components; `count` is a multiple of what one instruction takes up.
template <class Number>
struct VectorLanes {
    const Number *x, *y, *z;
    std::size_t count;
};

/// Loops over all vertices or faces of a polytope for one width of the processor's registers; any width gives the same
/// bits. `d` points to the three components of a vector. polytope_query.h says what they compute.
struct PolytopeKernels {
    Extreme (*farthest)(const VectorLanes<double>& vectors, const double* d);
    Extent (*extent)(const VectorLanes<double>& vectors, const double* d);
    std::uint32_t (*farthest_roughly)(const VectorLanes<float>& vectors, const float* d);
    double (*heights_over_faces)(const VectorLanes<double>& normals, const double* reach, const double* d,
                                 double* heights);
    Extreme (*lower_bounds)(const VectorLanes<double>& normals, const double* reach, const double* d, double* bounds);
    std::uint32_t (*find_low)(const VectorLanes<double>& vectors, const double* d, double limit, std::uint32_t* found);

    /// For each width of math/kernel_width.h.
    static const PolytopeKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody::physics::collision
