// SPDX-License-Identifier: MIT
//
// Loops over columns of numbers. Sums are of sixteen partial sums, added in one order, whatever the width.
// Included once by each of column_kernel_4.cpp, _8.cpp and _16.cpp.
#include "math/wide.h"
#include "physics/linear/column_kernels.h"

namespace embody::EMBODY_WIDE {
namespace {

constexpr std::size_t width = lanes, sums = physics::linear::column_multiple, registers = sums / width;

void add_moves(float* moves, const float* compliance, std::size_t stride, float x, float y, float z) {
    const Wide by_x = broadcast(x), by_y = broadcast(y), by_z = broadcast(z);
    for (std::size_t row = 0; row < 3; ++row) {
        float* to = moves + row * stride;
        const float *a = compliance + row * stride, *b = a + 3 * stride, *c = b + 3 * stride;
        for (std::size_t i = 0; i < stride; i += width)
            store(to + i, load(to + i) + (load(a + i) * by_x + load(b + i) * by_y + load(c + i) * by_z));
    }
}

void subtract_columns(float* w, const float* a, const float* b, const float* c, std::size_t count, float x, float y,
                      float z) {
    const Wide by_x = broadcast(x), by_y = broadcast(y), by_z = broadcast(z);
    for (std::size_t i = 0; i < count; i += width)
        store(w + i, load(w + i) - (load(a + i) * by_x + load(b + i) * by_y + load(c + i) * by_z));
}

struct Sum {
    Wide part[registers] = {};
    EMBODY_WIDE_INLINE void add(Sum& to, const float* a, const float* b) {
        for (std::size_t k = 0; k < registers; ++k) to.part[k] += load(a + k * width) * load(b + k * width);
    }
    [[nodiscard]] float total() const {
        float all[sums];
        for (std::size_t k = 0; k < registers; ++k) store(all + k * width, part[k]);
        for (std::size_t half = sums / 2; half > 0; half /= 2) {
            for (std::size_t k = 0; k < half; ++k) all[k] += all[k + half];
        }
        return all[0];
    }
};

void dot_columns(const float* w, const float* a, const float* b, const float* c, std::size_t count, float result[3]) {
    Sum x, y, z;
    for (std::size_t i = 0; i < count; i += sums) {
        Sum::add(x, a + i, w + i);
        Sum::add(y, b + i, w + i);
        Sum::add(z, c + i, w + i);
    }
    result[0] = x.total();
    result[1] = y.total();
    result[2] = z.total();
}

void add_products(const float* a, std::size_t a_stride, const float* b, std::size_t b_stride, Sum sum[9]) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) Sum::add(sum[3 * i + j], a + i * a_stride, b + j * b_stride);
    }
}

void dot_blocks(const float* a, std::size_t a_stride, const float* b, std::size_t b_stride, std::size_t count,
                float result[9]) {
    Sum sum[9];
    std::size_t i = 0;
    for (; i + sums <= count; i += sums) add_products(a + i, a_stride, b + i, b_stride, sum);
    if (i < count) {
        float rest[6 * sums] = {};
        for (std::size_t k = 0; k < 3; ++k) {
            std::memcpy(rest + k * sums, a + k * a_stride + i, (count - i) * sizeof(float));
            std::memcpy(rest + (k + 3) * sums, b + k * b_stride + i, (count - i) * sizeof(float));
        }
        add_products(rest, sums, rest + 3 * sums, sums, sum);
    }
    for (std::size_t k = 0; k < 9; ++k) result[k] = sum[k].total();
}

// Each number loses the products in the order of the columns: the same bits as one column after the other.
template <std::size_t columns>
EMBODY_WIDE_INLINE void subtract_products(double* a, const double* column, std::size_t stride, const double* factor,
                                          std::size_t count) {
    constexpr std::size_t at_once = double_lanes;
    std::size_t i = 0;
    for (; i + at_once <= count; i += at_once) {
        WideDouble to = load(a + i);
        for (std::size_t k = 0; k < columns; ++k) to -= load(column + k * stride + i) * factor[k * stride];
        store(a + i, to);
    }
    for (; i < count; ++i) {
        for (std::size_t k = 0; k < columns; ++k) a[i] -= column[k * stride + i] * factor[k * stride];
    }
}

void subtract_scaled(double* a, const double* column, std::size_t stride, std::size_t columns, const double* factor,
                     std::size_t count) {
    constexpr std::size_t at_once = physics::linear::columns_at_once;
    std::size_t k = 0;
    for (; k + at_once <= columns; k += at_once)
        subtract_products<at_once>(a, column + k * stride, stride, factor + k * stride, count);
    for (; k < columns; ++k) subtract_products<1>(a, column + k * stride, stride, factor + k * stride, count);
}

// Movements of the nodes of a tile by the forces on node j, and of j by the forces on these, as far as `back` collects
// it.
template <bool is_bidirectional>
EMBODY_WIDE_INLINE void add_tile_moves(float* moves, const float* compliance, const float* forces, std::size_t stride,
                                       const Wide by[3], Sum back[3]) {
    for (std::size_t k = 0; k < registers; ++k) {
        const std::size_t at = k * width;
        Wide move[3], force[3];
        for (std::size_t r = 0; r < 3; ++r) {
            move[r] = load(moves + r * stride + at);
            if constexpr (is_bidirectional) force[r] = load(forces + r * stride + at);
        }
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t r = 0; r < 3; ++r) {
                const Wide element = load(compliance + (3 * c + r) * stride + at);
                move[r] += element * by[c];
                if constexpr (is_bidirectional) back[c].part[k] += element * force[r];
            }
        }
        for (std::size_t r = 0; r < 3; ++r) store(moves + r * stride + at, move[r]);
    }
}

void add_all_moves(float* moves, const float* compliance, const float* forces, std::size_t stride,
                   std::size_t first_tile, std::size_t last_tile) {
    for (std::size_t j = first_tile * sums; j < last_tile * sums; ++j) {
        const std::size_t own_tile = j / sums * sums;
        const float* rows = compliance + 9 * j * stride;
        const Wide by[3] = {broadcast(forces[j]), broadcast(forces[stride + j]), broadcast(forces[2 * stride + j])};
        Sum back[3];
        for (std::size_t i = 0; i < own_tile; i += sums)
            add_tile_moves<true>(moves + i, rows + i, forces + i, stride, by, back);
        add_tile_moves<false>(moves + own_tile, rows + own_tile, forces + own_tile, stride, by, back);
        for (std::size_t c = 0; c < 3; ++c) moves[c * stride + j] += back[c].total();
    }
}

constexpr physics::linear::ColumnKernels kernels{add_moves,  subtract_columns, dot_columns,
                                                 dot_blocks, subtract_scaled,  add_all_moves};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const physics::linear::ColumnKernels physics::linear::ColumnKernels::EMBODY_WIDE = EMBODY_WIDE::kernels;
}
