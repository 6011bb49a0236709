// SPDX-License-Identifier: MIT
// E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex objects in
// three-dimensional space", 1988. The point of a simplex nearest to the origin is found by Voronoi regions
// (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1), in doubles.
#include "physics/collision/gjk.h"

#include <cmath>

namespace embody::physics {

namespace {

using Simplex = std::array<DifferencePoint, 4>;

/// Nearest point of a simplex to the origin: the corners that carry it and their weights.
struct NearestPoint {
    int size = 0;
    std::array<int, 4> corner{};
    std::array<double, 4> weight{};
    Vec3 point;
};

NearestPoint nearest_on_vertex(const Simplex& s, int a) {
    return {1, {a}, {1.0}, s[static_cast<std::size_t>(a)].difference};
}

NearestPoint nearest_on_edge(const Simplex& s, int a, int b) {
    const Vec3 p = s[static_cast<std::size_t>(a)].difference, q = s[static_cast<std::size_t>(b)].difference;
    const Vec3 along = q - p;
    const double t = -dot(p, along), whole = dot(along, along);
    if (t <= 0) return nearest_on_vertex(s, a);
    if (t >= whole) return nearest_on_vertex(s, b);
    const double w = t / whole;
    return {2, {a, b}, {1 - w, w}, p + along * w};
}

NearestPoint nearest_on_triangle(const Simplex& s, int a, int b, int c) {
    const Vec3 p = s[static_cast<std::size_t>(a)].difference;
    const Vec3 q = s[static_cast<std::size_t>(b)].difference;
    const Vec3 r = s[static_cast<std::size_t>(c)].difference;
    const Vec3 n = cross(q - p, r - p);
    const double nn = dot(n, n);

    // Barycentric weights of the origin's projection, as areas against the normal.
    const double wa = dot(n, cross(q, r)), wb = dot(n, cross(r, p)), wc = dot(n, cross(p, q));
    if (nn > 0 && wa > 0 && wb > 0 && wc > 0) {
        const double sum = wa + wb + wc;
        return {3, {a, b, c}, {wa / sum, wb / sum, wc / sum}, n * (dot(n, p) / nn)};
    }
    // Outside of the triangle's prism: the nearest of its edges.
    NearestPoint best = nearest_on_edge(s, a, b);
    for (const NearestPoint& other : {nearest_on_edge(s, b, c), nearest_on_edge(s, c, a)}) {
        if (length_squared(other.point) < length_squared(best.point)) best = other;
    }
    return best;
}

// Whether the origin lies beyond the face a b c as seen from corner d.
bool beyond_face(const Simplex& s, int a, int b, int c, int d) {
    const Vec3 p = s[static_cast<std::size_t>(a)].difference;
    const Vec3 n = cross(s[static_cast<std::size_t>(b)].difference - p, s[static_cast<std::size_t>(c)].difference - p);
    const double origin_side = -dot(n, p);
    const double inner_side = dot(n, s[static_cast<std::size_t>(d)].difference - p);
    return origin_side * inner_side <= 0;
}

NearestPoint nearest_on_tetrahedron(const Simplex& s) {
    static constexpr int faces[4][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 3, 2, 0}};
    NearestPoint best;
    for (const auto& f : faces) {
        if (!beyond_face(s, f[0], f[1], f[2], f[3])) continue;
        const NearestPoint other = nearest_on_triangle(s, f[0], f[1], f[2]);
        if (best.size == 0 || length_squared(other.point) < length_squared(best.point)) best = other;
    }
    // Beyond no face: the origin is inside.
    if (best.size == 0) best.size = 4;
    return best;
}

NearestPoint nearest_on_simplex(const Simplex& s, int size) {
    if (size == 1) return nearest_on_vertex(s, 0);
    if (size == 2) return nearest_on_edge(s, 0, 1);
    if (size == 3) return nearest_on_triangle(s, 0, 1, 2);
    return nearest_on_tetrahedron(s);
}

bool holds(const CoreDistance& state, Vec3 difference) {
    for (int i = 0; i < state.simplex_size; ++i) {
        if (state.simplex[static_cast<std::size_t>(i)].difference == difference) return true;
    }
    return false;
}

// Drops the corners that do not carry the nearest point and reads off the witness points.
void keep_carriers(CoreDistance& state, const NearestPoint& nearest) {
    Simplex kept;
    state.on_a = state.on_b = {};
    for (int i = 0; i < nearest.size; ++i) {
        const auto slot = static_cast<std::size_t>(i);
        kept[slot] = state.simplex[static_cast<std::size_t>(nearest.corner[slot])];
        state.on_a += kept[slot].on_a * nearest.weight[slot];
        state.on_b += kept[slot].on_b * nearest.weight[slot];
    }
    state.simplex = kept;
    state.simplex_size = nearest.size;
    state.distance = length(nearest.point);
}

}  // namespace

DifferencePoint difference_support(const PlacedConvex& a, const PlacedConvex& b, Vec3 direction) {
    const Vec3 on_a = core_support(a, -direction), on_b = core_support(b, direction);
    return {on_b - on_a, on_a, on_b};
}

CoreDistance core_distance(const PlacedConvex& a, const PlacedConvex& b, double enough) {
    constexpr int most_iterations = 100;
    // Relative to the size of the coordinates: what rounding leaves of a distance of zero.
    constexpr double zero = 1e-14;
    constexpr double converged = 1e-12;

    CoreDistance state;
    Vec3 start = interior_point(b) - interior_point(a);
    if (length_squared(start) == 0) start = {1, 0, 0};
    state.simplex[0] = difference_support(a, b, -start);
    state.simplex_size = 1;
    keep_carriers(state, nearest_on_vertex(state.simplex, 0));
    Vec3 nearest = state.simplex[0].difference;
    double scale = length(nearest);

    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        if (state.distance <= zero * scale) {
            state.overlap = true;
            break;
        }
        const DifferencePoint next = difference_support(a, b, -nearest);
        scale = std::fmax(scale, length(next.difference));
        const double squared = length_squared(nearest), lower = dot(nearest, next.difference);

        // No nearer in this direction, or farther than anyone asks for.
        if (squared - lower <= converged * squared || holds(state, next.difference)) break;
        if (lower > 0 && lower > enough * state.distance) {
            state.distance = lower / state.distance;
            break;
        }
        CoreDistance trial = state;
        trial.simplex[static_cast<std::size_t>(trial.simplex_size++)] = next;
        const NearestPoint found = nearest_on_simplex(trial.simplex, trial.simplex_size);
        if (found.size == 4) {
            state = trial;
            state.overlap = true;
            break;
        }
        // Rounding lets a flat simplex step back; the last one is then as near as doubles tell.
        if (length_squared(found.point) >= squared) break;
        state = trial;
        keep_carriers(state, found);
        nearest = found.point;
    }
    if (state.overlap) state.distance = 0;
    return state;
}

}  // namespace embody::physics
