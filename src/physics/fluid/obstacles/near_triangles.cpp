// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/near_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace embody::physics::fluid {

void NearTriangles::begin(const Bounds& box, double reach) {
    all_.clear();
    every_.clear();
    size_ = {};
    box_ = box;
    reach_ = reach;
}

int NearTriangles::bin_along(int axis, double place) const {
    return std::clamp(static_cast<int>((place - box_.lower[axis]) * inverse_edge_[axis]), 0, size_[axis] - 1);
}

void NearTriangles::finish() {
    constexpr std::size_t few = 16;  // triangles: to look at them all costs no more than to sort them
    constexpr double max_bins = 12;  // along an axis
    every_.resize(all_.size());
    std::iota(every_.begin(), every_.end(), 0u);
    if (all_.size() <= few) return;
    const Vec3 extent = box_.size();
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = static_cast<int>(extent[axis] > 0 ? std::clamp(2 * extent[axis] / reach_, 1.0, max_bins) : 1);
        inverse_edge_[axis] = extent[axis] > 0 ? size_[axis] / extent[axis] : 0;
    }
    // Counted first, then entered.
    const auto for_bins = [&](const NearTriangle& triangle, const auto& visit) {
        Bounds bounds;
        for (const Vec3 corner : triangle.corners) bounds.add(corner);
        // Rounding of a bin's number is far below this part of the reach.
        bounds = enlarged(bounds, reach_ * (1 + 1e-6));
        std::array<int, 3> low{}, high{};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = bin_along(axis, std::clamp(bounds.lower[axis], box_.lower[axis], box_.upper[axis]));
            high[axis] = bin_along(axis, std::clamp(bounds.upper[axis], box_.lower[axis], box_.upper[axis]));
        }
        for (int z = low[2]; z <= high[2]; ++z) {
            for (int y = low[1]; y <= high[1]; ++y) {
                for (int x = low[0]; x <= high[0]; ++x)
                    visit(static_cast<std::size_t>(x + size_[0] * (y + size_[1] * z)));
            }
        }
    };
    first_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]) + 1, 0);
    for (const NearTriangle& triangle : all_) for_bins(triangle, [&](std::size_t bin) { ++first_[bin + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    indices_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t i = 0; i < all_.size(); ++i)
        for_bins(all_[i], [&](std::size_t bin) { indices_[next[bin]++] = i; });
}

std::span<const std::uint32_t> NearTriangles::around(Vec3 p) const {
    if (size_[0] == 0 || !contains(box_, p)) return every_;
    const auto bin =
        static_cast<std::size_t>(bin_along(0, p.x) + size_[0] * (bin_along(1, p.y) + size_[1] * bin_along(2, p.z)));
    return std::span(indices_).subspan(first_[bin], first_[bin + 1] - first_[bin]);
}

std::span<const std::uint32_t> NearTriangles::along(Vec3 a, Vec3 b) const {
    return length(b - a) <= 2 * reach_ ? around(0.5 * (a + b)) : std::span<const std::uint32_t>(every_);
}

}  // namespace embody::physics::fluid
