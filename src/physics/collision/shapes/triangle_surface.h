// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "math/bounds.h"
#include "physics/collision/namespace.h"
#include "physics/definitions/shape_definition.h"

namespace embody::physics::collision {

/// The triangles of a mesh or a heightfield, their dihedral angles, and a search for those at a box or a ray.
/// A heightfield keeps its samples only: corners follow from a triangle's number.
class TriangleSurface {
public:
    explicit TriangleSurface(const MeshShape& mesh);
    /// Triangle index = 2 * cell + half; cell = r * (columns - 1) + c; half 0 holds the corner (c, r+1).
    explicit TriangleSurface(const HeightfieldShape& field);
    ~TriangleSurface();

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(half_dihedrals_.size()); }
    [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const {
        if (!tree_) return corners_in_field(triangle);
        const auto& t = triangles_[triangle];
        return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
    }
    /// Unit normal; zero for a triangle without area.
    [[nodiscard]] Vec3 normal(std::uint32_t triangle) const;
    /// For the edges from each corner to the next one: the tangent of half the angle by which the surface bends
    /// away there, negative where it bends towards the front (concave), infinite where it ends.
    [[nodiscard]] const std::array<float, 3>& signed_half_dihedrals(std::uint32_t triangle) const {
        return half_dihedrals_[triangle];
    }
    /// As above, but 0 where it is flat (within flat_sine) or concave.
    [[nodiscard]] std::array<float, 3> half_dihedrals(std::uint32_t triangle) const {
        const auto& dihedrals = half_dihedrals_[triangle];
        const auto away = [](float half) { return half > flat_half_dihedral ? half : 0; };
        return {away(dihedrals[0]), away(dihedrals[1]), away(dihedrals[2])};
    }
    /// Size of all that is kept, bytes.
    [[nodiscard]] std::size_t memory_bytes() const;

    /// Appends the triangles whose bounds meet the box, any two in the same order whatever the box.
    void find(const Bounds& box, std::vector<std::uint32_t>& found) const;
    /// Calls `visit` for triangles the ray may meet; it returns the new maximal distance.
    void find_along_ray(Vec3 origin, Vec3 direction, double max_distance,
                        const std::function<double(std::uint32_t, double)>& visit) const;

private:
    struct Tree;
    static constexpr std::uint32_t no_neighbour = 0xFFFFFFFFu;
    static constexpr float flat_half_dihedral = 0.5e-3F;  // tangent of half an angle whose sine is flat_sine
    using Neighbours = std::array<std::uint32_t, 3>;
    [[nodiscard]] std::vector<Neighbours> find_neighbours() const;
    [[nodiscard]] Neighbours neighbours_in_field(std::uint32_t triangle) const;
    void measure_dihedrals(std::uint32_t triangle, const Neighbours& neighbours);
    [[nodiscard]] std::uint32_t sample(int column, int row) const {
        return static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) +
               static_cast<std::uint32_t>(column);
    }
    [[nodiscard]] std::array<Vec3, 3> corners_in_field(std::uint32_t triangle) const;
    void find_in_field(const Bounds& box, std::vector<std::uint32_t>& found) const;

    // Only of a mesh.
    std::vector<Vec3f> positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::unique_ptr<Tree> tree_;
    // Only of a heightfield, which finds its cells by division.
    std::vector<float> heights_;
    int columns_ = 0, rows_ = 0;
    double cell_x_ = 1, cell_z_ = 1;
    // Of both kinds.
    std::vector<std::array<float, 3>> half_dihedrals_;
    Bounds bounds_;
};

}  // namespace embody::physics::collision
