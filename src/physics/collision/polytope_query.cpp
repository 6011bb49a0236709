// SPDX-License-Identifier: MIT
#include "physics/collision/polytope_query.h"

#include <algorithm>

namespace embody::physics {

namespace {

constexpr std::size_t block = 64;

}  // namespace

Extreme farthest(const Lanes& lanes, Vec3 direction) {
    // Block after block: all products, their maximum in four strands, then where the maximum is.
    Extreme best{-1e300, 0};
    double along[block];
    for (std::size_t start = 0; start < lanes.size(); start += block) {
        const std::size_t count = std::min(block, lanes.size() - start);
        const double *x = lanes.x.data() + start, *y = lanes.y.data() + start, *z = lanes.z.data() + start;
        double high[4] = {-1e300, -1e300, -1e300, -1e300};
        for (std::size_t i = 0; i < count; i += 4) {
            for (std::size_t k = 0; k < 4; ++k) {
                along[i + k] = x[i + k] * direction.x + y[i + k] * direction.y + z[i + k] * direction.z;
                high[k] = high[k] > along[i + k] ? high[k] : along[i + k];
            }
        }
        const double highest = std::max(std::max(high[0], high[1]), std::max(high[2], high[3]));
        if (!(highest > best.along)) continue;
        std::size_t at = 0;
        while (at + 1 < count && along[at] != highest) ++at;
        best = {highest, static_cast<std::uint32_t>(start + at)};
    }
    return best;
}

void heights_over_faces(const Polytope& polytope, Vec3 point, double* __restrict heights) {
    const Lanes& normals = polytope.normal_lanes;
    const double *x = normals.x.data(), *y = normals.y.data(), *z = normals.z.data(), *reach = polytope.reach.data();
    const std::size_t count = normals.size();
    for (std::size_t i = 0; i < count; ++i) {
        heights[i] = (x[i] * point.x + y[i] * point.y + z[i] * point.z) - reach[i];
    }
}

}  // namespace embody::physics
