// SPDX-License-Identifier: MIT
#include "math/rotation_part.h"

#include <cmath>

namespace embody {

void follow_rotation(const Mat3& deformation, Quat& rotation) {
    constexpr int most_rounds = 20;
    constexpr double close = 1e-10;     // rad
    constexpr double last_turn = 1e-5;  // rad: the error after it is about its square, which is below `close`
    for (int round = 0; round < most_rounds; ++round) {
        // W = Rᵀ F is symmetric where R is right. A turn by ω (in R's axes) changes its skew part by (tr W - W) ω.
        const Mat3 w = transpose(to_matrix(rotation)) * deformation;
        const Vec3 skewness{w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1)};
        const double spread = trace(w);
        const Mat3 symmetric = 0.5 * (w + transpose(w));
        const Mat3 slope = Mat3::diagonal({spread, spread, spread}) - symmetric;
        // Positive definite (leading minors): R is near a maximum of tr(Rᵀ F).
        const bool is_near = slope(0, 0) > 0 && slope(0, 0) * slope(1, 1) > slope(0, 1) * slope(0, 1) &&
                             determinant(slope) > 1e-6 * spread * spread * spread;
        const double cautious = std::fabs(spread) + 1e-9 * (1 + length(skewness));
        Vec3 turn = is_near ? solve(slope, skewness) : skewness / cautious;
        const double angle = length(turn);
        if (!(angle > close)) return;
        if (angle > 1) turn = turn / angle;
        const Vec3 half = 0.5 * turn;
        rotation = normalized(rotation * Quat{half.x, half.y, half.z, 1});
        if (is_near && angle < last_turn) return;
    }
}

}  // namespace embody
