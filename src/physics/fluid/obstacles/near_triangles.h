// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// A triangle of an obstacle, m; unit normal.
struct NearTriangle {
    std::array<Vec3, 3> corners;
    Vec3 normal;
};

/// Triangles within some reach of a box, by bins of the box: few of them are near any one point.
class NearTriangles {
public:
    /// Forgets all of them; those that are added next are asked about from points of this box, up to `reach` away (m).
    void begin(const Bounds& box, double reach);
    void add(const NearTriangle& triangle) { all_.push_back(triangle); }
    /// After the last one: sorts them into bins.
    void finish();

    [[nodiscard]] bool empty() const { return all_.empty(); }
    [[nodiscard]] const NearTriangle& operator[](std::uint32_t index) const { return all_[index]; }
    /// At least those within the reach of p, in the order in which they were added; all for a point outside of the box.
    [[nodiscard]] std::span<const std::uint32_t> around(Vec3 p) const;
    /// At least those that the way from a to b meets, likewise.
    [[nodiscard]] std::span<const std::uint32_t> along(Vec3 a, Vec3 b) const;

private:
    [[nodiscard]] int bin_along(int axis, double place) const;

    std::vector<NearTriangle> all_;
    Bounds box_;
    double reach_ = 0;
    std::array<int, 3> size_{};  // in bins; 0: none are made
    Vec3 inverse_edge_;          // of a bin, 1/m
    std::vector<std::uint32_t> first_, indices_, every_;
};

}  // namespace embody::physics::fluid
