// SPDX-License-Identifier: MIT
#include "geometry/triangle_distance.h"

#include <algorithm>

namespace embody::geometry {

// Closest point by the regions of the triangle's plane (C. Ericson, Real-Time Collision Detection, 2005, 5.1.5).
double squared_distance(Vec3 p, const std::array<Vec3, 3>& t) {
    const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return length_squared(ap);
    const Vec3 bp = p - t[1];
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return length_squared(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return length_squared(ap - (d1 / (d1 - d3)) * ab);
    const Vec3 cp = p - t[2];
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return length_squared(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return length_squared(ap - (d2 / (d2 - d6)) * ac);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return length_squared(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]));
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return std::min({length_squared(ap), length_squared(bp), length_squared(cp)});
    return length_squared(ap - (vb / sum) * ab - (vc / sum) * ac);
}

}  // namespace embody::geometry
