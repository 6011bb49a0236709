// SPDX-License-Identifier: MIT
#include "physics/constraint/block_cholesky.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "foundation/assert.h"

namespace embody::physics {

namespace {

constexpr double stuck_pivot = 1e100;

// Two numbers at once; every processor that Embody runs on can do that.
using Pair = double __attribute__((vector_size(16)));

inline Pair load(const double* from) {
    Pair pair;
    std::memcpy(&pair, from, sizeof pair);
    return pair;
}
inline void store(double* to, Pair pair) { std::memcpy(to, &pair, sizeof pair); }

/// One column of a block in registers.
struct Column {
    Pair a, b, c;
    static Column of(const double* from) { return {load(from), load(from + 2), load(from + 4)}; }
    void put(double* to) const {
        store(to, a);
        store(to + 2, b);
        store(to + 4, c);
    }
    void subtract(const Column& other, double factor) {
        const Pair f{factor, factor};
        a -= other.a * f;
        b -= other.b * f;
        c -= other.c * f;
    }
};

// The pivot block becomes its L (unit, below the diagonal); the blocks below become theirs.
void factor_column(Block6& pivot, Vec6& inverse_pivots, std::span<Block6> below) {
    for (int p = 0; p < 6; ++p) {
        double d = pivot.column[p][p];
        if (!(d > 0)) d = stuck_pivot;
        const double inverse = 1 / d;
        inverse_pivots.value[p] = inverse;
        const Column column = Column::of(pivot.column[p]);
        for (int c = p + 1; c < 6; ++c) {
            Column next = Column::of(pivot.column[c]);
            next.subtract(column, pivot.column[p][c] * inverse);
            next.put(pivot.column[c]);
        }
        for (int r = p + 1; r < 6; ++r) pivot.column[p][r] *= inverse;
    }
    for (Block6& block : below) {
        Column columns[6];
        for (int c = 0; c < 6; ++c) columns[c] = Column::of(block.column[c]);
        for (int p = 0; p < 6; ++p) {
            for (int c = p + 1; c < 6; ++c) columns[c].subtract(columns[p], pivot.column[p][c]);
        }
        for (int c = 0; c < 6; ++c) columns[c].put(block.column[c]);
    }
}

// target −= rows D⁻¹ columnsᵀ, where both still hold L D.
void subtract_product(Block6& target, const Block6& rows, const double scaled[6][6]) {
    for (int c = 0; c < 6; ++c) {
        Column sum = Column::of(target.column[c]);
        for (int p = 0; p < 6; ++p) sum.subtract(Column::of(rows.column[p]), scaled[p][c]);
        sum.put(target.column[c]);
    }
}

}  // namespace

void add_to(Block6& block, const Mat3& uu, const Mat3& uw, const Mat3& wu, const Mat3& ww) {
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            block.column[c][r] += uu.column(c)[r];
            block.column[c][r + 3] += wu.column(c)[r];
            block.column[c + 3][r] += uw.column(c)[r];
            block.column[c + 3][r + 3] += ww.column(c)[r];
        }
    }
}

void BlockCholesky::analyse(std::size_t nodes, std::span<const Edge> edges) {
    EMBODY_ASSERT(nodes <= most_nodes);
    find_order(nodes, edges);
    place_blocks(edges);
}

// Least degree first; among equals the one whose elimination tree is lowest, so that a chain goes from both ends at
// once and the processor has two independent columns to work on.
void BlockCholesky::find_order(std::size_t nodes, std::span<const Edge> edges) {
    columns_.assign(nodes, {});
    std::vector<Neighbours>& neighbours = columns_;
    const auto mark = [](Neighbours& set, std::size_t node) { set[node / 64] |= std::uint64_t{1} << (node % 64); };
    const auto unmark = [](Neighbours& set, std::size_t node) { set[node / 64] &= ~(std::uint64_t{1} << (node % 64)); };
    for (const auto [p, q] : edges) {
        mark(neighbours[p], q);
        mark(neighbours[q], p);
    }
    const auto degree = [](const Neighbours& set) {
        int count = 0;
        for (const std::uint64_t word : set) count += std::popcount(word);
        return count;
    };

    constexpr std::uint16_t waiting = 0xFFFF;
    position_.assign(nodes, waiting);
    node_at_.resize(nodes);
    std::vector<std::uint16_t> height(nodes, 0);
    for (std::size_t place = 0; place < nodes; ++place) {
        std::size_t best = nodes;
        std::pair<int, int> best_rank;
        for (std::size_t node = 0; node < nodes; ++node) {
            if (position_[node] != waiting) continue;
            const std::pair<int, int> rank{degree(neighbours[node]), height[node]};
            if (best < nodes && !(rank < best_rank)) continue;
            best = node;
            best_rank = rank;
        }
        position_[best] = static_cast<std::uint16_t>(place);
        node_at_[place] = static_cast<std::uint16_t>(best);

        // Its neighbours become each other's.
        for (std::size_t node = 0; node < nodes; ++node) {
            if (!(neighbours[best][node / 64] >> (node % 64) & 1)) continue;
            for (std::size_t word = 0; word < neighbours[node].size(); ++word) {
                neighbours[node][word] |= neighbours[best][word];
            }
            unmark(neighbours[node], node);
            unmark(neighbours[node], best);
            height[node] = std::max<std::uint16_t>(height[node], static_cast<std::uint16_t>(height[best] + 1));
        }
    }
}

void BlockCholesky::place_blocks(std::span<const Edge> edges) {
    // What a node's column had when it was eliminated lies below its diagonal.
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

    // Two blocks of a column change the block in the row of the one and the column of the other.
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
    diagonal_.resize(nodes);
    blocks_.resize(below_.size());
    inverse_pivots_.resize(nodes);
    work_.resize(nodes);
}

void BlockCholesky::clear() {
    std::fill(diagonal_.begin(), diagonal_.end(), Block6{});
    std::fill(blocks_.begin(), blocks_.end(), Block6{});
}

void BlockCholesky::factor() {
    for (std::size_t place = 0; place < diagonal_.size(); ++place) {
        const std::size_t first = first_[place], last = first_[place + 1];
        const double* inverse = inverse_pivots_[place].value;
        factor_column(diagonal_[place], inverse_pivots_[place], std::span(blocks_).subspan(first, last - first));
        const std::uint32_t* target = targets_.data() + first_target_[place];
        for (std::size_t k = first; k < last; ++k) {
            double scaled[6][6];
            for (int p = 0; p < 6; ++p) {
                for (int c = 0; c < 6; ++c) scaled[p][c] = blocks_[k].column[p][c] * inverse[p];
            }
            subtract_product(diagonal_[below_[k]], blocks_[k], scaled);
            for (std::size_t i = k + 1; i < last; ++i) subtract_product(blocks_[*target++], blocks_[i], scaled);
        }
        for (std::size_t k = first; k < last; ++k) {
            for (int p = 0; p < 6; ++p) {
                for (int c = 0; c < 6; ++c) blocks_[k].column[p][c] *= inverse[p];
            }
        }
    }
}

void BlockCholesky::solve(std::span<Vec6> x) const {
    // L y = b.
    const std::size_t nodes = diagonal_.size();
    for (std::size_t place = 0; place < nodes; ++place) work_[place] = x[node_at_[place]];
    for (std::size_t place = 0; place < nodes; ++place) {
        double* y = work_[place].value;
        for (int p = 0; p < 5; ++p) {
            // The part of L above its diagonal is not zero: only what comes after p is taken.
            for (int r = p + 1; r < 6; ++r) y[r] -= diagonal_[place].column[p][r] * y[p];
        }
        for (std::size_t k = first_[place]; k < first_[place + 1]; ++k) {
            double* other = work_[below_[k]].value;
            Column rest = Column::of(other);
            for (int p = 0; p < 6; ++p) rest.subtract(Column::of(blocks_[k].column[p]), y[p]);
            rest.put(other);
        }
    }

    // D Lᵀ x = y.
    for (std::size_t place = nodes; place-- > 0;) {
        double* y = work_[place].value;
        for (int p = 0; p < 6; ++p) y[p] *= inverse_pivots_[place].value[p];
        for (std::size_t k = first_[place]; k < first_[place + 1]; ++k) {
            const Column other = Column::of(work_[below_[k]].value);
            for (int p = 0; p < 6; ++p) {
                const Column column = Column::of(blocks_[k].column[p]);
                const Pair sum = column.a * other.a + column.b * other.b + column.c * other.c;
                y[p] -= sum[0] + sum[1];
            }
        }
        for (int p = 4; p >= 0; --p) {
            for (int r = p + 1; r < 6; ++r) y[p] -= diagonal_[place].column[p][r] * y[r];
        }
    }
    for (std::size_t place = 0; place < nodes; ++place) x[node_at_[place]] = work_[place];
}

}  // namespace embody::physics
