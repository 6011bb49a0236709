// SPDX-License-Identifier: MIT
// Nearest points of triangles, four at a time in floats: C. Ericson, "Real-Time Collision Detection", 2005, section
// 5.1.5, with every case computed and one selected, since which of the seven it is cannot be predicted.
#include "physics/collision/shapes/near_triangles.h"

#include <algorithm>

#include "physics/collision/shapes/triangle_surface.h"

namespace embody::physics::collision {

namespace {

constexpr std::size_t lanes = 4;
using Four = float __attribute__((vector_size(16)));
using FourMask = std::int32_t __attribute__((vector_size(16)));

struct Four3 {
    Four x, y, z;
};
Four3 operator+(const Four3& a, const Four3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Four3 operator-(const Four3& a, const Four3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Four3 operator*(const Four3& a, Four s) { return {a.x * s, a.y * s, a.z * s}; }
Four dot(const Four3& a, const Four3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Four smaller(Four a, Four b) { return a < b ? a : b; }
Four size_of(const Four3& a) {
    const auto size = [](Four f) { return f < Four{} ? -f : f; };
    return size(a.x) + size(a.y) + size(a.z);
}

// The triangles' points nearest to the origin; not a number for triangles without area.
Four3 nearest_to_origin(const Four3& a, const Four3& b, const Four3& c) {
    const Four3 ab = b - a, ac = c - a;
    const Four ab_a = -dot(ab, a), ac_a = -dot(ac, a), ab_b = -dot(ab, b), ac_b = -dot(ac, b);
    const Four ab_c = -dot(ab, c), ac_c = -dot(ac, c);

    // Twice the areas over the sides, times the triangle's own: beyond a side where negative.
    const Four of_c = ab_a * ac_b - ab_b * ac_a, of_b = ab_c * ac_a - ab_a * ac_c, of_a = ab_b * ac_c - ab_c * ac_b;
    const Four to_c = ac_b - ab_b, to_b = ab_c - ac_c, sum = of_a + of_b + of_c;

    // Fractions of ab and ac: inside, then on sides, then at corners, each before the last one.
    const Four zero{}, one = zero + 1;
    Four v = of_b / sum, w = of_c / sum;
    const auto choose = [&](FourMask here, Four fraction_b, Four fraction_c) {
        v = here ? fraction_b : v;
        w = here ? fraction_c : w;
    };
    const Four on_bc = to_c / (to_c + to_b);
    choose((of_a <= zero) & (to_c >= zero) & (to_b >= zero), one - on_bc, on_bc);
    choose((of_b <= zero) & (ac_a >= zero) & (ac_c <= zero), zero, ac_a / (ac_a - ac_c));
    choose((of_c <= zero) & (ab_a >= zero) & (ab_b <= zero), ab_a / (ab_a - ab_b), zero);
    choose((ac_c >= zero) & (ab_c <= ac_c), zero, one);
    choose((ab_b >= zero) & (ac_b <= ab_b), one, zero);
    choose((ab_a <= zero) & (ac_a <= zero), zero, zero);
    return a + ab * v + ac * w;
}

// Four triangles, or the first one repeated, as seen from the point.
struct Batch {
    std::array<std::array<Vec3, 3>, lanes> corners;
    Four3 a, b, c;

    Batch(const TriangleSurface& surface, std::span<const std::uint32_t> triangles, Vec3 point) {
        for (std::size_t i = 0; i < lanes; ++i) {
            if (i < triangles.size()) corners[i] = surface.corners(triangles[i]);
        }
        for (std::size_t i = triangles.size(); i < lanes; ++i) corners[i] = corners[0];
        a = seen_from(point, 0);
        b = seen_from(point, 1);
        c = seen_from(point, 2);
    }
    [[nodiscard]] Four3 seen_from(Vec3 point, std::size_t corner) const {
        const auto lane = [&](std::size_t i) { return to_vec3f(corners[i][corner] - point); };
        const Vec3f p = lane(0), q = lane(1), r = lane(2), s = lane(3);
        return {Four{p.x, q.x, r.x, s.x}, Four{p.y, q.y, r.y, s.y}, Four{p.z, q.z, r.z, s.z}};
    }
};

}  // namespace

void find_near_triangles(const TriangleSurface& surface, std::span<const std::uint32_t> triangles, Vec3 point,
                         double reach, std::vector<NearTriangle>& found) {
    found.clear();
    for (std::size_t first = 0; first < triangles.size(); first += lanes) {
        const auto some = triangles.subspan(first, std::min(lanes, triangles.size() - first));
        const Batch t(surface, some, point);
        const Four3 nearest = nearest_to_origin(t.a, t.b, t.c);

        // Along the line to that point all corners are at least so far: true of any point, and so of a rounded one.
        // The rounding error grows with the triangle.
        const Four squared = dot(nearest, nearest);
        const Four least = smaller(smaller(dot(nearest, t.a), dot(nearest, t.b)), dot(nearest, t.c));
        const Four limit = static_cast<float>(reach) + 1e-6F * (size_of(t.a) + size_of(t.b) + size_of(t.c));
        const FourMask is_far = (least > Four{}) & (least * least > limit * limit * squared);
        for (std::size_t i = 0; i < some.size(); ++i) {
            if (is_far[i] != 0) continue;
            found.push_back({some[i], t.corners[i], -Vec3{nearest.x[i], nearest.y[i], nearest.z[i]}});
        }
    }
    std::sort(found.begin(), found.end(),
              [](const NearTriangle& a, const NearTriangle& b) { return a.index < b.index; });
}

}  // namespace embody::physics::collision
