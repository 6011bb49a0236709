// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/bounding_volume_tree.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// Exact distances to the triangles of a mesh.
class SurfaceDistance {
public:
    explicit SurfaceDistance(const TriangleMesh& mesh);
    /// Distance of `p` to the nearest triangle, if that is at most `limit` (m); else `limit`.
    [[nodiscard]] double at(Vec3 p, double limit) const;
    /// As above without a limit.
    [[nodiscard]] double at(Vec3 p) const;

private:
    std::vector<std::array<Vec3, 3>> triangles_;
    BoundingVolumeTree tree_;
    Bounds box_;
};

/// A place outside of the model, inside its bounds.
struct Void {
    Vec3f center;
    float depth = 0;  ///< m, distance to the surface
};

/// The places around a surface that other bodies can reach, in cubic cells. A cell is filled if a triangle touches it,
/// or if nothing that moves sideways or down gets there from outside. So holes narrower than a cell are closed; a mug
/// is hollow, also one without thickness; a sofa without bottom or a chest that stands on the floor is solid: a hollow
/// that is open only below is filled, unless `open_below`.
class SolidGrid {
public:
    /// About `cells` cells over the bounds, none smaller than `least_cell` (m).
    SolidGrid(const TriangleMesh& mesh, int cells, double least_cell, bool open_below);

    [[nodiscard]] double cell() const { return cell_; }
    /// All places outside that are deeper than `least_depth`, in a fixed order.
    [[nodiscard]] std::vector<Void> voids(double least_depth) const;
    /// Calls visit(Vec3 center, double depth) for each place outside within `box` that is deeper than what `visit`
    /// returned last, beginning with `least_depth`.
    template <class Visit>
    double for_each_deeper(const Bounds& box, double least_depth, Visit visit) const;
    /// Depth of the cell around `p`; 0 where it is filled or far outside.
    [[nodiscard]] double depth_at(Vec3 p) const;
    /// Whether `p` lies in a filled cell.
    [[nodiscard]] bool is_filled(Vec3 p) const;

private:
    using Cell = std::array<int, 3>;
    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(count_[0]) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] Vec3 center(int x, int y, int z) const { return lower_ + cell_ * Vec3{x + 0.5, y + 0.5, z + 0.5}; }
    [[nodiscard]] int clamped(double at, int axis) const;
    void mark(const std::array<Vec3, 3>& triangle);
    void flood(bool open_below);
    void measure_depths(const TriangleMesh& mesh);

    Vec3 lower_;
    double cell_ = 1;
    Cell count_{};
    std::vector<std::uint8_t> touched_;  // by a triangle
    std::vector<float> depth_;           // m; 0: filled
};

template <class Visit>
double SolidGrid::for_each_deeper(const Bounds& box, double least_depth, Visit visit) const {
    double least = least_depth;
    const Vec3 a = (box.lower - lower_) / cell_ - Vec3{0.5, 0.5, 0.5}, b = (box.upper - lower_) / cell_;
    const int x1 = clamped(b.x, 0), y1 = clamped(b.y, 1), z1 = clamped(b.z, 2);
    for (int z = clamped(a.z, 2); z <= z1; ++z) {
        for (int y = clamped(a.y, 1); y <= y1; ++y) {
            for (int x = clamped(a.x, 0); x <= x1; ++x) {
                const double depth = static_cast<double>(depth_[index(x, y, z)]);
                if (depth > least) least = visit(center(x, y, z), depth);
            }
        }
    }
    return least;
}

}  // namespace embody::geometry
