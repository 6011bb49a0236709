// SPDX-License-Identifier: MIT
// Ear clipping: G. H. Meisters, Polygons Have Ears, American Mathematical Monthly 82, 1975.
#include "interchange/polygon.h"

#include <algorithm>
#include <numeric>

namespace embody::interchange {
namespace {

// Ear clipping takes a time that grows with the square of the number of corners and, for odd shapes, with its cube.
constexpr std::size_t max_corners = 1000;

/// Newell's normal: twice the area, whatever the corners' order and flatness.
Vec3 normal_of(std::span<const Vec3f> corners) {
    Vec3 normal;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    }
    return normal;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of_polygon(std::span<const Vec3f> corners) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (corners.size() < 3) return triangles;
    if (corners.size() > max_corners) {
        for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({0, i, i + 1});
        return triangles;
    }
    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    const Vec3 up = normal_of(corners);
    const auto at = [&](std::size_t i) { return to_vec3(corners[left[i % left.size()]]); };
    const auto turn = [&](Vec3 a, Vec3 b, Vec3 c) { return dot(cross(b - a, c - a), up); };

    // An ear is a corner that turns as the polygon does, with no other corner in its triangle.
    const auto is_ear = [&](std::size_t i) {
        const std::size_t n = left.size();
        const Vec3 a = at(i + n - 1), b = at(i), c = at(i + 1);
        if (!(turn(a, b, c) > 0)) return false;
        for (std::size_t k = i + 2; k < i + n - 1; ++k) {
            const Vec3 p = at(k);
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0 && p != a && p != b && p != c)
                return false;
        }
        return true;
    };
    while (left.size() > 3) {
        std::size_t ear = 0;
        while (ear < left.size() && !is_ear(ear)) ++ear;
        // A polygon that crosses itself or has no area has no ear: any corner will do.
        if (ear == left.size()) ear = 1;
        const std::size_t n = left.size();
        triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

}  // namespace embody::interchange
