// SPDX-License-Identifier: MIT
//
// How blocks of 6×6 numbers lie in memory for the direct solvers. Only numbers here: kernels include this file, and
// inline code would be merged across instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Of a block: numbers from one column to the next, of which the first six count and the others are 0, and all.
inline constexpr std::size_t column_stride = 8, block_stride = 6 * column_stride;

/// A matrix to factorise, as BlockCholesky holds it; pieces by place in the order of elimination.
struct BlockFactors {
    std::size_t nodes;
    const std::uint32_t* first;         ///< of a column's blocks; one more than there are nodes
    const std::uint16_t* row;           ///< place of a block's row
    const std::uint32_t* first_target;  ///< of a column's pairs of blocks, into `target`
    const std::uint32_t* target;        ///< block that the pair changes
    double* diagonal;                   ///< blocks
    double* below;                      ///< blocks
    double* inverse_pivots;             ///< six a place
};

/// Any width of the processor's registers gives the same bits.
struct BlockKernels {
    /// Replaces the matrix by its factors L D Lᵀ.
    void (*factor)(const BlockFactors& matrix);
    /// target −= rows columnsᵀ, of blocks.
    void (*subtract_product)(double* target, const double* rows, const double* columns);

    /// For each width of math/kernel_width.h.
    static const BlockKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody::physics::linear
