// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// The order in which the nodes of a graph are eliminated from a sparse matrix, one row of blocks a node and one block
/// an edge, and the blocks that the elimination needs. Source: A. George, J. Liu, "Computer solution of large sparse
/// positive definite systems", 1981 (least degree).
class BlockPattern {
public:
    static constexpr std::size_t max_nodes =
        512;  ///< a set of neighbours has a bit for each, the scratch a number for each pair
    using Edge = std::array<std::uint16_t, 2>;

    /// Edges may repeat; both ends differ. The last `multipliers` of the nodes have (nearly) no diagonal of their own:
    /// none of them is eliminated before one of its neighbours.
    void analyse(std::size_t nodes, std::span<const Edge> edges, std::size_t multipliers = 0);
    [[nodiscard]] std::size_t nodes() const { return node_at_.size(); }
    [[nodiscard]] std::size_t blocks() const { return below_.size(); }
    /// Products of two blocks that a symmetric factorisation takes.
    [[nodiscard]] std::size_t block_products() const { return targets_.size() + 2 * below_.size() + first_.size(); }

    /// Place of a node in the order, and the other way round.
    [[nodiscard]] std::size_t place_of(std::size_t node) const { return position_[node]; }
    [[nodiscard]] std::size_t node_at(std::size_t place) const { return node_at_[place]; }
    /// The blocks below the diagonal in the column of a place: numbers from the first to one before the last.
    [[nodiscard]] std::pair<std::size_t, std::size_t> column(std::size_t place) const {
        return {first_[place], first_[place + 1]};
    }
    /// Place of the row that a block lies in.
    [[nodiscard]] std::size_t row_of(std::size_t block) const { return below_[block]; }
    /// Blocks that the pairs (i, k), i > k, of a column's blocks change: for each k in order, by ascending i.
    [[nodiscard]] const std::uint32_t* targets(std::size_t place) const {
        return targets_.data() + first_target_[place];
    }
    /// The lists behind these functions: by place, by block, by place.
    [[nodiscard]] const std::uint32_t* first_blocks() const { return first_.data(); }
    [[nodiscard]] const std::uint16_t* rows() const { return below_.data(); }
    [[nodiscard]] const std::uint32_t* first_targets() const { return first_target_.data(); }
    /// The block of an edge; its rows belong to `row_end(edge)` of the two ends (0 or 1).
    [[nodiscard]] std::size_t block_of(std::size_t edge) const { return edge_block_[edge]; }
    [[nodiscard]] int row_end(std::size_t edge) const { return row_end_[edge]; }

private:
    void find_order(std::size_t nodes, std::span<const Edge> edges, std::size_t first_multiplier);
    void place_blocks(std::span<const Edge> edges);

    // By position in the order of elimination.
    std::vector<std::uint16_t> node_at_;
    std::vector<std::uint32_t> first_;         // into below_; one more than there are positions
    std::vector<std::uint32_t> first_target_;  // into targets_
    std::vector<std::uint16_t> below_;         // positions, column by column, ascending
    std::vector<std::uint32_t> targets_;

    std::vector<std::uint16_t> position_;    // by node
    std::vector<std::uint32_t> edge_block_;  // by edge
    std::vector<std::uint8_t> row_end_;      // by edge
    std::vector<std::uint32_t> block_at_;    // scratch: by pair of positions
    using Neighbours = std::array<std::uint64_t, max_nodes / 64>;
    std::vector<Neighbours> columns_;  // scratch
};

}  // namespace embody::physics::linear
