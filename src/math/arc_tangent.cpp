// SPDX-License-Identifier: MIT
#include "math/arc_tangent.h"

#include <cmath>
#include <numbers>

namespace embody {
namespace {

// For |t| <= 1: the angle is halved twice by tan(a/2) = t / (1 + √(1 + t²)), then computed by a power series.
double arc_tangent_of(double t) {
    double quarter = t;
    for (int i = 0; i < 2; ++i) quarter /= 1 + std::sqrt(1 + quarter * quarter);

    // tan(π/16) = 0.199: the next term would be below 1e-18 of the first.
    const double square = quarter * quarter;
    double sum = 0;
    for (int n = 25; n >= 1; n -= 2) sum = 1.0 / n - square * sum;
    return 4 * quarter * sum;
}

}  // namespace

double arc_tangent(double y, double x) {
    // Measured from the nearer axis, so that the ratio is at most 1.
    const double wide = std::fabs(x), high = std::fabs(y);
    if (wide == 0 && high == 0) return 0;
    double angle = high <= wide ? arc_tangent_of(high / wide) : std::numbers::pi / 2 - arc_tangent_of(wide / high);
    if (x < 0) angle = std::numbers::pi - angle;
    return y < 0 ? -angle : angle;
}

}  // namespace embody
