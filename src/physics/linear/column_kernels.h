// SPDX-License-Identifier: MIT
//
// Loops over columns of numbers. Only numbers here: kernels include this file, and inline code would be merged
// across instruction sets.
#pragma once

#include <cstddef>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Rows of numbers are filled up with zeros to a multiple of this.
inline constexpr std::size_t column_multiple = 16;

/// So many columns at a time are subtracted fastest.
inline constexpr std::size_t columns_at_once = 6;

/// Any width of the processor's registers gives the same bits.
struct ColumnKernels {
    /// moves += compliance (x, y, z): three rows of moves, and of nine rows, `stride` numbers each, the first three by
    /// x, the next by y, the last by z. `stride` is a multiple of column_multiple.
    void (*add_moves)(float* moves, const float* compliance, std::size_t stride, float x, float y, float z);
    /// w −= a x + b y + c z, `count` numbers, a multiple of column_multiple.
    void (*subtract_columns)(float* w, const float* a, const float* b, const float* c, std::size_t count, float x,
                             float y, float z);
    /// a·w, b·w, c·w, `count` numbers, a multiple of column_multiple.
    void (*dot_columns)(const float* w, const float* a, const float* b, const float* c, std::size_t count,
                        float result[3]);
    /// aᵢ·bⱼ into result[3 i + j], of three columns each, `a_stride` and `b_stride` numbers apart; any `count`.
    void (*dot_blocks)(const float* a, std::size_t a_stride, const float* b, std::size_t b_stride, std::size_t count,
                       float result[9]);
    /// a −= Σ column factor over so many columns, `count` numbers each, any; columns, and their factors, are `stride`
    /// numbers apart.
    void (*subtract_scaled)(double* a, const double* column, std::size_t stride, std::size_t columns,
                            const double* factor, std::size_t count);
    /// moves += W forces, W the symmetric matrix of 3×3 blocks whose rows `compliance` holds as for add_moves, 9 stride
    /// numbers a node. Each block below the diagonal is read once and serves both of its nodes; of the pairs of nodes
    /// those are done whose later one is in a tile (of column_multiple nodes) from `first_tile` to below
    /// `last_tile`.
    void (*add_all_moves)(float* moves, const float* compliance, const float* forces, std::size_t stride,
                          std::size_t first_tile, std::size_t last_tile);

    /// For each width of math/kernel_width.h.
    static const ColumnKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody::physics::linear
