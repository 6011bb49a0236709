// SPDX-License-Identifier: MIT
#include "physics/constraint/block_cholesky.h"

#include <algorithm>

namespace embody::physics {

namespace {

constexpr double stuck_pivot = 1e100;

// The pivot block becomes its L (unit, below the diagonal); the blocks below become theirs.
void factor_column(Block6& pivot, Vec6& inverse_pivots, std::span<Block6> below) {
    for (int p = 0; p < 6; ++p) {
        double d = pivot.column[p][p];
        if (!(d > 0)) d = stuck_pivot;
        const double inverse = 1 / d;
        inverse_pivots.value[p] = inverse;
        const Column6 column = Column6::of(pivot.column[p]);
        for (int c = p + 1; c < 6; ++c) {
            Column6 next = Column6::of(pivot.column[c]);
            next.subtract(column, pivot.column[p][c] * inverse);
            next.put(pivot.column[c]);
        }
        for (int r = p + 1; r < 6; ++r) pivot.column[p][r] *= inverse;
    }
    for (Block6& block : below) {
        Column6 columns[6];
        for (int c = 0; c < 6; ++c) columns[c] = Column6::of(block.column[c]);
        for (int p = 0; p < 6; ++p) {
            for (int c = p + 1; c < 6; ++c) columns[c].subtract(columns[p], pivot.column[p][c]);
        }
        for (int c = 0; c < 6; ++c) columns[c].put(block.column[c]);
    }
}

}  // namespace

void BlockCholesky::analyse(std::size_t nodes, std::span<const Edge> edges) {
    pattern_.analyse(nodes, edges);
    diagonal_.resize(nodes);
    blocks_.resize(pattern_.blocks());
    inverse_pivots_.resize(nodes);
    work_.resize(nodes);
}

void BlockCholesky::clear() {
    std::fill(diagonal_.begin(), diagonal_.end(), Block6{});
    std::fill(blocks_.begin(), blocks_.end(), Block6{});
}

void BlockCholesky::factor() {
    for (std::size_t place = 0; place < diagonal_.size(); ++place) {
        const auto [first, last] = pattern_.column(place);
        const double* inverse = inverse_pivots_[place].value;
        factor_column(diagonal_[place], inverse_pivots_[place], std::span(blocks_).subspan(first, last - first));
        const std::uint32_t* target = pattern_.targets(place);
        for (std::size_t k = first; k < last; ++k) {
            Block6 scaled;
            for (int p = 0; p < 6; ++p) {
                for (int c = 0; c < 6; ++c) scaled.column[p][c] = blocks_[k].column[p][c] * inverse[p];
            }
            subtract_product(diagonal_[pattern_.row_of(k)], blocks_[k], scaled);
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
    for (std::size_t place = 0; place < nodes; ++place) work_[place] = x[pattern_.node_at(place)];
    for (std::size_t place = 0; place < nodes; ++place) {
        const auto [first, last] = pattern_.column(place);
        double* y = work_[place].value;
        for (int p = 0; p < 5; ++p) {
            // The part of L above its diagonal is not zero: only what comes after p is taken.
            for (int r = p + 1; r < 6; ++r) y[r] -= diagonal_[place].column[p][r] * y[p];
        }
        for (std::size_t k = first; k < last; ++k) {
            double* other = work_[pattern_.row_of(k)].value;
            Column6 rest = Column6::of(other);
            for (int p = 0; p < 6; ++p) rest.subtract(Column6::of(blocks_[k].column[p]), y[p]);
            rest.put(other);
        }
    }

    // D Lᵀ x = y.
    for (std::size_t place = nodes; place-- > 0;) {
        const auto [first, last] = pattern_.column(place);
        double* y = work_[place].value;
        for (int p = 0; p < 6; ++p) y[p] *= inverse_pivots_[place].value[p];
        for (std::size_t k = first; k < last; ++k) {
            const Column6 other = Column6::of(work_[pattern_.row_of(k)].value);
            for (int p = 0; p < 6; ++p) {
                y[p] -= dot(Column6::of(blocks_[k].column[p]), other);
            }
        }
        for (int p = 4; p >= 0; --p) {
            for (int r = p + 1; r < 6; ++r) y[p] -= diagonal_[place].column[p][r] * y[r];
        }
    }
    for (std::size_t place = 0; place < nodes; ++place) x[pattern_.node_at(place)] = work_[place];
}

}  // namespace embody::physics
