// SPDX-License-Identifier: MIT
#include "geometry/flat_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace embody::geometry {

namespace {

using Loop = std::vector<std::size_t>;

// Twice the area of the triangle a, b, c; positive where it turns from the first axis to the second.
double turn(FlatPoint a, FlatPoint b, FlatPoint c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool is_in_triangle(FlatPoint p, FlatPoint a, FlatPoint b, FlatPoint c) {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool is_on_side(FlatPoint p, FlatPoint a, FlatPoint b) {
    return turn(a, b, p) == 0 && std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) &&
           std::min(a[1], b[1]) <= p[1] && p[1] <= std::max(a[1], b[1]);
}

bool do_sides_meet(FlatPoint a, FlatPoint b, FlatPoint c, FlatPoint d) {
    const double ta = turn(c, d, a), tb = turn(c, d, b), tc = turn(a, b, c), td = turn(a, b, d);
    if (((ta > 0 && tb < 0) || (ta < 0 && tb > 0)) && ((tc > 0 && td < 0) || (tc < 0 && td > 0))) return true;
    return is_on_side(a, c, d) || is_on_side(b, c, d) || is_on_side(c, a, b) || is_on_side(d, a, b);
}

// The corners in positive order, without those that lie on the line of their neighbours.
FlatPolygon tidied(const FlatPolygon& polygon) {
    constexpr double flattest = 1e-9;  // of the extent: height of a corner over its neighbours' line
    FlatPolygon left = polygon;
    if (signed_area(left) < 0) std::reverse(left.begin(), left.end());
    bool has_changed = true;
    while (has_changed && left.size() >= 3) {
        has_changed = false;
        for (std::size_t i = 0; i < left.size() && left.size() >= 3; ++i) {
            const FlatPoint a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
            const double long_side =
                std::max(std::hypot(b[0] - a[0], b[1] - a[1]), std::hypot(c[0] - b[0], c[1] - b[1]));
            if (std::fabs(turn(a, b, c)) > flattest * long_side * long_side) continue;
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            has_changed = true;
        }
    }
    return left;
}

bool is_ear(const FlatPolygon& corners, const Loop& left, std::size_t i) {
    const std::size_t before = left[(i + left.size() - 1) % left.size()], after = left[(i + 1) % left.size()];
    const FlatPoint a = corners[before], b = corners[left[i]], c = corners[after];
    if (turn(a, b, c) <= 0) return false;
    return std::none_of(left.begin(), left.end(), [&](std::size_t other) {
        return other != before && other != left[i] && other != after && is_in_triangle(corners[other], a, b, c);
    });
}

std::vector<Loop> cut_ears(const FlatPolygon& corners) {
    std::vector<Loop> triangles;
    Loop left(corners.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() > 3) {
        std::size_t ear = 0;
        while (ear < left.size() && !is_ear(corners, left, ear)) ++ear;
        if (ear == left.size()) break;  // only rounding can take the last ears away
        triangles.push_back({left[(ear + left.size() - 1) % left.size()], left[ear], left[(ear + 1) % left.size()]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (left.size() == 3) triangles.push_back(left);
    return triangles;
}

bool is_convex(const FlatPolygon& corners, const Loop& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const FlatPoint a = corners[loop[i]], b = corners[loop[(i + 1) % loop.size()]],
                        c = corners[loop[(i + 2) % loop.size()]];
        if (turn(a, b, c) < 0) return false;
    }
    return true;
}

// The union of two loops that share a side; empty where they share none or the union is not convex.
Loop joined(const FlatPolygon& corners, const Loop& a, const Loop& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        const std::size_t from = a[i], to = a[(i + 1) % a.size()];
        const auto place = std::find(b.begin(), b.end(), to);
        if (place == b.end()) continue;
        const auto at = static_cast<std::size_t>(place - b.begin());
        if (b[(at + 1) % b.size()] != from) continue;
        // Around a from the end of the shared side back to its start, then around the rest of b.
        Loop both;
        for (std::size_t k = 0; k < a.size(); ++k) both.push_back(a[(i + 1 + k) % a.size()]);
        for (std::size_t k = 2; k < b.size(); ++k) both.push_back(b[(at + k) % b.size()]);
        if (is_convex(corners, both)) return both;
    }
    return {};
}

void join_pieces(const FlatPolygon& corners, std::vector<Loop>& pieces) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (std::size_t j = i + 1; j < pieces.size();) {
            Loop both = joined(corners, pieces[i], pieces[j]);
            if (both.empty()) {
                ++j;
                continue;
            }
            pieces[i] = std::move(both);
            pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;
        }
    }
}

// The part on one side of a value of the first coordinate: above it where `sign` is 1, below where it is -1.
FlatPolygon half(const FlatPolygon& polygon, double at, double sign) {
    FlatPolygon left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const FlatPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = sign * (a[0] - at), db = sign * (b[0] - at);
        if (da >= 0) left.push_back(a);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) left.push_back({at, a[1] + (b[1] - a[1]) * da / (da - db)});
    }
    return left;
}

}  // namespace

double signed_area(const FlatPolygon& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        twice += turn(polygon[0], polygon[i], polygon[(i + 1) % polygon.size()]);
    return twice / 2;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_sides(const FlatPolygon& polygon) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        const FlatPoint a = polygon[i], b = polygon[(i + 1) % n];
        // The next side may only share a corner: it must not go back along this one.
        const FlatPoint c = polygon[(i + 2) % n];
        if (n > 2 && turn(a, b, c) == 0 && (c[0] - b[0]) * (b[0] - a[0]) + (c[1] - b[1]) * (b[1] - a[1]) <= 0)
            return std::pair{i, (i + 1) % n};
        for (std::size_t j = i + 2; j < n; ++j) {
            if (i == 0 && j == n - 1) continue;
            if (do_sides_meet(a, b, polygon[j], polygon[(j + 1) % n])) return std::pair{i, j};
        }
    }
    return std::nullopt;
}

std::vector<FlatPolygon> convex_pieces(const FlatPolygon& polygon) {
    const FlatPolygon corners = tidied(polygon);
    if (corners.size() < 3) return {};
    std::vector<Loop> loops = cut_ears(corners);
    join_pieces(corners, loops);
    std::vector<FlatPolygon> pieces;
    for (const Loop& loop : loops) {
        pieces.emplace_back();
        for (const std::size_t corner : loop) pieces.back().push_back(corners[corner]);
    }
    return pieces;
}

FlatPolygon clipped(const FlatPolygon& polygon, double from, double to) {
    FlatPolygon left = half(half(polygon, from, 1), to, -1);
    return left.size() < 3 ? FlatPolygon{} : left;
}

}  // namespace embody::geometry
