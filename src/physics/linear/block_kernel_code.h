// SPDX-License-Identifier: MIT
//
// Factors of a symmetric matrix of 6×6 blocks, a column of a block at once: one register of 8 numbers, two of 4 or four
// of 2. Included once by each of block_kernel_4.cpp, _8.cpp and _16.cpp.
#include "math/wide.h"
#include "physics/linear/block_kernels.h"

namespace embody::EMBODY_WIDE {
namespace {

using physics::linear::block_stride;
using physics::linear::BlockFactors;
using physics::linear::column_stride;

constexpr double stuck_pivot = 1e100;  // in the place of a pivot of 0: its row does not move; no other is as large

/// A column of a block.
using Column = double __attribute__((vector_size(column_stride * sizeof(double))));
EMBODY_WIDE_INLINE Column load_column(const double* block, int c) {
    Column column;
    std::memcpy(&column, block + static_cast<std::size_t>(c) * column_stride, sizeof column);
    return column;
}
EMBODY_WIDE_INLINE void store_column(double* block, int c, const Column& column) {
    std::memcpy(block + static_cast<std::size_t>(c) * column_stride, &column, sizeof column);
}
EMBODY_WIDE_INLINE double element(const double* block, int r, int c) {
    return block[static_cast<std::size_t>(c) * column_stride + static_cast<std::size_t>(r)];
}

// The pivot block becomes its L (unit, below the diagonal). A pivot that rounding made zero or negative is replaced by
// a huge one.
void factor_pivot(double* pivot, double* inverse_pivots) {
    for (int p = 0; p < 6; ++p) {
        const double d = element(pivot, p, p) > 0 ? element(pivot, p, p) : stuck_pivot;
        const double inverse = 1 / d;
        inverse_pivots[p] = inverse;
        const Column column = load_column(pivot, p);
        for (int c = p + 1; c < 6; ++c) {
            store_column(pivot, c, load_column(pivot, c) - column * (element(pivot, c, p) * inverse));
        }
        for (int r = p + 1; r < 6; ++r)
            pivot[static_cast<std::size_t>(p) * column_stride + static_cast<std::size_t>(r)] *= inverse;
    }
}

// Multiplies a block below the pivot by L⁻ᵀ.
void solve_block(double* block, const double* pivot) {
    Column columns[6];
    for (int c = 0; c < 6; ++c) columns[c] = load_column(block, c);
    for (int p = 0; p < 6; ++p) {
        for (int c = p + 1; c < 6; ++c) columns[c] -= columns[p] * element(pivot, c, p);
    }
    for (int c = 0; c < 6; ++c) store_column(block, c, columns[c]);
}

EMBODY_WIDE_INLINE void subtract(double* target, const double* rows_block, const double* columns) {
    Column rows[6];
    for (int p = 0; p < 6; ++p) rows[p] = load_column(rows_block, p);
    for (int c = 0; c < 6; ++c) {
        Column sum = load_column(target, c);
        for (int p = 0; p < 6; ++p) sum -= rows[p] * element(columns, c, p);
        store_column(target, c, sum);
    }
}

void factor(const BlockFactors& matrix) {
    const auto below = [&](std::size_t k) { return matrix.below + k * block_stride; };
    for (std::size_t place = 0; place < matrix.nodes; ++place) {
        // The column.
        double *pivot = matrix.diagonal + place * block_stride, *inverse = matrix.inverse_pivots + 6 * place;
        factor_pivot(pivot, inverse);
        const std::size_t first = matrix.first[place], last = matrix.first[place + 1];
        for (std::size_t k = first; k < last; ++k) solve_block(below(k), pivot);

        // The column changes the others: block (i, k) −= Lᵢ D⁻¹ L_kᵀ.
        const std::uint32_t* target = matrix.target + matrix.first_target[place];
        for (std::size_t k = first; k < last; ++k) {
            alignas(64) double scaled[block_stride];
            for (int p = 0; p < 6; ++p) store_column(scaled, p, load_column(below(k), p) * inverse[p]);
            for (std::size_t i = k; i < last; ++i) {
                double* changed = i == k ? matrix.diagonal + matrix.row[k] * block_stride : below(*target++);
                subtract(changed, below(i), scaled);
            }
        }
        for (std::size_t k = first; k < last; ++k) {
            for (int p = 0; p < 6; ++p) store_column(below(k), p, load_column(below(k), p) * inverse[p]);
        }
    }
}

void subtract_product(double* target, const double* rows, const double* columns) { subtract(target, rows, columns); }

constexpr physics::linear::BlockKernels kernels{factor, subtract_product};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const physics::linear::BlockKernels physics::linear::BlockKernels::EMBODY_WIDE = EMBODY_WIDE::kernels;
}
