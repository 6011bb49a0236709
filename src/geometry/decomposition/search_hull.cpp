// SPDX-License-Identifier: MIT
//
// The incremental hull of C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull algorithm for convex hulls", ACM
// Trans. on Mathematical Software 22(4), 1996: the farthest point outside is joined with the horizon that it sees. Here
// it stops as soon as no point lies farther outside than a tolerance, which gives most of its speed.
#include "geometry/decomposition/search_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace embody::geometry {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};
constexpr std::size_t most_vertices = 256;
constexpr double visible_share = 1e-10;  // of the size: nearer to a plane counts as below it

template <class Measure>
std::uint32_t index_of_largest(std::span<const Vec3> points, Measure measure) {
    std::uint32_t best = 0;
    double most = measure(points[0]);
    for (std::uint32_t i = 1; i < points.size(); ++i) {
        const double value = measure(points[i]);
        if (value > most) {
            most = value;
            best = i;
        }
    }
    return best;
}

// Three points far from each other: a triangle, or less where the points lie on a line or in one place.
std::array<std::uint32_t, 3> wide_triangle(std::span<const Vec3> points) {
    const auto a = index_of_largest(points, [](Vec3 p) { return -(p.x + 1.01 * p.y + 0.99 * p.z); });
    const auto b = index_of_largest(points, [&](Vec3 p) { return length_squared(p - points[a]); });
    const Vec3 along = normalized(points[b] - points[a], {1, 0, 0});
    const auto c = index_of_largest(points, [&](Vec3 p) { return length_squared(cross(p - points[a], along)); });
    return {a, b, c};
}

class Builder {
public:
    Builder(std::span<const Vec3> points, double tolerance, double size)
        : points_(points), tolerance_(tolerance), visible_(visible_share * size), next_(points.size(), none) {}

    bool run(std::array<std::uint32_t, 4> simplex);
    SearchHull take();

private:
    struct Face {
        std::array<std::uint32_t, 3> corner{};
        std::array<std::uint32_t, 3> across{};  // the face beyond the side corner[i] → corner[i + 1]
        CutPlane plane;
        std::uint32_t outside = none;  // first of the points that wait above it
        std::uint32_t farthest = none;
        double height = 0;  // of the farthest
        bool gone = false;
    };
    struct Side {
        std::uint32_t start, end, face;
    };

    std::uint32_t add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void let_wait(std::uint32_t point, std::uint32_t first_face);
    bool find_horizon(std::uint32_t eye, std::uint32_t seen);
    bool add(std::uint32_t eye, std::uint32_t seen);

    std::span<const Vec3> points_;
    double tolerance_, visible_;
    std::vector<Face> faces_;
    std::vector<std::uint32_t> next_;  // of the waiting points
    std::vector<Side> horizon_;
    std::vector<std::uint32_t> hidden_;  // faces that the new point sees
};

std::uint32_t Builder::add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    Face face;
    face.corner = {a, b, c};
    face.plane.normal = normalized(cross(points_[b] - points_[a], points_[c] - points_[a]));
    face.plane.offset = dot(face.plane.normal, (points_[a] + points_[b] + points_[c]) / 3);
    faces_.push_back(face);
    return static_cast<std::uint32_t>(faces_.size() - 1);
}

// Puts the point above the first face, from `first_face` on, that it is clearly outside of.
void Builder::let_wait(std::uint32_t point, std::uint32_t first_face) {
    for (std::uint32_t f = first_face; f < faces_.size(); ++f) {
        Face& face = faces_[f];
        const double height = face.plane.height(points_[point]);
        if (face.gone || height <= tolerance_) continue;
        next_[point] = face.outside;
        face.outside = point;
        if (height > face.height) {
            face.height = height;
            face.farthest = point;
        }
        return;
    }
}

// The sides around all faces that `eye` sees, in order; false where rounding left no single loop.
bool Builder::find_horizon(std::uint32_t eye, std::uint32_t seen) {
    horizon_.clear();
    hidden_.clear();
    // Depth first, each face's sides in order from the one it was entered by: the horizon comes out as one loop.
    faces_[seen].gone = true;
    hidden_.push_back(seen);
    struct Step {
        std::uint32_t face;
        int first, done;
    };
    std::vector<Step> stack{{seen, 0, 0}};
    while (!stack.empty()) {
        Step& step = stack.back();
        const int sides = stack.size() == 1 ? 3 : 2;  // the entering side is not walked again
        if (step.done == sides) {
            stack.pop_back();
            continue;
        }
        const auto side = static_cast<std::size_t>((step.first + step.done) % 3);
        ++step.done;
        const std::uint32_t from = step.face;
        const std::uint32_t start = faces_[from].corner[side], end = faces_[from].corner[(side + 1) % 3];
        const std::uint32_t beyond = faces_[from].across[side];
        if (faces_[beyond].gone) continue;
        if (faces_[beyond].plane.height(points_[eye]) <= visible_) {
            horizon_.push_back({start, end, beyond});
            continue;
        }
        faces_[beyond].gone = true;
        hidden_.push_back(beyond);
        int entered = 0;
        while (entered < 3 && faces_[beyond].across[static_cast<std::size_t>(entered)] != from) ++entered;
        stack.push_back({beyond, entered + 1, 0});
    }
    if (horizon_.size() < 3) return false;
    for (std::size_t i = 0; i < horizon_.size(); ++i) {
        if (horizon_[i].end != horizon_[(i + 1) % horizon_.size()].start) return false;
    }
    return true;
}

bool Builder::add(std::uint32_t eye, std::uint32_t seen) {
    if (!find_horizon(eye, seen)) return false;
    const auto first = static_cast<std::uint32_t>(faces_.size());
    const auto count = static_cast<std::uint32_t>(horizon_.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const Side side = horizon_[i];
        const std::uint32_t f = add_face(side.start, side.end, eye);
        faces_[f].across = {side.face, first + (i + 1) % count, first + (i + count - 1) % count};
        Face& beyond = faces_[side.face];
        for (std::size_t k = 0; k < 3; ++k) {
            if (beyond.corner[k] == side.end && beyond.corner[(k + 1) % 3] == side.start) beyond.across[k] = f;
        }
    }
    // Points that waited above the removed faces wait above the new ones, or lie inside now.
    for (const std::uint32_t f : hidden_) {
        for (std::uint32_t p = faces_[f].outside; p != none;) {
            const std::uint32_t after = next_[p];
            if (p != eye) let_wait(p, first);
            p = after;
        }
        faces_[f].outside = none;
    }
    return true;
}

bool Builder::run(std::array<std::uint32_t, 4> s) {
    if (dot(cross(points_[s[1]] - points_[s[0]], points_[s[2]] - points_[s[0]]), points_[s[3]] - points_[s[0]]) > 0) {
        std::swap(s[1], s[2]);
    }
    // For a tetrahedron with s[3] below the triangle s[0] s[1] s[2].
    add_face(s[0], s[1], s[2]);
    add_face(s[0], s[3], s[1]);
    add_face(s[1], s[3], s[2]);
    add_face(s[2], s[3], s[0]);
    faces_[0].across = {1, 2, 3};
    faces_[1].across = {3, 2, 0};
    faces_[2].across = {1, 3, 0};
    faces_[3].across = {2, 1, 0};
    for (std::uint32_t p = 0; p < points_.size(); ++p) let_wait(p, 0);

    for (std::size_t vertices = 4; vertices < most_vertices; ++vertices) {
        std::uint32_t best = none;
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].gone || faces_[f].farthest == none) continue;
            if (best == none || faces_[f].height > faces_[best].height) best = f;
        }
        if (best == none) return true;
        if (!add(faces_[best].farthest, best)) return false;
    }
    return true;
}

SearchHull Builder::take() {
    SearchHull hull;
    std::vector<std::uint32_t> index(points_.size(), none);
    for (const Face& face : faces_) {
        if (face.gone) continue;
        std::array<std::uint32_t, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t& known = index[face.corner[k]];
            if (known == none) {
                known = static_cast<std::uint32_t>(hull.vertices.size());
                hull.vertices.push_back(points_[face.corner[k]]);
                hull.box.add(points_[face.corner[k]]);
            }
            corner[k] = known;
        }
        hull.triangles.push_back(corner);
        if (face.plane.normal != Vec3{}) hull.planes.push_back(face.plane);
    }
    const Vec3 origin = hull.box.center();
    for (const auto& t : hull.triangles) {
        hull.volume +=
            dot(hull.vertices[t[0]] - origin, cross(hull.vertices[t[1]] - origin, hull.vertices[t[2]] - origin)) / 6;
    }
    return hull;
}

// The bounding box, where rounding made the hull fail.
SearchHull box_hull(const Bounds& box) {
    SearchHull hull;
    hull.box = box;
    for (int i = 0; i < 8; ++i) {
        hull.vertices.push_back(
            {i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y, i & 4 ? box.upper.z : box.lower.z});
    }
    hull.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (int k = 0; k < 3; ++k) {
        Vec3 normal;
        normal[k] = 1;
        hull.planes.push_back({normal, box.upper[k]});
        hull.planes.push_back({-normal, -box.lower[k]});
    }
    const Vec3 size = box.size();
    hull.volume = size.x * size.y * size.z;
    return hull;
}

}  // namespace

double SearchHull::height(Vec3 p) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const CutPlane& plane : planes) most = std::max(most, plane.height(p));
    return most;
}

std::vector<Vec3> thickened(std::span<const Vec3> points, double least_thickness) {
    std::vector<Vec3> result(points.begin(), points.end());
    // Once for each direction in which the points may be flat: a sheet, a line, a point.
    for (int round = 0; round < 3; ++round) {
        if (result.empty()) return result;
        const auto t = wide_triangle(result);
        const Vec3 along = normalized(result[t[1]] - result[t[0]], {1, 0, 0});
        const Vec3 side = result[t[2]] - result[t[0]];
        const Vec3 across = side - dot(side, along) * along;
        const bool is_line = length(across) < 1e-6 * distance(result[t[0]], result[t[1]]) || length(across) < 1e-12;
        const Vec3 normal = is_line ? any_perpendicular(along) : normalized(cross(along, across));

        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3 p : result) {
            const double at = dot(normal, p);
            low = std::min(low, at);
            high = std::max(high, at);
        }
        const double missing = least_thickness - (high - low);
        if (missing <= 1e-9 * least_thickness) return result;
        const std::size_t count = result.size();
        for (std::size_t i = 0; i < count; ++i) {
            result.push_back(result[i] + 0.5 * missing * normal);
            result[i] -= 0.5 * missing * normal;
        }
    }
    return result;
}

SearchHull build_search_hull(std::span<const Vec3> points, double tolerance, double least_thickness) {
    if (points.empty()) return {};
    Bounds box;
    for (const Vec3 p : points) box.add(p);
    const double size = length(box.size()) + least_thickness;

    const auto t = wide_triangle(points);
    const Vec3 across = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    const Vec3 normal = normalized(across, {0, 1, 0});
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::uint32_t lowest = 0, highest = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const double at = dot(normal, points[i]);
        if (at < low) low = at, lowest = i;
        if (at > high) high = at, highest = i;
    }
    const double base = dot(normal, points[t[0]]);
    const bool has_triangle = length(across) > 1e-9 * size * least_thickness;
    if (!has_triangle || high - low < 0.999 * least_thickness) {
        const std::vector<Vec3> thick = thickened(points, least_thickness);
        if (thick.size() == points.size()) return box_hull(enlarged(box, least_thickness / 2));
        return build_search_hull(thick, tolerance, 0.5 * least_thickness);
    }
    Builder builder(points, tolerance, size);
    if (!builder.run({t[0], t[1], t[2], high - base > base - low ? highest : lowest})) return box_hull(box);
    return builder.take();
}

}  // namespace embody::geometry
