// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Directions with which all normals of some triangles have a positive product, a bit each. Triangles of one connected
/// piece with such a common direction nowhere lie over each other along it (P. Volino and N. Magnenat-Thalmann,
/// "Efficient self-collision detection on smoothly discretized surface animations using geometrical shape regularity",
/// 1994; directions as in J. Mezger, S. Kimmerle and O. Etzmuß, "Hierarchical techniques in collision detection for
/// cloth animation", 2003).
using LeanMask = std::uint32_t;
inline constexpr LeanMask all_leans = 0x3FFF;  ///< 14: faces and corners of a cube
/// Of a triangle's normal of any length; none for zero.
LeanMask leans_of(Vec3 normal);

/// Patches of a sheet's triangles in halves, and halves of those, down to a few triangles, to find where it may touch
/// itself: only patches whose boxes overlap are compared, and neighbours only if they are bent enough.
class PatchTree {
public:
    using Triangle = std::array<std::uint32_t, 3>;
    /// `nodes`: how many there are.
    PatchTree(std::span<const Triangle> triangles, std::size_t nodes);

    /// Data of each triangle for the search.
    void update(std::span<const Bounds> boxes, std::span<const LeanMask> leans);
    /// Pairs of leaves that may have triangles that touch, the lower first, also of a leaf with itself; in a fixed
    /// order.
    void find_pairs(std::vector<std::array<std::uint32_t, 2>>& pairs) const;

    [[nodiscard]] std::uint32_t leaves() const { return static_cast<std::uint32_t>(leaf_start_.size()) - 1; }
    [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t leaf) const {
        return std::span(order_).subspan(leaf_start_[leaf], leaf_start_[leaf + 1] - leaf_start_[leaf]);
    }
    [[nodiscard]] std::uint32_t leaf_of(std::uint32_t triangle) const { return leaf_of_[triangle]; }
    [[nodiscard]] const Bounds& box_of(std::uint32_t leaf) const { return boxes_[leaves() - 1 + leaf]; }

private:
    // A full binary tree: patch p has the halves 2 p + 1 and 2 p + 2; all leaves lie equally deep.
    struct Neighbours {
        std::vector<std::uint32_t> start, other;  // of a patch, those of its depth that have common nodes with it,
                                                  // ascending
    };
    void order_halves(std::span<const Triangle> triangles, std::size_t nodes);
    void find_neighbours(std::span<const Triangle> triangles, std::size_t nodes);
    void visit_one(std::uint32_t patch, std::vector<std::array<std::uint32_t, 2>>& pairs) const;
    void visit_two(std::uint32_t a, std::uint32_t b, std::vector<std::array<std::uint32_t, 2>>& pairs) const;
    [[nodiscard]] bool is_leaf(std::uint32_t patch) const { return patch + 1 >= leaves(); }
    [[nodiscard]] bool are_neighbours(std::uint32_t a, std::uint32_t b) const;

    std::vector<std::uint32_t> order_, leaf_start_, leaf_of_;
    std::vector<bool> is_piece_;  // of a patch: small enough, and its triangles are connected
    Neighbours neighbours_;
    // Of the substep, of patches.
    std::vector<Bounds> boxes_;
    std::vector<LeanMask> leans_;
};

}  // namespace embody::physics::deformable
