// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "physics/linear/block6.h"
#include "physics/linear/block_pattern.h"
#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Factors L D U of a sparse matrix of 6×6 blocks whose pattern is symmetric, its numbers are not: two blocks an edge.
/// No pivot is looked for: bodies must have a definite diagonal block, and a multiplier's rows must differ. The same
/// bits on every processor.
class BlockLu {
public:
    using Edge = BlockPattern::Edge;

    /// As BlockPattern::analyse().
    void analyse(std::size_t nodes, std::span<const Edge> edges, std::size_t multipliers);

    /// Sets the matrix to zero.
    void clear();
    Block6& diagonal(std::size_t node) { return diagonal_[pattern_.place_of(node)]; }
    /// The two blocks of an edge, the second one transposed: both have the rows of `row_end(edge)` of the two ends.
    Block6& lower(std::size_t edge) { return lower_[pattern_.block_of(edge)]; }
    Block6& upper(std::size_t edge) { return upper_[pattern_.block_of(edge)]; }
    [[nodiscard]] int row_end(std::size_t edge) const { return pattern_.row_end(edge); }

    /// Replaces the matrix by its factors. An unknown without a pivot does not move.
    void factor();
    /// Solves for one right side, in place; by node.
    void solve(std::span<Vec6> x);

private:
    BlockPattern pattern_;
    std::vector<Block6> diagonal_;       // by place; its inverse after factor()
    std::vector<Block6> lower_, upper_;  // by block of the pattern; upper ones transposed
    std::vector<Vec6> work_;
};

}  // namespace embody::physics::linear
