// SPDX-License-Identifier: MIT
//
// Numbers side by side: one instruction works on EMBODY_LANES floats. Only for kernels, source files that are compiled
// once for each width with EMBODY_LANES defined and the processor's flags set; everything here and in such a file lives
// in a namespace of that width, so that the linker cannot take one width's code for another's. Kernels include no other
// code of the project: shared inline functions would be merged across widths.
//
// Equal bits for all widths: no fused multiply-add (contraction is off), no reciprocal approximations, no sums across
// lanes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef EMBODY_LANES
#error "define EMBODY_LANES as 4, 8 or 16 before including math/wide.h"
#endif
#if EMBODY_LANES == 4
#define EMBODY_WIDE lanes_4
#elif EMBODY_LANES == 8
#define EMBODY_WIDE lanes_8
#elif EMBODY_LANES == 16
#define EMBODY_WIDE lanes_16
#endif

namespace embody::EMBODY_WIDE {

constexpr int lanes = EMBODY_LANES;

using Wide = float __attribute__((vector_size(4 * EMBODY_LANES)));
/// All bits of a lane set or none.
using WideMask = std::int32_t __attribute__((vector_size(4 * EMBODY_LANES)));

#define EMBODY_WIDE_INLINE [[gnu::always_inline]] static inline

/// As many doubles as fill the register of the lanes' floats.
using WideDouble = double __attribute__((vector_size(4 * EMBODY_LANES)));
constexpr int double_lanes = EMBODY_LANES / 2;
/// All bits of a double's lane set or none.
using WideDoubleMask = std::int64_t __attribute__((vector_size(4 * EMBODY_LANES)));

EMBODY_WIDE_INLINE WideDouble load(const double* from) {
    WideDouble value;
    std::memcpy(&value, from, sizeof value);
    return value;
}
EMBODY_WIDE_INLINE void store(double* to, WideDouble value) { std::memcpy(to, &value, sizeof value); }
EMBODY_WIDE_INLINE WideDouble select(WideDoubleMask mask, WideDouble yes, WideDouble no) { return mask ? yes : no; }

EMBODY_WIDE_INLINE Wide load(const float* from) {
    Wide value;
    std::memcpy(&value, from, sizeof value);
    return value;
}
EMBODY_WIDE_INLINE WideMask load_mask(const float* from) {
    WideMask value;
    std::memcpy(&value, from, sizeof value);
    return value;
}
EMBODY_WIDE_INLINE void store(float* to, Wide value) { std::memcpy(to, &value, sizeof value); }
EMBODY_WIDE_INLINE void store_mask(float* to, WideMask value) { std::memcpy(to, &value, sizeof value); }

EMBODY_WIDE_INLINE Wide broadcast(float value) { return Wide{} + value; }
EMBODY_WIDE_INLINE Wide select(WideMask mask, Wide yes, Wide no) { return mask ? yes : no; }

#if defined(__AVX512F__) && EMBODY_LANES == 16
EMBODY_WIDE_INLINE WideDouble square_root(WideDouble a) { return _mm512_maskz_sqrt_pd(0xFF, a); }
// With a mask of ones: the plain forms warn about an undefined value within gcc 12's own header.
EMBODY_WIDE_INLINE Wide minimum(Wide a, Wide b) { return _mm512_maskz_min_ps(0xFFFF, a, b); }
EMBODY_WIDE_INLINE Wide maximum(Wide a, Wide b) { return _mm512_maskz_max_ps(0xFFFF, a, b); }
EMBODY_WIDE_INLINE Wide square_root(Wide a) { return _mm512_maskz_sqrt_ps(0xFFFF, a); }
#elif defined(__AVX__) && EMBODY_LANES == 8
EMBODY_WIDE_INLINE Wide minimum(Wide a, Wide b) { return _mm256_min_ps(a, b); }
EMBODY_WIDE_INLINE Wide maximum(Wide a, Wide b) { return _mm256_max_ps(a, b); }
EMBODY_WIDE_INLINE Wide square_root(Wide a) { return _mm256_sqrt_ps(a); }
EMBODY_WIDE_INLINE WideDouble square_root(WideDouble a) { return _mm256_sqrt_pd(a); }
#elif defined(__SSE2__) && EMBODY_LANES == 4
EMBODY_WIDE_INLINE Wide minimum(Wide a, Wide b) { return _mm_min_ps(a, b); }
EMBODY_WIDE_INLINE Wide maximum(Wide a, Wide b) { return _mm_max_ps(a, b); }
EMBODY_WIDE_INLINE Wide square_root(Wide a) { return _mm_sqrt_ps(a); }
EMBODY_WIDE_INLINE WideDouble square_root(WideDouble a) { return _mm_sqrt_pd(a); }
#else
EMBODY_WIDE_INLINE Wide minimum(Wide a, Wide b) { return a < b ? a : b; }
EMBODY_WIDE_INLINE Wide maximum(Wide a, Wide b) { return a > b ? a : b; }
EMBODY_WIDE_INLINE Wide square_root(Wide a) {
    for (int i = 0; i < lanes; ++i) a[i] = __builtin_sqrtf(a[i]);
    return a;
}
EMBODY_WIDE_INLINE WideDouble square_root(WideDouble a) {
    for (int i = 0; i < double_lanes; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
}
#endif

EMBODY_WIDE_INLINE bool any(WideDoubleMask mask) {
    std::int64_t sum = 0;
    for (int i = 0; i < double_lanes; ++i) sum |= mask[i];
    return sum != 0;
}
/// Whether any lane is set; the lanes are full masks.
EMBODY_WIDE_INLINE bool any(WideMask mask) {
#if defined(__AVX512F__) && EMBODY_LANES == 16
    return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(mask), reinterpret_cast<__m512i>(mask)) != 0;
#elif defined(__AVX__) && EMBODY_LANES == 8
    return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
#elif defined(__SSE2__) && EMBODY_LANES == 4
    return _mm_movemask_ps(reinterpret_cast<__m128>(mask)) != 0;
#else
    std::int32_t sum = 0;
    for (int i = 0; i < lanes; ++i) sum |= mask[i];
    return sum != 0;
#endif
}

// Rows of eight floats, one a lane, to eight columns and back. `rows` counts rows from `base`.
constexpr int row_floats = 8;

#if EMBODY_LANES == 4

EMBODY_WIDE_INLINE void transpose_4(Wide& a, Wide& b, Wide& c, Wide& d) {
    const Wide low_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), high_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Wide low_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5), high_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
    b = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
    c = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
    d = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
}

EMBODY_WIDE_INLINE void gather_rows(const float* base, const std::int32_t* row, Wide column[row_floats]) {
    for (int i = 0; i < 4; ++i) {
        column[i] = load(base + row_floats * row[i]);
        column[i + 4] = load(base + row_floats * row[i] + 4);
    }
    transpose_4(column[0], column[1], column[2], column[3]);
    transpose_4(column[4], column[5], column[6], column[7]);
}

/// Lane i is written where bit i of `writable` is set.
EMBODY_WIDE_INLINE void scatter_rows(float* base, const std::int32_t* row, std::uint32_t writable,
                                     const Wide column[row_floats]) {
    Wide r[row_floats];
    for (int i = 0; i < row_floats; ++i) r[i] = column[i];
    transpose_4(r[0], r[1], r[2], r[3]);
    transpose_4(r[4], r[5], r[6], r[7]);
    for (int i = 0; i < 4; ++i) {
        if ((writable >> i & 1u) == 0) continue;
        store(base + row_floats * row[i], r[i]);
        store(base + row_floats * row[i] + 4, r[i + 4]);
    }
}

#else

using Row = float __attribute__((vector_size(4 * row_floats)));

EMBODY_WIDE_INLINE Row load_row(const float* from) {
    Row row;
    std::memcpy(&row, from, sizeof row);
    return row;
}

// Shuffles within each half of eight lanes; the second half of 16 lanes does the same with its own rows.
#if EMBODY_LANES == 8
#define EMBODY_SHUFFLE(a, b, i0, i1, i2, i3, i4, i5, i6, i7) \
    __builtin_shufflevector(a, b, i0, i1, i2, i3, i4, i5, i6, i7)
#else
#define EMBODY_UPPER(i) ((i) < 8 ? (i) + 8 : (i) + 16)
#define EMBODY_LOWER(i) ((i) < 8 ? (i) : (i) + 8)
#define EMBODY_SHUFFLE(a, b, i0, i1, i2, i3, i4, i5, i6, i7)                                                          \
    __builtin_shufflevector(a, b, EMBODY_LOWER(i0), EMBODY_LOWER(i1), EMBODY_LOWER(i2), EMBODY_LOWER(i3),             \
                            EMBODY_LOWER(i4), EMBODY_LOWER(i5), EMBODY_LOWER(i6), EMBODY_LOWER(i7), EMBODY_UPPER(i0), \
                            EMBODY_UPPER(i1), EMBODY_UPPER(i2), EMBODY_UPPER(i3), EMBODY_UPPER(i4), EMBODY_UPPER(i5), \
                            EMBODY_UPPER(i6), EMBODY_UPPER(i7))
#endif

/// Eight rows to eight columns (its own inverse).
EMBODY_WIDE_INLINE void transpose_8(Wide r[row_floats]) {
    // Pairs of numbers, then pairs of pairs, then halves.
    const Wide a0 = EMBODY_SHUFFLE(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a1 = EMBODY_SHUFFLE(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Wide a2 = EMBODY_SHUFFLE(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a3 = EMBODY_SHUFFLE(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    const Wide a4 = EMBODY_SHUFFLE(r[4], r[5], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a5 = EMBODY_SHUFFLE(r[4], r[5], 2, 10, 3, 11, 6, 14, 7, 15);
    const Wide a6 = EMBODY_SHUFFLE(r[6], r[7], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a7 = EMBODY_SHUFFLE(r[6], r[7], 2, 10, 3, 11, 6, 14, 7, 15);
    const Wide b0 = EMBODY_SHUFFLE(a0, a2, 0, 1, 8, 9, 4, 5, 12, 13);
    const Wide b1 = EMBODY_SHUFFLE(a0, a2, 2, 3, 10, 11, 6, 7, 14, 15);
    const Wide b2 = EMBODY_SHUFFLE(a1, a3, 0, 1, 8, 9, 4, 5, 12, 13);
    const Wide b3 = EMBODY_SHUFFLE(a1, a3, 2, 3, 10, 11, 6, 7, 14, 15);
    const Wide b4 = EMBODY_SHUFFLE(a4, a6, 0, 1, 8, 9, 4, 5, 12, 13);
    const Wide b5 = EMBODY_SHUFFLE(a4, a6, 2, 3, 10, 11, 6, 7, 14, 15);
    const Wide b6 = EMBODY_SHUFFLE(a5, a7, 0, 1, 8, 9, 4, 5, 12, 13);
    const Wide b7 = EMBODY_SHUFFLE(a5, a7, 2, 3, 10, 11, 6, 7, 14, 15);
    r[0] = EMBODY_SHUFFLE(b0, b4, 0, 1, 2, 3, 8, 9, 10, 11);
    r[1] = EMBODY_SHUFFLE(b1, b5, 0, 1, 2, 3, 8, 9, 10, 11);
    r[2] = EMBODY_SHUFFLE(b2, b6, 0, 1, 2, 3, 8, 9, 10, 11);
    r[3] = EMBODY_SHUFFLE(b3, b7, 0, 1, 2, 3, 8, 9, 10, 11);
    r[4] = EMBODY_SHUFFLE(b0, b4, 4, 5, 6, 7, 12, 13, 14, 15);
    r[5] = EMBODY_SHUFFLE(b1, b5, 4, 5, 6, 7, 12, 13, 14, 15);
    r[6] = EMBODY_SHUFFLE(b2, b6, 4, 5, 6, 7, 12, 13, 14, 15);
    r[7] = EMBODY_SHUFFLE(b3, b7, 4, 5, 6, 7, 12, 13, 14, 15);
}

EMBODY_WIDE_INLINE void gather_rows(const float* base, const std::int32_t* row, Wide column[row_floats]) {
    for (int i = 0; i < row_floats; ++i) {
#if EMBODY_LANES == 8
        column[i] = load_row(base + row_floats * row[i]);
#else
        const Row lower = load_row(base + row_floats * row[i]), upper = load_row(base + row_floats * row[i + 8]);
        column[i] = __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
    }
    transpose_8(column);
}

/// Lane i is written where bit i of `writable` is set.
EMBODY_WIDE_INLINE void scatter_rows(float* base, const std::int32_t* row, std::uint32_t writable,
                                     const Wide column[row_floats]) {
    Wide r[row_floats];
    for (int i = 0; i < row_floats; ++i) r[i] = column[i];
    transpose_8(r);
    for (int i = 0; i < row_floats; ++i) {
        const Row lower = __builtin_shufflevector(r[i], r[i], 0, 1, 2, 3, 4, 5, 6, 7);
        if (writable >> i & 1u) std::memcpy(base + row_floats * row[i], &lower, sizeof lower);
#if EMBODY_LANES == 16
        const Row upper = __builtin_shufflevector(r[i], r[i], 8, 9, 10, 11, 12, 13, 14, 15);
        if (writable >> (i + 8) & 1u) std::memcpy(base + row_floats * row[i + 8], &upper, sizeof upper);
#endif
    }
}

#endif

/// Three numbers a lane, floats or doubles.
template <class Number>
struct WideVector {
    Number x, y, z;
};
using Wide3 = WideVector<Wide>;
EMBODY_WIDE_INLINE Wide3 load_3(const float* from) { return {load(from), load(from + lanes), load(from + 2 * lanes)}; }
EMBODY_WIDE_INLINE void store_3(float* to, const Wide3& v) {
    store(to, v.x);
    store(to + lanes, v.y);
    store(to + 2 * lanes, v.z);
}

// Rows of four floats, of which the first three count.

#if EMBODY_LANES == 4
EMBODY_WIDE_INLINE void transpose_quads(Wide r[4]) { transpose_4(r[0], r[1], r[2], r[3]); }
#else
/// For each four lanes: four rows to four columns (its own inverse).
EMBODY_WIDE_INLINE void transpose_quads(Wide r[4]) {
    const Wide a0 = EMBODY_SHUFFLE(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a1 = EMBODY_SHUFFLE(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Wide a2 = EMBODY_SHUFFLE(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Wide a3 = EMBODY_SHUFFLE(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    r[0] = EMBODY_SHUFFLE(a0, a2, 0, 1, 8, 9, 4, 5, 12, 13);
    r[1] = EMBODY_SHUFFLE(a0, a2, 2, 3, 10, 11, 6, 7, 14, 15);
    r[2] = EMBODY_SHUFFLE(a1, a3, 0, 1, 8, 9, 4, 5, 12, 13);
    r[3] = EMBODY_SHUFFLE(a1, a3, 2, 3, 10, 11, 6, 7, 14, 15);
}
#endif

/// The rows that `row` counts from `base`, one a lane.
EMBODY_WIDE_INLINE Wide3 gather_quads(const float* base, const std::uint32_t* row) {
    using Quad = float __attribute__((vector_size(16)));
    Wide r[4];
    for (int i = 0; i < 4; ++i) {
        Quad quad[lanes / 4];
        for (int part = 0; part < lanes / 4; ++part)
            std::memcpy(&quad[part], base + std::size_t{4} * row[4 * part + i], sizeof(Quad));
#if EMBODY_LANES == 4
        r[i] = quad[0];
#elif EMBODY_LANES == 8
        r[i] = __builtin_shufflevector(quad[0], quad[1], 0, 1, 2, 3, 4, 5, 6, 7);
#else
        const Row lower = __builtin_shufflevector(quad[0], quad[1], 0, 1, 2, 3, 4, 5, 6, 7);
        const Row upper = __builtin_shufflevector(quad[2], quad[3], 0, 1, 2, 3, 4, 5, 6, 7);
        r[i] = __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
    }
    transpose_quads(r);
    return {r[0], r[1], r[2]};
}

/// One row a lane, one after the other; fourth numbers are zero.
EMBODY_WIDE_INLINE void store_quads(float* to, const Wide3& v) {
    Wide r[4] = {v.x, v.y, v.z, Wide{}};
    transpose_quads(r);
    float rows[4][lanes];
    for (int i = 0; i < 4; ++i) store(rows[i], r[i]);
    for (int lane = 0; lane < lanes; ++lane)
        std::memcpy(to + 4 * lane, rows[lane % 4] + lane / 4 * 4, 4 * sizeof(float));
}

template <class Number>
EMBODY_WIDE_INLINE WideVector<Number> operator+(const WideVector<Number>& a, const WideVector<Number>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Number>
EMBODY_WIDE_INLINE WideVector<Number> operator-(const WideVector<Number>& a, const WideVector<Number>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
EMBODY_WIDE_INLINE WideVector<Number> operator*(const WideVector<Number>& a, std::type_identity_t<Number> s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class Number>
EMBODY_WIDE_INLINE Number dot(const WideVector<Number>& a, const WideVector<Number>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
EMBODY_WIDE_INLINE WideVector<Number> cross(const WideVector<Number>& a, const WideVector<Number>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number, class Mask>
EMBODY_WIDE_INLINE WideVector<Number> select(Mask mask, const WideVector<Number>& yes, const WideVector<Number>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}

/// Symmetric 3×3 matrix a lane.
struct WideSymmetric {
    Wide xx, xy, xz, yy, yz, zz;
};
EMBODY_WIDE_INLINE Wide3 operator*(const WideSymmetric& m, const Wide3& v) {
    return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
            m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

}  // namespace embody::EMBODY_WIDE
