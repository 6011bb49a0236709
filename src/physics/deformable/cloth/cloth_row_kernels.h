// SPDX-License-Identifier: MIT
//
// How the equations of a sheet lie in memory, and what an iteration of the conjugate gradient does with them. Only
// numbers here: kernels include this file, and inline code would be merged across instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// Nodes that lie side by side, a lane each: a slice.
inline constexpr std::size_t slice_rows = 16;
/// Floats of a 3 × 3 block for each node of a slice: element (r, c) of lane l is at (3 c + r) slice_rows + l.
inline constexpr std::size_t slice_block = 9 * slice_rows;

/// Elements beside the diagonal. Slot k holds one element of each row of a slice, zero where a row has none there: of
/// slice s the slots from start[s] to start[s + 1]. Those before rest[s] lie on one diagonal, offset[k] columns from
/// each row; of the others `column` names slice_rows columns a slot (what it has for bands is not read).
struct ClothSlots {
    const std::uint32_t *start, *rest;
    const std::int32_t* offset;
    const std::uint32_t* column;
    const float* value;
};

/// A matrix of 3 × 3 blocks over the nodes of a sheet.
struct ClothRows {
    ClothSlots near;   ///< blocks: slice_block floats a slot
    ClothSlots far;    ///< multiples of the identity: slice_rows floats a slot
    const float* own;  ///< the diagonal: slice_block floats a slice
};

/// Vectors over nodes: the first coordinates of all, then the second and third ones, `stride` floats apart; zero in
/// lanes beyond the last node. Pointers to the first element of the sheet that a kernel works on.
struct ClothVectors {
    std::size_t stride;
    float *p, *q, *r, *z, *x;  ///< as in linear/conjugate_gradient.h
    float* quads;              ///< p again, x y z 0 of each node, for slots that name columns
    const float* inverse;      ///< of the preconditioner: slice_block floats a slice
};

/// All work on the slices from `first` to below `last`. `sums`: slice_rows partial sums that are added to. Any width of
/// the processor's registers gives the same bits.
struct ClothRowKernels {
    /// p = z + β p.
    void (*turn)(const ClothVectors& of, float beta, std::size_t first, std::size_t last);
    /// q = matrix p; sums += p · q. Added in order: a row's own element, then near and far
    /// ones slot by slot.
    void (*multiply)(const ClothRows& matrix, const ClothVectors& of, std::size_t first, std::size_t last,
                     double* sums);
    /// x += α p, r −= α q, z = inverse r; sums += z · r.
    void (*advance)(const ClothVectors& of, float alpha, std::size_t first, std::size_t last, double* sums);
    /// sums += z · r.
    void (*dot)(const ClothVectors& of, std::size_t first, std::size_t last, double* sums);

    /// For each width of math/kernel_width.h.
    static const ClothRowKernels lanes_4, lanes_8, lanes_16;
};

}  // namespace embody::physics::deformable
