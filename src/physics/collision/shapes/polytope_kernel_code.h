// SPDX-License-Identifier: MIT
// Loops over all vertices or faces of a polytope, compiled once for each width (polytope_kernel_4.cpp and its like).
// The maximum is found first, its index by a second pass that compares: no index is carried along, and the first
// of equal ones is found whatever the width.
#include "math/wide_search.h"
#include "physics/collision/shapes/polytope_kernels.h"

namespace embody::EMBODY_WIDE {

namespace {

using physics::collision::Extent;
using physics::collision::Extreme;
using physics::collision::VectorLanes;

/// Dot products of vectors with one vector.
struct Products {
    const double *x, *y, *z;
    WideDouble dx, dy, dz;

    EMBODY_WIDE_INLINE Products of(const VectorLanes<double>& vectors, const double* d) {
        return {vectors.x, vectors.y, vectors.z, broadcast(d[0]), broadcast(d[1]), broadcast(d[2])};
    }
    [[gnu::always_inline]] WideDouble at(std::size_t i) const {
        return load(x + i) * dx + load(y + i) * dy + load(z + i) * dz;
    }
};

std::uint32_t first_lane(std::size_t i, std::uint32_t mask) {
    return static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(__builtin_ctz(mask));
}

// The first number for which its bit in mask_at(i), the mask of the `width` numbers from i on, is set; 0 if there is
// none.
// Most polytopes have no more than 64 of a kind: then there is no branch that cannot be predicted.
template <class MaskAt>
[[gnu::always_inline]] inline std::uint32_t find_first(std::size_t count, std::size_t width, MaskAt mask_at) {
    for (std::size_t block = 0; block < count; block += 64) {
        const std::size_t end = block + 64 < count ? block + 64 : count;
        std::uint64_t mask = 0;
        for (std::size_t i = block; i < end; i += width) mask |= std::uint64_t{mask_at(i)} << (i - block);
        if (mask != 0) return static_cast<std::uint32_t>(block) + static_cast<std::uint32_t>(__builtin_ctzll(mask));
    }
    return 0;
}

Extreme farthest(const VectorLanes<double>& vectors, const double* d) {
    const Products products = Products::of(vectors, d);
    WideDouble high = broadcast(-1e300);
    for (std::size_t i = 0; i < vectors.count; i += double_lanes) high = maximum(high, products.at(i));
    const double along = highest(high);
    const WideDouble wanted = broadcast(along);
    return {along,
            find_first(vectors.count, double_lanes, [&](std::size_t i) { return equal_mask(products.at(i), wanted); })};
}

Extent extent(const VectorLanes<double>& vectors, const double* d) {
    const Products products = Products::of(vectors, d);
    WideDouble high = broadcast(-1e300), low = broadcast(1e300);
    for (std::size_t i = 0; i < vectors.count; i += double_lanes) {
        const WideDouble along = products.at(i);
        high = maximum(high, along);
        low = minimum(low, along);
    }
    return {-highest(-low), highest(high)};
}

std::uint32_t farthest_roughly(const VectorLanes<float>& vectors, const float* d) {
    const Wide dx = broadcast(d[0]), dy = broadcast(d[1]), dz = broadcast(d[2]);
    const auto product = [&](std::size_t i) {
        return load(vectors.x + i) * dx + load(vectors.y + i) * dy + load(vectors.z + i) * dz;
    };
    Wide high = broadcast(-1e30F);
    for (std::size_t i = 0; i < vectors.count; i += lanes) high = maximum(high, product(i));
    const Wide wanted = broadcast(highest(high));
    return find_first(vectors.count, lanes, [&](std::size_t i) { return equal_mask(product(i), wanted); });
}

double heights_over_faces(const VectorLanes<double>& normals, const double* reach, const double* d, double* heights) {
    const Products products = Products::of(normals, d);
    WideDouble high = broadcast(-1e300);
    for (std::size_t i = 0; i < normals.count; i += double_lanes) {
        const WideDouble height = products.at(i) - load(reach + i);
        store(heights + i, height);
        high = maximum(high, height);
    }
    return highest(high);
}

Extreme lower_bounds(const VectorLanes<double>& normals, const double* reach, const double* d, double* bounds) {
    const Products products = Products::of(normals, d);
    WideDouble high = broadcast(-1e300);
    for (std::size_t i = 0; i < normals.count; i += double_lanes) {
        const WideDouble lower = minimum(products.at(i) - load(reach + i), load(bounds + i));
        store(bounds + i, lower);
        high = maximum(high, lower);
    }
    const double along = highest(high);
    const WideDouble wanted = broadcast(along);
    return {along, find_first(normals.count, double_lanes,
                              [&](std::size_t i) { return equal_mask(load(bounds + i), wanted); })};
}

std::uint32_t find_low(const VectorLanes<double>& vectors, const double* d, double limit, std::uint32_t* found) {
    const Products products = Products::of(vectors, d);
    const WideDouble most = broadcast(limit);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < vectors.count; i += double_lanes) {
        for (std::uint32_t mask = at_most_mask(products.at(i), most); mask != 0; mask &= mask - 1) {
            found[count++] = first_lane(i, mask);
        }
    }
    return count;
}

constexpr physics::collision::PolytopeKernels kernels{farthest,           extent,       farthest_roughly,
                                                      heights_over_faces, lower_bounds, find_low};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const physics::collision::PolytopeKernels physics::collision::PolytopeKernels::EMBODY_WIDE =
    EMBODY_WIDE::kernels;
}
