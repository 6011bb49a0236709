// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "math/bounds.h"
#include "physics/inter/definitions/shape_definition.h"

namespace embody::physics {

/// The triangles of a mesh or a heightfield with their neighbours, and a way to find those near a box or a ray.
class TriangleSurface {
public:
    static constexpr std::uint32_t no_neighbour = 0xFFFFFFFFu;

    explicit TriangleSurface(const MeshShape& mesh);
    /// Triangle index = 2 * cell + half; cell = r * (columns - 1) + c; half 0 holds the corner (c, r+1).
    explicit TriangleSurface(const HeightfieldShape& field);
    ~TriangleSurface();

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(triangles_.size()); }
    [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const;
    /// Unit; zero for a triangle without area.
    [[nodiscard]] Vec3 normal(std::uint32_t triangle) const;
    /// Across the edge from corner `edge` to the next one.
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t triangle, int edge) const {
        return neighbours_[triangle][static_cast<std::size_t>(edge)];
    }

    /// Appends the triangles whose bounds meet the box, ascending.
    void find(const Bounds& box, std::vector<std::uint32_t>& found) const;
    /// Calls `visit` for triangles the ray may meet; it returns the new maximal distance.
    void find_along_ray(Vec3 origin, Vec3 direction, double max_distance,
                        const std::function<double(std::uint32_t, double)>& visit) const;

private:
    struct Tree;
    void link_neighbours();

    std::vector<Vec3> positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<std::array<std::uint32_t, 3>> neighbours_;
    Bounds bounds_;
    std::unique_ptr<Tree> tree_;  ///< meshes only: a heightfield finds its cells by division
    int columns_ = 0, rows_ = 0;
    double cell_x_ = 1, cell_z_ = 1;
};

}  // namespace embody::physics
