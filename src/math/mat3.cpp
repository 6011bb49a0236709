// SPDX-License-Identifier: MIT
#include "math/mat3.h"

#include <cmath>
#include <utility>

namespace embody {

SymmetricEigen eigen_symmetric(const Mat3& m) {
    Mat3 a = m;
    Mat3 v = Mat3::identity();
    constexpr int max_sweeps = 32;
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        const double off = a(0, 1) * a(0, 1) + a(0, 2) * a(0, 2) + a(1, 2) * a(1, 2);
        const double diag = a(0, 0) * a(0, 0) + a(1, 1) * a(1, 1) + a(2, 2) * a(2, 2);
        if (off <= 1e-32 * diag || off == 0) break;
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a(p, q) == 0) continue;
                // The rotation in the (p, q) plane that makes a(p, q) zero.
                const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
                const double t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1);
                const double s = t * c;
                Mat3 rotation;
                rotation(p, p) = c;
                rotation(q, q) = c;
                rotation(p, q) = s;
                rotation(q, p) = -s;
                a = transpose(rotation) * a * rotation;
                a(p, q) = 0;
                a(q, p) = 0;
                v = v * rotation;
            }
        }
    }
    // Ascending order, then a right-handed frame.
    Vec3 values{a(0, 0), a(1, 1), a(2, 2)};
    for (int i = 0; i < 2; ++i) {
        for (int j = i + 1; j < 3; ++j) {
            if (values[j] < values[i]) {
                std::swap(values[i], values[j]);
                std::swap(v.column(i), v.column(j));
            }
        }
    }
    if (determinant(v) < 0) v.z = -v.z;
    return {values, v};
}

}  // namespace embody
