// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>

#include "math/mat3.h"
#include "physics/linear/block_kernels.h"
#include "physics/linear/namespace.h"

namespace embody::physics::linear {

/// Six numbers of a body: three of its linear motion, then three of its angular motion.
struct alignas(16) Vec6 {
    double value[6] = {};
    [[nodiscard]] Vec3 linear() const { return {value[0], value[1], value[2]}; }
    [[nodiscard]] Vec3 angular() const { return {value[3], value[4], value[5]}; }
};
inline Vec6 make_vec6(Vec3 linear, Vec3 angular) {
    return {{linear.x, linear.y, linear.z, angular.x, angular.y, angular.z}};
}

/// 6×6 matrix by columns, each filled up with zeros.
struct alignas(64) Block6 {
    double column[6][column_stride] = {};
};
static_assert(sizeof(Block6) == block_stride * sizeof(double));
/// Adds (uu uw; wu ww) to the block.
inline void add_to(Block6& block, const Mat3& uu, const Mat3& uw, const Mat3& wu, const Mat3& ww) {
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            block.column[c][r] += uu.column(c)[r];
            block.column[c][r + 3] += wu.column(c)[r];
            block.column[c + 3][r] += uw.column(c)[r];
            block.column[c + 3][r + 3] += ww.column(c)[r];
        }
    }
}

// Two numbers at once; every processor that Embody runs on can do that.
using NumberPair = double __attribute__((vector_size(16)));

/// One column of a block in registers.
struct Column6 {
    NumberPair a, b, c;

    static Column6 of(const double* from) {
        Column6 column;
        std::memcpy(&column, from, sizeof column);
        return column;
    }
    void put(double* to) const { std::memcpy(to, this, sizeof *this); }
    void subtract(const Column6& other, double factor) {
        const NumberPair f{factor, factor};
        a -= other.a * f;
        b -= other.b * f;
        c -= other.c * f;
    }
};
inline double dot(const Column6& x, const Column6& y) {
    const NumberPair sum = x.a * y.a + x.b * y.b + x.c * y.c;
    return sum[0] + sum[1];
}

}  // namespace embody::physics::linear
