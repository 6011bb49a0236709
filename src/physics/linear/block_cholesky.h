// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "math/kernel_width.h"
#include "physics/linear/block6.h"
#include "physics/linear/block_pattern.h"
#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Factors L D Lᵀ of a sparse symmetric positive definite matrix of 6×6 blocks: one row of blocks a node of a graph,
/// one block an edge. The same bits on every processor.
class BlockCholesky {
public:
    using Edge = BlockPattern::Edge;

    /// Finds the order of elimination and the places of all blocks. Edges may repeat; both ends differ.
    void analyse(std::size_t nodes, std::span<const Edge> edges);
    /// Products of two blocks that a factorisation takes.
    [[nodiscard]] std::size_t block_products() const { return pattern_.block_products(); }

    /// Sets the matrix to zero.
    void clear();
    Block6& diagonal(std::size_t node) { return diagonal_[pattern_.place_of(node)]; }
    /// The block of the edge; its rows belong to `row_end(edge)` of the two ends (0 or 1).
    Block6& off_diagonal(std::size_t edge) { return blocks_[pattern_.block_of(edge)]; }
    [[nodiscard]] int row_end(std::size_t edge) const { return pattern_.row_end(edge); }

    /// Replaces the matrix by its factors. A pivot that rounding made zero or negative is replaced by a huge one: its
    /// unknown then does not move.
    void factor(const BlockKernels& kernels = widest_kernels<BlockKernels>());
    /// Solves for one right side, in place; by node.
    void solve(std::span<Vec6> x) const;

private:
    BlockPattern pattern_;
    std::vector<Block6> diagonal_, blocks_;  // by place and block of the pattern
    std::vector<Vec6> inverse_pivots_;       // by place
    mutable std::vector<Vec6> work_;
};

}  // namespace embody::physics::linear
