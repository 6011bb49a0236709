// SPDX-License-Identifier: MIT
// E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex objects in
// three-dimensional space", 1988. The point of a simplex nearest to the origin is found by Voronoi regions
// (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1), in doubles.
#include "physics/collision/queries/gjk.h"

#include <cmath>
#include <utility>

namespace embody::physics::collision {

namespace {

using Simplex = std::array<DifferencePoint, 4>;

/// Nearest point of a simplex to the origin: the corners that define it and their weights.
struct NearestPoint {
    int size;
    int corner[4];
    double weight[4];
    Vec3 point;
};

Vec3 corner(const Simplex& s, int i) { return s[static_cast<std::size_t>(i)].difference; }

NearestPoint nearest_on_vertex(const Simplex& s, int a) { return {1, {a}, {1.0}, corner(s, a)}; }

NearestPoint nearest_on_edge(const Simplex& s, int a, int b) {
    const Vec3 p = corner(s, a), along = corner(s, b) - p;
    const double t = -dot(p, along), whole = dot(along, along);
    if (t <= 0) return nearest_on_vertex(s, a);
    if (t >= whole) return nearest_on_vertex(s, b);
    const double w = t / whole;
    return {2, {a, b}, {1 - w, w}, p + along * w};
}

void take_nearer(NearestPoint& best, const NearestPoint& other) {
    if (best.size == 0 || length_squared(other.point) < length_squared(best.point)) best = other;
}

// `n`: its normal, of any length.
NearestPoint nearest_on_triangle(const Simplex& s, int a, int b, int c, Vec3 n) {
    const Vec3 p = corner(s, a), q = corner(s, b), r = corner(s, c);
    const double nn = dot(n, n);

    // Barycentric weights of the origin's projection, as areas against the normal.
    const double wa = dot(n, cross(q, r)), wb = dot(n, cross(r, p)), wc = dot(n, cross(p, q));
    if (nn > 0 && wa > 0 && wb > 0 && wc > 0) {
        const double sum = wa + wb + wc;
        return {3, {a, b, c}, {wa / sum, wb / sum, wc / sum}, n * (dot(n, p) / nn)};
    }
    // Outside of the triangle's prism: the nearest of the edges that it is beyond.
    NearestPoint best;
    best.size = 0;
    if (!(wc > 0)) take_nearer(best, nearest_on_edge(s, a, b));
    if (!(wa > 0)) take_nearer(best, nearest_on_edge(s, b, c));
    if (!(wb > 0)) take_nearer(best, nearest_on_edge(s, c, a));
    if (best.size == 0) best = nearest_on_edge(s, a, b);
    return best;
}

Vec3 triangle_normal(const Simplex& s, int a, int b, int c) {
    return cross(corner(s, b) - corner(s, a), corner(s, c) - corner(s, a));
}

// The last corner is the new one: the origin is on its side of the three others' face. `is_outside`: the origin is
// known to be outside, which a nearly flat tetrahedron (three points of a rim and a triangle) cannot decide by itself.
NearestPoint nearest_on_tetrahedron(const Simplex& s, bool is_outside) {
    static constexpr int faces[3][4] = {{0, 1, 3, 2}, {0, 3, 2, 1}, {1, 2, 3, 0}};
    NearestPoint best;
    best.size = 0;
    for (const auto& f : faces) {
        // The origin and the fourth corner on the same side: not beyond this face.
        const Vec3 n = triangle_normal(s, f[0], f[1], f[2]), p = corner(s, f[0]);
        if (-dot(n, p) * dot(n, corner(s, f[3]) - p) > 0) continue;
        take_nearer(best, nearest_on_triangle(s, f[0], f[1], f[2], n));
    }
    if (best.size > 0) return best;
    // Beyond no face: the origin is inside.
    best.size = 4;
    if (!is_outside) return best;
    best.size = 0;
    for (const auto& f : faces) {
        take_nearer(best, nearest_on_triangle(s, f[0], f[1], f[2], triangle_normal(s, f[0], f[1], f[2])));
    }
    return best;
}

NearestPoint nearest_on_simplex(const Simplex& s, int size, bool is_outside) {
    if (size == 1) return nearest_on_vertex(s, 0);
    if (size == 2) return nearest_on_edge(s, 0, 1);
    if (size == 3) return nearest_on_triangle(s, 0, 1, 2, triangle_normal(s, 0, 1, 2));
    return nearest_on_tetrahedron(s, is_outside);
}

bool holds(const CoreDistance& state, Vec3 difference) {
    for (int i = 0; i < state.simplex_size; ++i) {
        if (corner(state.simplex, i) == difference) return true;
    }
    return false;
}

// Drops the corners that do not define the nearest point; the order of the others stays.
void keep_carriers(CoreDistance& state, NearestPoint& nearest) {
    for (int i = 1; i < nearest.size; ++i) {
        for (int k = i; k > 0 && nearest.corner[k] < nearest.corner[k - 1]; --k) {
            std::swap(nearest.corner[k], nearest.corner[k - 1]);
            std::swap(nearest.weight[k], nearest.weight[k - 1]);
        }
    }
    for (int i = 0; i < nearest.size; ++i) {
        if (nearest.corner[i] == i) continue;
        state.simplex[static_cast<std::size_t>(i)] = state.simplex[static_cast<std::size_t>(nearest.corner[i])];
    }
    state.simplex_size = nearest.size;
}

// The points of both shapes by the weights of these corners.
void read_witnesses(CoreDistance& state, const NearestPoint& nearest) {
    state.on_a = state.on_b = {};
    for (int i = 0; i < nearest.size; ++i) {
        state.on_a += state.simplex[static_cast<std::size_t>(i)].on_a * nearest.weight[i];
        state.on_b += state.simplex[static_cast<std::size_t>(i)].on_b * nearest.weight[i];
    }
}

}  // namespace

DifferencePoint difference_support(const Core& a, const Core& b, Vec3 direction) {
    const Vec3 on_a = a.support(-direction), on_b = b.support(direction);
    return {on_b - on_a, on_a, on_b};
}

CoreDistance core_distance(const Core& a, const Core& b, double enough, Vec3 start, double converged) {
    constexpr int max_iterations = 100;  // supports; the nearest simplex so far serves then
    // Relative to the size of the coordinates: what rounding leaves of a distance of zero.
    constexpr double zero = 1e-14;

    CoreDistance state;
    if (length_squared(start) == 0) start = b.interior() - a.interior();
    if (length_squared(start) == 0) start = {1, 0, 0};
    state.simplex[0] = difference_support(a, b, -start);
    state.simplex_size = 1;
    NearestPoint nearest = nearest_on_vertex(state.simplex, 0);
    double squared = length_squared(nearest.point), scale = std::sqrt(squared);

    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        if (squared <= zero * zero * scale * scale) {
            state.overlap = true;
            break;
        }
        const DifferencePoint next = difference_support(a, b, -nearest.point);
        scale = std::fmax(scale,
                          std::fabs(next.difference.x) + std::fabs(next.difference.y) + std::fabs(next.difference.z));
        const double lower = dot(nearest.point, next.difference);

        // No nearer point in this direction, or farther than the caller's limit.
        if (squared - lower <= converged * squared || holds(state, next.difference)) break;
        if (lower > 0 && enough < 1e150 && lower * lower > enough * enough * squared) {
            read_witnesses(state, nearest);
            state.distance = lower / std::sqrt(squared);
            state.direction = nearest.point;
            state.is_final = false;
            return state;
        }
        state.simplex[static_cast<std::size_t>(state.simplex_size)] = next;
        // A plane certainly separates the two where the support point is beyond the origin by more than rounding.
        const bool is_apart = lower > 1e-12 * scale * std::sqrt(squared);
        NearestPoint found = nearest_on_simplex(state.simplex, state.simplex_size + 1, is_apart);
        if (found.size == 4) {
            ++state.simplex_size;
            state.overlap = true;
            break;
        }
        // Rounding lets a flat simplex step back; the last one is then as near as doubles can represent.
        const double found_squared = length_squared(found.point);
        if (found_squared >= squared) break;
        ++state.simplex_size;
        keep_carriers(state, found);
        nearest = found;
        squared = found_squared;
    }
    if (nearest.size < 4) read_witnesses(state, nearest);
    if (state.overlap) return state;
    state.direction = nearest.point;
    state.distance = std::sqrt(squared);
    return state;
}

}  // namespace embody::physics::collision
