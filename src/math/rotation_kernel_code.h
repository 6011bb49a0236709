// SPDX-License-Identifier: MIT
//
// The rotations in deformations, one a lane of doubles. Included once by each of rotation_kernel_4.cpp, _8.cpp and
// _16.cpp.
#include "math/rotation_kernels.h"
#include "math/wide.h"

namespace embody::EMBODY_WIDE {
namespace {

using Vector = WideVector<WideDouble>;

struct Quaternion {
    WideDouble x, y, z, w;
};
// The columns of its matrix: q e q* for the three axes e.
EMBODY_WIDE_INLINE void find_columns(const Quaternion& q, Vector column[3]) {
    const WideDouble x = q.x + q.x, y = q.y + q.y, z = q.z + q.z;
    column[0] = {1 - (q.y * y + q.z * z), q.x * y + q.w * z, q.x * z - q.w * y};
    column[1] = {q.x * y - q.w * z, 1 - (q.x * x + q.z * z), q.y * z + q.w * x};
    column[2] = {q.x * z + q.w * y, q.y * z - q.w * x, 1 - (q.x * x + q.y * y)};
}
// Turned by the rotation vector 2 half, small, in its own axes; of unit length.
EMBODY_WIDE_INLINE Quaternion turned(const Quaternion& a, const Vector& half) {
    const Quaternion q{
        a.w * half.x + a.x + a.y * half.z - a.z * half.y, a.w * half.y - a.x * half.z + a.y + a.z * half.x,
        a.w * half.z + a.x * half.y - a.y * half.x + a.z, a.w - a.x * half.x - a.y * half.y - a.z * half.z};
    const WideDouble long_one = square_root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const WideDouble by = 1 / long_one;
    return {q.x * by, q.y * by, q.z * by, q.w * by};
}

// Newton's method for the largest tr(Rᵀ F) in all lanes that have not reached it.
EMBODY_WIDE_INLINE Quaternion follow_wide(const Vector deformation[3], Quaternion rotation) {
    constexpr int max_rounds = 20;
    constexpr double close = 1e-10;     // rad
    constexpr double last_turn = 1e-5;  // rad: the error after it is about its square, which is below `close`
    const WideDouble zero{};
    WideDoubleMask goes_on = zero == zero;
    for (int round = 0; round < max_rounds && any(goes_on); ++round) {
        // W = Rᵀ F is symmetric where R is right. A turn by ω (in R's axes) changes its skew part by (tr W - W) ω.
        Vector axis[3];
        find_columns(rotation, axis);
        WideDouble w[3][3];  // by row and column
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) w[r][c] = dot(axis[r], deformation[c]);
        }
        const Vector skewness{w[2][1] - w[1][2], w[0][2] - w[2][0], w[1][0] - w[0][1]};
        const WideDouble spread = w[0][0] + w[1][1] + w[2][2];
        const WideDouble xy = -0.5 * (w[0][1] + w[1][0]), xz = -0.5 * (w[0][2] + w[2][0]),
                         yz = -0.5 * (w[1][2] + w[2][1]);
        const Vector slope[3] = {{spread - w[0][0], xy, xz}, {xy, spread - w[1][1], yz}, {xz, yz, spread - w[2][2]}};
        // Positive definite (leading minors): R is near a maximum of tr(Rᵀ F).
        const Vector minors = cross(slope[1], slope[2]);
        const WideDouble determinant = dot(slope[0], minors);
        const WideDoubleMask is_near = (slope[0].x > 0) & (slope[0].x * slope[1].y > xy * xy) &
                                       (determinant > 1e-6 * spread * spread * spread) & (determinant > 0);
        const WideDouble inverse = 1 / select(is_near, determinant, zero + 1);
        const Vector newton =
            (minors * skewness.x + cross(slope[2], slope[0]) * skewness.y + cross(slope[0], slope[1]) * skewness.z) *
            inverse;
        Vector turn = newton;
        if (any(goes_on & ~is_near)) {
            const WideDouble cautious =
                select(spread < 0, -spread, spread) + 1e-9 * (1 + square_root(dot(skewness, skewness)));
            turn = select(is_near, newton, skewness * (1 / cautious));
        }
        const WideDouble square = dot(turn, turn);  // of its angle
        goes_on &= square > close * close;
        if (any(goes_on & (square > 1))) turn = turn * select(square > 1, 1 / square_root(square), zero + 1);
        const Quaternion next = turned(rotation, turn * (zero + 0.5));
        rotation = {select(goes_on, next.x, rotation.x), select(goes_on, next.y, rotation.y),
                    select(goes_on, next.z, rotation.z), select(goes_on, next.w, rotation.w)};
        goes_on &= ~(is_near & (square < last_turn * last_turn));
    }
    return rotation;
}

void follow(const double* deformation, double* rotation, std::size_t count) {
    constexpr std::size_t width = double_lanes;
    for (std::size_t first = 0; first < count; first += width) {
        // Lanes beyond the last repeat it.
        const std::size_t filled = count - first < width ? count - first : width;
        double from[9][width], turns[4][width];
        for (std::size_t lane = 0; lane < width; ++lane) {
            const std::size_t index = first + (lane < filled ? lane : filled - 1);
            for (std::size_t k = 0; k < 9; ++k) from[k][lane] = deformation[9 * index + k];
            for (std::size_t k = 0; k < 4; ++k) turns[k][lane] = rotation[4 * index + k];
        }
        const Vector columns[3] = {{load(from[0]), load(from[1]), load(from[2])},
                                   {load(from[3]), load(from[4]), load(from[5])},
                                   {load(from[6]), load(from[7]), load(from[8])}};
        const Quaternion found = follow_wide(columns, {load(turns[0]), load(turns[1]), load(turns[2]), load(turns[3])});
        store(turns[0], found.x);
        store(turns[1], found.y);
        store(turns[2], found.z);
        store(turns[3], found.w);
        for (std::size_t lane = 0; lane < filled; ++lane) {
            for (std::size_t k = 0; k < 4; ++k) rotation[4 * (first + lane) + k] = turns[k][lane];
        }
    }
}

constexpr RotationKernels kernels{follow};

}  // namespace

}  // namespace embody::EMBODY_WIDE

namespace embody {
constinit const RotationKernels RotationKernels::EMBODY_WIDE = EMBODY_WIDE::kernels;
}
