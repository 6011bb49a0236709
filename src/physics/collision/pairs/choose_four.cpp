// SPDX-License-Identifier: MIT
#include "physics/collision/pairs/choose_four.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace embody::physics::collision {

namespace {

constexpr double unfit = -std::numeric_limits<double>::infinity();  // the score of a point that adds nothing

/// A line of the plane through two points: `beside` is the distance from it, positive on the left.
struct Line {
    double x = 0, y = 0, along_x = 0, along_y = 0;

    Line(const FlatPoint& from, const FlatPoint& to) : x(from.x), y(from.y) {
        const double dx = to.x - from.x, dy = to.y - from.y;
        const double size = std::sqrt(dx * dx + dy * dy);
        along_x = dx / size;
        along_y = dy / size;
    }
    [[nodiscard]] double beside(const FlatPoint& p) const { return along_x * (p.y - y) - along_y * (p.x - x); }
};

double distance_squared(const FlatPoint& a, const FlatPoint& b) {
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

/// The points and the extents of the whole region.
struct Choice {
    const FlatPoint* points;
    int count;
    ChosenPoints chosen;
    FlatPoint middle{0, 0, 0};
    double lowest = std::numeric_limits<double>::infinity();
    double size = 0;
    double no_length = 0;  ///< extents up to this count as zero

    // Keeps the point of the highest score, unless all are unfit.
    template <class Score>
    bool keep_best(Score&& score) {
        int best = -1;
        double highest = unfit;
        for (int i = 0; i < count; ++i) {
            if (chosen.holds(i)) continue;
            const double value = score(points[i]);
            if (!(best < 0 ? value > unfit : value > highest + 1e-9 * std::fabs(highest))) continue;
            highest = value;
            best = i;
        }
        if (best < 0) return false;
        chosen.index[static_cast<std::size_t>(chosen.count++)] = best;
        return true;
    }
    // Depth counts before area: of two points side by side the lower one carries, and a hull of many vertices has
    // higher ones a little farther out everywhere. `slope`: metres of extent given up for a metre of depth.
    [[nodiscard]] double reach(double length, const FlatPoint& p) const {
        constexpr double slope = 10;  // m/m
        return length > no_length ? length - slope * (p.separation - lowest) : unfit;
    }
    [[nodiscard]] const FlatPoint& kept(int k) const { return points[chosen.index[static_cast<std::size_t>(k)]]; }
};

}  // namespace

ChosenPoints choose_four(const FlatPoint* points, int count) {
    Choice choice{points, count, {}};
    if (count < 2) {
        choice.chosen.count = count;
        return choice.chosen;
    }

    // Centre, depth and size of the whole region.
    for (int i = 0; i < count; ++i) {
        choice.middle.x += points[i].x;
        choice.middle.y += points[i].y;
        choice.lowest = std::min(choice.lowest, points[i].separation);
    }
    choice.middle.x /= count;
    choice.middle.y /= count;
    for (int i = 0; i < count; ++i) choice.size = std::max(choice.size, distance_squared(points[i], choice.middle));
    choice.size = std::sqrt(choice.size);
    choice.no_length = std::max(1e-6 * choice.size, 1e-9);

    // The outermost of the deepest (within a small part of the size), the farthest from it, the farthest from their
    // line, the farthest beyond the triangle.
    const double deep = choice.lowest + 1e-4 * choice.size;
    choice.keep_best(
        [&](const FlatPoint& p) { return p.separation <= deep ? distance_squared(p, choice.middle) : unfit; });
    const FlatPoint first = choice.kept(0);
    const auto from_first = [&](const FlatPoint& p) { return choice.reach(std::sqrt(distance_squared(p, first)), p); };
    if (!choice.keep_best(from_first)) return choice.chosen;
    const FlatPoint second = choice.kept(1);
    const Line base(first, second);
    if (!choice.keep_best([&](const FlatPoint& p) { return choice.reach(std::fabs(base.beside(p)), p); })) {
        return choice.chosen;
    }
    const FlatPoint third = choice.kept(2);
    const double turn = base.beside(third) < 0 ? -1.0 : 1.0;
    const Line side(second, third), back(third, first);
    choice.keep_best([&](const FlatPoint& p) {
        return choice.reach(-std::min({turn * base.beside(p), turn * side.beside(p), turn * back.beside(p)}), p);
    });
    return choice.chosen;
}

namespace {

// Separation at (x, y) by the plane through three points; `otherwise` where they lie on a line.
double by_plane(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c, double x, double y, double otherwise) {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double area = bx * cy - by * cx;
    if (std::fabs(area) < 1e-9 * (bx * bx + by * by + cx * cx + cy * cy)) return otherwise;
    const double px = x - a.x, py = y - a.y;
    const double u = (px * cy - py * cx) / area, v = (bx * py - by * px) / area;
    return a.separation + u * (b.separation - a.separation) + v * (c.separation - a.separation);
}

}  // namespace

bool leaves_unseen(const FlatPoint* points, int count, const ChosenPoints& chosen, double tolerance) {
    if (chosen.count < 3 || chosen.count == count) return false;
    const auto kept = [&](int k) -> const FlatPoint& { return points[chosen.index[static_cast<std::size_t>(k)]]; };
    for (int i = 0; i < count; ++i) {
        const FlatPoint& p = points[i];
        if (chosen.holds(i)) continue;

        // The highest of the planes through three of the four points: the body may come to rest on any three of them.
        double expected = std::numeric_limits<double>::lowest();
        for (int out = chosen.count == 4 ? 0 : 3; out < 4; ++out) {
            const int a = out == 0 ? 1 : 0, b = out <= 1 ? 2 : 1, c = out <= 2 ? 3 : 2;
            expected = std::max(expected, by_plane(kept(a), kept(b), kept(c), p.x, p.y, expected));
        }
        if (p.separation < expected - tolerance) return true;
    }
    return false;
}

}  // namespace embody::physics::collision
