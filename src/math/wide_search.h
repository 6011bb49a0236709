// SPDX-License-Identifier: MIT
//
// The maximum of many numbers and its index, and masks with a bit for each lane. Only for kernels, see math/wide.h.
// Equal bits for all widths: a maximum does not depend on the order of the numbers except for the sign of zero, which
// is always made positive.
#pragma once

#include "math/wide.h"

namespace embody::EMBODY_WIDE {

EMBODY_WIDE_INLINE WideDouble broadcast(double value) { return WideDouble{} + value; }

// The larger and smaller numbers, lane by lane, and masks with bit i: a[i] == b[i], a[i] <= b[i].
#if defined(__AVX512F__) && EMBODY_LANES == 16
EMBODY_WIDE_INLINE WideDouble minimum(WideDouble a, WideDouble b) { return _mm512_maskz_min_pd(0xFF, a, b); }
EMBODY_WIDE_INLINE WideDouble maximum(WideDouble a, WideDouble b) { return _mm512_maskz_max_pd(0xFF, a, b); }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(WideDouble a, WideDouble b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(Wide a, Wide b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
EMBODY_WIDE_INLINE std::uint32_t at_most_mask(WideDouble a, WideDouble b) {
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}
#elif defined(__AVX__) && EMBODY_LANES == 8
EMBODY_WIDE_INLINE WideDouble minimum(WideDouble a, WideDouble b) { return _mm256_min_pd(a, b); }
EMBODY_WIDE_INLINE WideDouble maximum(WideDouble a, WideDouble b) { return _mm256_max_pd(a, b); }
EMBODY_WIDE_INLINE std::uint32_t sign_mask(WideDouble a) { return static_cast<std::uint32_t>(_mm256_movemask_pd(a)); }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(WideDouble a, WideDouble b) {
    return sign_mask(_mm256_cmp_pd(a, b, _CMP_EQ_OQ));
}
EMBODY_WIDE_INLINE std::uint32_t equal_mask(Wide a, Wide b) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_EQ_OQ)));
}
EMBODY_WIDE_INLINE std::uint32_t at_most_mask(WideDouble a, WideDouble b) {
    return sign_mask(_mm256_cmp_pd(a, b, _CMP_LE_OQ));
}
#elif defined(__SSE2__) && EMBODY_LANES == 4
EMBODY_WIDE_INLINE WideDouble minimum(WideDouble a, WideDouble b) { return _mm_min_pd(a, b); }
EMBODY_WIDE_INLINE WideDouble maximum(WideDouble a, WideDouble b) { return _mm_max_pd(a, b); }
EMBODY_WIDE_INLINE std::uint32_t sign_mask(WideDouble a) { return static_cast<std::uint32_t>(_mm_movemask_pd(a)); }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(WideDouble a, WideDouble b) { return sign_mask(_mm_cmpeq_pd(a, b)); }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(Wide a, Wide b) {
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmpeq_ps(a, b)));
}
EMBODY_WIDE_INLINE std::uint32_t at_most_mask(WideDouble a, WideDouble b) { return sign_mask(_mm_cmple_pd(a, b)); }
#else
EMBODY_WIDE_INLINE WideDouble minimum(WideDouble a, WideDouble b) { return a < b ? a : b; }
EMBODY_WIDE_INLINE WideDouble maximum(WideDouble a, WideDouble b) { return a > b ? a : b; }
EMBODY_WIDE_INLINE std::uint32_t equal_mask(WideDouble a, WideDouble b) {
    std::uint32_t mask = 0;
    for (int i = 0; i < double_lanes; ++i) mask |= static_cast<std::uint32_t>(a[i] == b[i]) << i;
    return mask;
}
EMBODY_WIDE_INLINE std::uint32_t equal_mask(Wide a, Wide b) {
    std::uint32_t mask = 0;
    for (int i = 0; i < lanes; ++i) mask |= static_cast<std::uint32_t>(a[i] == b[i]) << i;
    return mask;
}
EMBODY_WIDE_INLINE std::uint32_t at_most_mask(WideDouble a, WideDouble b) {
    std::uint32_t mask = 0;
    for (int i = 0; i < double_lanes; ++i) mask |= static_cast<std::uint32_t>(a[i] <= b[i]) << i;
    return mask;
}
#endif

// The highest lane: maximum of both halves, again and again.
using Double2 = double __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));
EMBODY_WIDE_INLINE double highest(WideDouble wide) {
#if EMBODY_LANES == 16
    using Double4 = double __attribute__((vector_size(32)));
    const Double4 low = __builtin_shufflevector(wide, wide, 0, 1, 2, 3);
    const Double4 high = __builtin_shufflevector(wide, wide, 4, 5, 6, 7);
    const Double4 four = low > high ? low : high;
#elif EMBODY_LANES == 8
    const WideDouble four = wide;
#endif
#if EMBODY_LANES == 4
    const Double2 two = wide;
#else
    const Double2 first = __builtin_shufflevector(four, four, 0, 1), second = __builtin_shufflevector(four, four, 2, 3);
    const Double2 two = first > second ? first : second;
#endif
    return (two[0] > two[1] ? two[0] : two[1]) + 0.0;
}
EMBODY_WIDE_INLINE float highest(Wide wide) {
#if EMBODY_LANES == 16
    using Float8 = float __attribute__((vector_size(32)));
    const Float8 low = __builtin_shufflevector(wide, wide, 0, 1, 2, 3, 4, 5, 6, 7);
    const Float8 high = __builtin_shufflevector(wide, wide, 8, 9, 10, 11, 12, 13, 14, 15);
    const Float8 eight = low > high ? low : high;
#elif EMBODY_LANES == 8
    const Wide eight = wide;
#endif
#if EMBODY_LANES == 4
    const Float4 four = wide;
#else
    const Float4 first = __builtin_shufflevector(eight, eight, 0, 1, 2, 3);
    const Float4 second = __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
    const Float4 four = first > second ? first : second;
#endif
    const Float4 swapped = __builtin_shufflevector(four, four, 2, 3, 0, 1), two = four > swapped ? four : swapped;
    return (two[0] > two[1] ? two[0] : two[1]) + 0.0F;
}

}  // namespace embody::EMBODY_WIDE
