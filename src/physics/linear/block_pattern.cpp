// SPDX-License-Identifier: MIT
#include "physics/linear/block_pattern.h"

#include <algorithm>
#include <bit>

#include "foundation/assert.h"

namespace embody::physics::linear {

void BlockPattern::analyse(std::size_t nodes, std::span<const Edge> edges, std::size_t multipliers) {
    EMBODY_ASSERT(nodes <= max_nodes);
    find_order(nodes, edges, nodes - multipliers);
    place_blocks(edges);
}

// The node of least degree first; among equals the one whose elimination tree is lowest, so that a chain is eliminated
// from both ends at once and the processor has two independent columns to work on.
void BlockPattern::find_order(std::size_t nodes, std::span<const Edge> edges, std::size_t first_multiplier) {
    const std::size_t words = (nodes + 63) / 64;
    columns_.assign(nodes, {});
    std::vector<Neighbours>& neighbours = columns_;
    const auto mark = [](Neighbours& set, std::size_t node) { set[node / 64] |= std::uint64_t{1} << (node % 64); };
    const auto unmark = [](Neighbours& set, std::size_t node) { set[node / 64] &= ~(std::uint64_t{1} << (node % 64)); };
    for (const auto [p, q] : edges) {
        mark(neighbours[p], q);
        mark(neighbours[q], p);
    }
    const auto degree = [&](const Neighbours& set) {
        int count = 0;
        for (std::size_t word = 0; word < words; ++word) count += std::popcount(set[word]);
        return count;
    };

    constexpr std::uint16_t waiting = 0xFFFF;  // no place yet
    position_.assign(nodes, waiting);
    node_at_.resize(nodes);
    std::vector<std::uint16_t> height(nodes, 0);
    for (std::size_t place = 0; place < nodes; ++place) {
        std::size_t best = nodes;
        std::pair<int, int> best_rank;
        for (std::size_t node = 0; node < nodes; ++node) {
            if (position_[node] != waiting) continue;
            const std::pair<int, int> rank{degree(neighbours[node]), height[node]};
            const bool is_early = node >= first_multiplier && height[node] == 0 && rank.first > 0;
            if (is_early || (best < nodes && !(rank < best_rank))) continue;
            best = node;
            best_rank = rank;
        }
        position_[best] = static_cast<std::uint16_t>(place);
        node_at_[place] = static_cast<std::uint16_t>(best);

        // The neighbours of an eliminated node become each other's neighbours.
        for (std::size_t node = 0; node < nodes; ++node) {
            if (!(neighbours[best][node / 64] >> (node % 64) & 1)) continue;
            for (std::size_t word = 0; word < words; ++word) {
                neighbours[node][word] |= neighbours[best][word];
            }
            unmark(neighbours[node], node);
            unmark(neighbours[node], best);
            height[node] = std::max<std::uint16_t>(height[node], static_cast<std::uint16_t>(height[best] + 1));
        }
    }
}

void BlockPattern::place_blocks(std::span<const Edge> edges) {
    // The neighbours that a node had when it was eliminated are the blocks below its diagonal.
    const std::size_t nodes = position_.size();
    first_.assign(1, 0);
    below_.clear();
    block_at_.resize(nodes * nodes);
    for (std::size_t place = 0; place < nodes; ++place) {
        const Neighbours& column = columns_[node_at_[place]];
        for (std::size_t node = 0; node < nodes; ++node) {
            if (column[node / 64] >> (node % 64) & 1) below_.push_back(position_[node]);
        }
        std::sort(below_.begin() + first_.back(), below_.end());
        for (std::size_t k = first_.back(); k < below_.size(); ++k) {
            block_at_[below_[k] * nodes + place] = static_cast<std::uint32_t>(k);
        }
        first_.push_back(static_cast<std::uint32_t>(below_.size()));
    }

    // Two blocks of a column change the block in the row of one and the column of the other.
    targets_.clear();
    first_target_.clear();
    for (std::size_t place = 0; place < nodes; ++place) {
        first_target_.push_back(static_cast<std::uint32_t>(targets_.size()));
        for (std::size_t k = first_[place]; k < first_[place + 1]; ++k) {
            for (std::size_t i = k + 1; i < first_[place + 1]; ++i) {
                targets_.push_back(block_at_[below_[i] * nodes + below_[k]]);
            }
        }
    }
    edge_block_.clear();
    row_end_.clear();
    for (const auto [p, q] : edges) {
        const std::size_t low = std::min(position_[p], position_[q]), high = std::max(position_[p], position_[q]);
        edge_block_.push_back(block_at_[high * nodes + low]);
        row_end_.push_back(position_[p] == high ? 0 : 1);
    }
}

}  // namespace embody::physics::linear
