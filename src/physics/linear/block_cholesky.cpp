// SPDX-License-Identifier: MIT
#include "physics/linear/block_cholesky.h"

#include <algorithm>

namespace embody::physics::linear {

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

void BlockCholesky::factor(const BlockKernels& kernels) {
    if (diagonal_.empty()) return;
    static_assert(sizeof(Vec6) == 6 * sizeof(double));
    kernels.factor({.nodes = pattern_.nodes(),
                    .first = pattern_.first_blocks(),
                    .row = pattern_.rows(),
                    .first_target = pattern_.first_targets(),
                    .target = pattern_.targets(0),
                    .diagonal = diagonal_.front().column[0],
                    .below = blocks_.empty() ? nullptr : blocks_.front().column[0],
                    .inverse_pivots = inverse_pivots_.front().value});
}

void BlockCholesky::solve(std::span<Vec6> x) const {
    // L y = b.
    const std::size_t nodes = diagonal_.size();
    for (std::size_t place = 0; place < nodes; ++place) work_[place] = x[pattern_.node_at(place)];
    for (std::size_t place = 0; place < nodes; ++place) {
        const auto [first, last] = pattern_.column(place);
        double* y = work_[place].value;
        for (int p = 0; p < 5; ++p) {
            // Numbers of L's blocks above the diagonal are not zero: only the rows after p are used.
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

}  // namespace embody::physics::linear
