// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/nearest_points.h"

#include <algorithm>

namespace embody::physics::deformable {

// C. Ericson, Real-Time Collision Detection, 5.1.5.
std::array<double, 3> nearest_weights(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

double nearest_along(Vec3 p, Vec3 a, Vec3 b) {
    const Vec3 displacement = b - a;
    const double size = length_squared(displacement);
    return size > 0 ? std::clamp(dot(p - a, displacement) / size, 0.0, 1.0) : 0;
}

bool nearest_inside(Vec3 a, Vec3 b, Vec3 c, Vec3 d, double& s, double& t) {
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double spread = uu * vv - uv * uv;
    constexpr double parallel = 1e-6;  // square of the angle between them, rad²: rounding of places in floats is less
    if (!(spread > parallel * uu * vv)) return false;
    s = (uv * vw - vv * uw) / spread;
    t = (uu * vw - uv * uw) / spread;
    return s > 0 && s < 1 && t > 0 && t < 1;
}

// C. Ericson, Real-Time Collision Detection, 5.1.9: the lines' nearest points, or an end and what is nearest to it.
std::array<double, 2> nearest_between(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double spread = uu * vv - uv * uv;
    double s = spread > 0 ? std::clamp((uv * vw - vv * uw) / spread, 0.0, 1.0) : 0;
    double t = vv > 0 ? (uv * s + vw) / vv : 0;
    if (t >= 0 && t <= 1) return {s, t};
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0;
    return {s, t};
}

}  // namespace embody::physics::deformable
