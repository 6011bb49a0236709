// SPDX-License-Identifier: MIT
//
// The conjugate gradient for the nodes of a sheet, a node a lane. Included once by each of cloth_row_kernel_4.cpp,
// _8.cpp and _16.cpp.
#include "math/wide.h"
#include "physics/deformable/cloth/cloth_row_kernels.h"

namespace embody::EMBODY_WIDE {
namespace {

using physics::deformable::ClothRows;
using physics::deformable::ClothSlots;
using physics::deformable::ClothVectors;
using physics::deformable::slice_block;
using physics::deformable::slice_rows;

constexpr std::size_t width = lanes;
using Doubles = double __attribute__((vector_size(8 * EMBODY_LANES)));

EMBODY_WIDE_INLINE Wide3 load_planes(const float* from, std::size_t stride) {
    return {load(from), load(from + stride), load(from + 2 * stride)};
}
EMBODY_WIDE_INLINE void store_planes(float* to, std::size_t stride, const Wide3& v) {
    store(to, v.x);
    store(to + stride, v.y);
    store(to + 2 * stride, v.z);
}

// Each lane has a sum of its own, so that the width does not change the order.
EMBODY_WIDE_INLINE void add_products(const Wide3& a, const Wide3& b, double* sums) {
    Doubles sum;
    std::memcpy(&sum, sums, sizeof sum);
    sum += __builtin_convertvector(dot(a, b), Doubles);
    std::memcpy(sums, &sum, sizeof sum);
}

// The block of each lane times v.
EMBODY_WIDE_INLINE Wide3 block_times(const float* block, const Wide3& v) {
    const auto element = [&](std::size_t r, std::size_t c) { return load(block + (3 * c + r) * slice_rows); };
    return {element(0, 0) * v.x + element(0, 1) * v.y + element(0, 2) * v.z,
            element(1, 0) * v.x + element(1, 1) * v.y + element(1, 2) * v.z,
            element(2, 0) * v.x + element(2, 1) * v.y + element(2, 2) * v.z};
}

// Calls term(slot, p at its columns) for all slots of the slice; the lanes begin at `row`.
template <class Term>
EMBODY_WIDE_INLINE void visit_slots(const ClothSlots& slots, const ClothVectors& of, std::size_t slice, std::size_t row,
                                    const Term& term) {
    const std::size_t rest = slots.rest[slice], last = slots.start[slice + 1];
    for (std::size_t k = slots.start[slice]; k < rest; ++k)
        term(k, load_planes(of.p + static_cast<std::ptrdiff_t>(row) + slots.offset[k], of.stride));
    for (std::size_t k = rest; k < last; ++k)
        term(k, gather_quads(of.quads, slots.column + k * slice_rows + row % slice_rows));
}

void turn(const ClothVectors& of, float beta, std::size_t first, std::size_t last) {
    const Wide by = broadcast(beta);
    for (std::size_t row = first * slice_rows; row < last * slice_rows; row += width) {
        const Wide3 p = load_planes(of.z + row, of.stride) + load_planes(of.p + row, of.stride) * by;
        store_planes(of.p + row, of.stride, p);
        store_quads(of.quads + 4 * row, p);
    }
}

void multiply(const ClothRows& matrix, const ClothVectors& of, std::size_t first, std::size_t last, double* sums) {
    for (std::size_t row = first * slice_rows; row < last * slice_rows; row += width) {
        const std::size_t slice = row / slice_rows, lane = row % slice_rows;
        const Wide3 own = load_planes(of.p + row, of.stride);
        Wide3 sum = block_times(matrix.own + slice * slice_block + lane, own);
        visit_slots(matrix.near, of, slice, row, [&](std::size_t k, const Wide3& p) {
            sum = sum + block_times(matrix.near.value + k * slice_block + lane, p);
        });
        visit_slots(matrix.far, of, slice, row, [&](std::size_t k, const Wide3& p) {
            sum = sum + p * load(matrix.far.value + k * slice_rows + lane);
        });
        store_planes(of.q + row, of.stride, sum);
        add_products(sum, own, sums + lane);
    }
}

void advance(const ClothVectors& of, float alpha, std::size_t first, std::size_t last, double* sums) {
    const Wide by = broadcast(alpha);
    for (std::size_t row = first * slice_rows; row < last * slice_rows; row += width) {
        const std::size_t slice = row / slice_rows, lane = row % slice_rows;
        const Wide3 p = load_planes(of.p + row, of.stride);
        store_planes(of.x + row, of.stride, load_planes(of.x + row, of.stride) + p * by);
        const Wide3 r = load_planes(of.r + row, of.stride) - load_planes(of.q + row, of.stride) * by;
        store_planes(of.r + row, of.stride, r);
        const Wide3 z = block_times(of.inverse + slice * slice_block + lane, r);
        store_planes(of.z + row, of.stride, z);
        add_products(z, r, sums + lane);
    }
}

void dot_residual(const ClothVectors& of, std::size_t first, std::size_t last, double* sums) {
    for (std::size_t row = first * slice_rows; row < last * slice_rows; row += width)
        add_products(load_planes(of.z + row, of.stride), load_planes(of.r + row, of.stride), sums + row % slice_rows);
}

constexpr physics::deformable::ClothRowKernels kernels{turn, multiply, advance, dot_residual};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const physics::deformable::ClothRowKernels physics::deformable::ClothRowKernels::EMBODY_WIDE =
    EMBODY_WIDE::kernels;
}
