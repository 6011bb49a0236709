// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Four sums that do not wait for each other, always in this order.
inline double dot_product(std::span<const double> a, std::span<const double> b) {
    double sum[4] = {};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
        for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace embody::physics::linear
