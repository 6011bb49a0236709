// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Boxes of about the same size by the cells of a grid that they reach, cells by a hash (M. Teschner and others,
/// "Optimized spatial hashing for collision detection of deformable objects", 2003).
class BoxGrid {
public:
    /// `usual_size`: of a box, m, > 0. Cells grow with the longest box.
    void fill(std::span<const Bounds> boxes, double usual_size);
    /// Calls visit(std::uint32_t box) for all that overlap `box`, some more than once, and for a few that nearly do.
    template <class Visit>
    void visit(const Bounds& box, Visit visit) const {
        const RoundedBox own = rounded(box);
        // A box that is far larger than the cells: it is tested against all boxes.
        const Cell low = cell_of(box.lower), high = cell_of(box.upper);
        const auto cells = [](int from, int to) { return static_cast<double>(to) - from + 1; };
        if (cells(low.x, high.x) * cells(low.y, high.y) * cells(low.z, high.z) > static_cast<double>(start_.size())) {
            for (std::uint32_t other = 0; other < rounded_.size(); ++other) {
                if (are_near(own, rounded_[other])) visit(other);
            }
            return;
        }
        for_each_bucket(box, [&](std::size_t b) {
            for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) {
                const std::uint32_t other = boxes_[k];
                if (are_near(own, rounded_[other])) visit(other);
            }
        });
    }

private:
    // In floats, rounded outwards: half the memory, and all axes compared at once.
    using Float4 = float __attribute__((vector_size(16)));
    struct RoundedBox {
        Float4 lower{}, upper{};
    };
    [[nodiscard]] static RoundedBox rounded(const Bounds& box) {
        constexpr double fraction = 1e-6;  // of a place: floats round by 6e-8 of it
        const auto down = [](double x) { return static_cast<float>(x - fraction * std::fabs(x)); };
        const auto up = [](double x) { return static_cast<float>(x + fraction * std::fabs(x)); };
        return {Float4{down(box.lower.x), down(box.lower.y), down(box.lower.z), 0},
                Float4{up(box.upper.x), up(box.upper.y), up(box.upper.z), 0}};
    }
    [[nodiscard]] static bool are_near(const RoundedBox& a, const RoundedBox& b) {
        const auto axes = (a.lower <= b.upper) & (b.lower <= a.upper);
        return (axes[0] & axes[1] & axes[2]) != 0;
    }
    struct Cell {
        int x = 0, y = 0, z = 0;
    };
    [[nodiscard]] Cell cell_of(Vec3 p) const {
        constexpr double max_cell = 1e9;  // cells: what an int holds
        const auto index = [&](double x) {
            return static_cast<int>(std::floor(std::max(-max_cell, std::min(max_cell, x / cell_size_))));
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
    std::vector<RoundedBox> rounded_;  // by box
};

}  // namespace embody::physics::deformable
