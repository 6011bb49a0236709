// SPDX-License-Identifier: MIT
#include "physics/linear/block_lu.h"

#include <algorithm>
#include <cmath>

#include "math/kernel_width.h"

namespace embody::physics::linear {

namespace {

constexpr double stuck_pivot = 1e100;  // in the place of a pivot of 0: its row does not move; no other is as large

// Gauss-Jordan elimination, in place.
void invert(Block6& matrix) {
    auto& m = matrix.column;
    for (int p = 0; p < 6; ++p) {
        // The pivot's column becomes the factors; they are eliminated from the other columns.
        const double inverse = m[p][p] != 0 ? 1 / m[p][p] : 1 / stuck_pivot;
        m[p][p] = 0;
        const Column6 factors = Column6::of(m[p]);
        for (int c = 0; c < 6; ++c) {
            if (c == p) continue;
            const double fraction = m[c][p] * inverse;
            Column6 column = Column6::of(m[c]);
            column.subtract(factors, fraction);
            column.put(m[c]);
            m[c][p] = fraction;
        }
        Column6 column{};
        column.subtract(factors, inverse);
        column.put(m[p]);
        m[p][p] = inverse;
    }
}

// product = a b
Block6 product(const Block6& a, const Block6& b) {
    Block6 result;
    for (int c = 0; c < 6; ++c) {
        Column6 sum{};
        for (int p = 0; p < 6; ++p) sum.subtract(Column6::of(a.column[p]), -b.column[c][p]);
        sum.put(result.column[c]);
    }
    return result;
}

}  // namespace

void BlockLu::analyse(std::size_t nodes, std::span<const Edge> edges, std::size_t multipliers) {
    pattern_.analyse(nodes, edges, multipliers);
    diagonal_.resize(nodes);
    lower_.resize(pattern_.blocks());
    upper_.resize(pattern_.blocks());
    work_.resize(nodes);
}

void BlockLu::clear() {
    for (std::vector<Block6>* blocks : {&diagonal_, &lower_, &upper_}) {
        std::fill(blocks->begin(), blocks->end(), Block6{});
    }
}

void BlockLu::factor() {
    const auto subtract_product = [kernel = widest_kernels<BlockKernels>().subtract_product](
                                      Block6& target, const Block6& rows, const Block6& columns) {
        kernel(target.column[0], rows.column[0], columns.column[0]);
    };
    for (std::size_t place = 0; place < diagonal_.size(); ++place) {
        invert(diagonal_[place]);
        const auto [first, last] = pattern_.column(place);
        for (std::size_t k = first; k < last; ++k) {
            lower_[k] = product(lower_[k], diagonal_[place]);
            subtract_product(diagonal_[pattern_.row_of(k)], lower_[k], upper_[k]);
        }
        const std::uint32_t* target = pattern_.targets(place);
        for (std::size_t k = first; k < last; ++k) {
            for (std::size_t i = k + 1; i < last; ++i, ++target) {
                subtract_product(lower_[*target], lower_[i], upper_[k]);
                subtract_product(upper_[*target], upper_[i], lower_[k]);
            }
        }
    }
}

void BlockLu::solve(std::span<Vec6> x) {
    // L y = b.
    const std::size_t nodes = diagonal_.size();
    for (std::size_t place = 0; place < nodes; ++place) work_[place] = x[pattern_.node_at(place)];
    for (std::size_t place = 0; place < nodes; ++place) {
        const auto [first, last] = pattern_.column(place);
        for (std::size_t k = first; k < last; ++k) {
            double* other = work_[pattern_.row_of(k)].value;
            Column6 rest = Column6::of(other);
            for (int p = 0; p < 6; ++p) rest.subtract(Column6::of(lower_[k].column[p]), work_[place].value[p]);
            rest.put(other);
        }
    }

    // D U x = y.
    for (std::size_t place = nodes; place-- > 0;) {
        const auto [first, last] = pattern_.column(place);
        double* y = work_[place].value;
        for (std::size_t k = first; k < last; ++k) {
            const Column6 other = Column6::of(work_[pattern_.row_of(k)].value);
            for (int p = 0; p < 6; ++p) y[p] -= dot(Column6::of(upper_[k].column[p]), other);
        }
        Column6 solution{};
        for (int p = 0; p < 6; ++p) solution.subtract(Column6::of(diagonal_[place].column[p]), -y[p]);
        solution.put(y);
    }
    for (std::size_t place = 0; place < nodes; ++place) x[pattern_.node_at(place)] = work_[place];
}

}  // namespace embody::physics::linear
