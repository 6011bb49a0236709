// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"

namespace embody::physics {

/// Six numbers of a body: of its linear, then of its angular motion.
struct alignas(16) Vec6 {
    double value[6] = {};
    [[nodiscard]] Vec3 linear() const { return {value[0], value[1], value[2]}; }
    [[nodiscard]] Vec3 angular() const { return {value[3], value[4], value[5]}; }
};
inline Vec6 make_vec6(Vec3 linear, Vec3 angular) {
    return {{linear.x, linear.y, linear.z, angular.x, angular.y, angular.z}};
}

/// 6×6 matrix by columns.
struct alignas(16) Block6 {
    double column[6][6] = {};
};
/// Adds (uu uw; wu ww) to the block.
void add_to(Block6& block, const Mat3& uu, const Mat3& uw, const Mat3& wu, const Mat3& ww);

/// Factors L D Lᵀ of a sparse symmetric positive definite matrix of 6×6 blocks: one row of blocks a node of a graph,
/// one block an edge. The same bits on every processor. Source: A. George, J. Liu, "Computer solution of large sparse
/// positive definite systems", 1981 (least degree).
class BlockCholesky {
public:
    static constexpr std::size_t most_nodes = 128;
    using Edge = std::array<std::uint16_t, 2>;

    /// Finds the order of elimination and the places of all blocks. Edges may repeat; both ends differ.
    void analyse(std::size_t nodes, std::span<const Edge> edges);
    /// Products of two blocks that a factorisation takes.
    [[nodiscard]] std::size_t block_products() const { return targets_.size() + 2 * below_.size() + first_.size(); }

    /// Sets the matrix to zero.
    void clear();
    Block6& diagonal(std::size_t node) { return diagonal_[position_[node]]; }
    /// The block of the edge; its rows belong to `row_end(edge)` of the two ends (0 or 1).
    Block6& off_diagonal(std::size_t edge) { return blocks_[edge_block_[edge]]; }
    [[nodiscard]] int row_end(std::size_t edge) const { return row_end_[edge]; }

    /// Replaces the matrix by its factors. A pivot that rounding made zero or negative is replaced by a huge one: what
    /// it stands for then does not move.
    void factor();
    /// Solves for one right side, in place; by node.
    void solve(std::span<Vec6> x) const;

private:
    void find_order(std::size_t nodes, std::span<const Edge> edges);
    void place_blocks(std::span<const Edge> edges);

    // By position in the order of elimination.
    std::vector<std::uint16_t> node_at_;
    std::vector<std::uint32_t> first_;         // into below_; one more than there are positions
    std::vector<std::uint32_t> first_target_;  // into targets_
    std::vector<std::uint16_t> below_;  // positions of the blocks below the diagonal, column by column, ascending
    // Blocks that the pairs (i, k), i > k, of a column's blocks change.
    std::vector<std::uint32_t> targets_;
    std::vector<Block6> diagonal_, blocks_;
    std::vector<Vec6> inverse_pivots_;

    std::vector<std::uint16_t> position_;    // by node
    std::vector<std::uint32_t> edge_block_;  // by edge
    std::vector<std::uint8_t> row_end_;      // by edge
    mutable std::vector<Vec6> work_;
    std::vector<std::uint32_t> block_at_;  // scratch: by pair of positions
    using Neighbours = std::array<std::uint64_t, most_nodes / 64>;
    std::vector<Neighbours> columns_;  // scratch
};

}  // namespace embody::physics
