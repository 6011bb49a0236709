// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"

namespace embody::physics {

/// Boxes of things of about the same size by the cells of a grid that they reach, cells by a hash (M. Teschner and
/// others, "Optimized spatial hashing for collision detection of deformable objects", 2003).
class BoxGrid {
public:
    /// `usual_size`: of a box, m, > 0. Cells grow with the longest box.
    void fill(std::span<const Bounds> boxes, double usual_size);
    /// Calls visit(std::uint32_t box) for all that may overlap `box`, some more than once, and for others.
    template <class Visit>
    void visit(const Bounds& box, Visit visit) const {
        for_each_bucket(box, [&](std::size_t b) {
            for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) visit(boxes_[k]);
        });
    }

private:
    struct Cell {
        int x = 0, y = 0, z = 0;
    };
    [[nodiscard]] Cell cell_of(Vec3 p) const {
        constexpr double farthest = 1e9;
        const auto index = [&](double x) {
            return static_cast<int>(std::floor(std::max(-farthest, std::min(farthest, x / cell_size_))));
        };
        return {index(p.x), index(p.y), index(p.z)};
    }
    [[nodiscard]] static std::size_t bucket_of(int x, int y, int z, std::size_t buckets) {
        const auto part = [](int value, std::uint32_t factor) { return static_cast<std::uint32_t>(value) * factor; };
        return (part(x, 73856093u) ^ part(y, 19349663u) ^ part(z, 83492791u)) & (buckets - 1);
    }
    template <class Visit>
    void for_each_bucket(const Bounds& box, Visit visit) const {
        const Cell low = cell_of(box.lower), high = cell_of(box.upper);
        for (int z = low.z; z <= high.z; ++z) {
            for (int y = low.y; y <= high.y; ++y) {
                for (int x = low.x; x <= high.x; ++x) visit(bucket_of(x, y, z, start_.size() - 1));
            }
        }
    }

    double cell_size_ = 1;  // m
    std::vector<std::uint32_t> start_ = {0, 0}, boxes_;
    std::vector<std::uint32_t> next_;
};

}  // namespace embody::physics
