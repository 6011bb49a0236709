// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// a·b: four sums that do not wait for each other, always in this order.
inline double dot_product(std::span<const double> a, std::span<const double> b) {
    double sum[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// x += α p, r −= α q, in one pass.
inline void step_along(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                       std::span<double> r) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        x[i] += alpha * p[i];
        r[i] -= alpha * q[i];
    }
}

/// p = z + β p.
inline void turn_direction(double beta, std::span<const double> z, std::span<double> p) {
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = z[i] + beta * p[i];
}

}  // namespace embody::physics::linear
