// SPDX-License-Identifier: MIT
#include "benches/race/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace embody::race {
namespace {

constexpr double same_direction = 1 - 1e-9;

Vec3 corner(const RaceShape& shape, int index) { return shape.vertices[static_cast<std::size_t>(index)]; }

/// Twice the triangle's area along its outward normal.
Vec3 area_vector(const RaceShape& shape, const std::array<int, 3>& t) {
    return cross(corner(shape, t[1]) - corner(shape, t[0]), corner(shape, t[2]) - corner(shape, t[0]));
}

/// Adds the direction of `v` unless it is in the list; a line has no sign.
void add_direction(std::vector<Vec3>& directions, Vec3 v, bool is_line) {
    if (length(v) < 1e-12) return;
    const Vec3 unit = v * (1 / length(v));
    for (const Vec3 other : directions) {
        const double cosine = dot(other, unit);
        if (cosine > same_direction || (is_line && cosine < -same_direction)) return;
    }
    directions.push_back(unit);
}

/// Volume as the sum of tetrahedra with the origin; translates the vertices so that the centroid becomes the origin.
void centre(RaceShape& shape) {
    double volume = 0;
    Vec3 centroid;
    for (const auto& t : shape.triangles) {
        const Vec3 a = corner(shape, t[0]), b = corner(shape, t[1]), c = corner(shape, t[2]);
        const double part = dot(a, cross(b, c)) / 6;
        volume += part;
        centroid += (a + b + c) * (part / 4);
    }
    centroid = centroid * (1 / volume);
    for (Vec3& v : shape.vertices) v -= centroid;
    shape.volume = volume;
}

/// Inertia at unit density: the second moments of the tetrahedra with the origin.
void add_inertia(RaceShape& shape) {
    Mat3 moments = Mat3::zero();
    for (const auto& t : shape.triangles) {
        const Vec3 a = corner(shape, t[0]), b = corner(shape, t[1]), c = corner(shape, t[2]), sum = a + b + c;
        const double part = dot(a, cross(b, c)) / 6;
        moments += part / 20 * (outer(sum, sum) + outer(a, a) + outer(b, b) + outer(c, c));
    }
    shape.inertia = trace(moments) * Mat3::identity() - moments;
}

/// Edges between faces of different normals, without the diagonals between coplanar triangles.
void add_edges(RaceShape& shape) {
    for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
        for (std::size_t j = i + 1; j < shape.triangles.size(); ++j) {
            const auto &first = shape.triangles[i], &second = shape.triangles[j];
            const Vec3 n = normalized(area_vector(shape, first)), m = normalized(area_vector(shape, second));
            if (dot(n, m) > same_direction) continue;
            // Adjacent triangles have their common edge in opposite directions.
            for (std::size_t e = 0; e < 3; ++e) {
                const int a = first[e], b = first[(e + 1) % 3];
                for (std::size_t f = 0; f < 3; ++f)
                    if (second[f] == b && second[(f + 1) % 3] == a)
                        add_direction(shape.edge_directions, corner(shape, b) - corner(shape, a), true);
            }
        }
    }
}

/// Computes everything that follows from vertices and triangles.
void finish_polytope(RaceShape& shape) {
    centre(shape);
    add_inertia(shape);
    for (const auto& t : shape.triangles) add_direction(shape.face_normals, area_vector(shape, t), false);
    add_edges(shape);
    for (const Vec3 v : shape.vertices) shape.bound = std::max(shape.bound, length(v));
}

/// Finds the triangles of the hull among all triples of points: a face has all other points on one side.
void add_hull_triangles(RaceShape& shape) {
    const int count = static_cast<int>(shape.vertices.size());
    const auto add_if_face = [&](int a, int b, int c) {
        const Vec3 normal = area_vector(shape, {a, b, c});
        int above = 0, below = 0;
        for (int k = 0; k < count; ++k) {
            if (k == a || k == b || k == c) continue;
            (dot(normal, corner(shape, k) - corner(shape, a)) > 0 ? above : below)++;
        }
        if (above == 0)
            shape.triangles.push_back({a, b, c});
        else if (below == 0)
            shape.triangles.push_back({a, c, b});
    };
    for (int a = 0; a < count; ++a)
        for (int b = a + 1; b < count; ++b)
            for (int c = b + 1; c < count; ++c) add_if_face(a, b, c);
}

}  // namespace

double SceneRandom::unit() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
}

RaceShape make_box(Vec3 half) {
    RaceShape shape{.kind = ShapeKind::box, .half_extents = half};
    for (int i = 0; i < 8; ++i)
        shape.vertices.push_back(
            {(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 4) != 0 ? half.z : -half.z});
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces) {
        shape.triangles.push_back({f[0], f[1], f[2]});
        shape.triangles.push_back({f[0], f[2], f[3]});
    }
    finish_polytope(shape);
    return shape;
}

RaceShape make_sphere(double radius) {
    RaceShape shape{.kind = ShapeKind::sphere, .radius = radius};
    shape.volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    shape.inertia = shape.volume * 0.4 * radius * radius * Mat3::identity();
    shape.bound = radius;
    return shape;
}

RaceShape make_cylinder(double radius, double half_height) {
    RaceShape shape{.kind = ShapeKind::cylinder, .radius = radius, .half_height = half_height};

    // A prism of 16 sides: the bottom ring, then the top ring.
    constexpr int sides = 16;
    for (const double y : {-half_height, half_height}) {
        for (int i = 0; i < sides; ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            shape.vertices.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
        }
    }
    for (int i = 0; i < sides; ++i) {
        const int next = (i + 1) % sides;
        shape.triangles.push_back({i, sides + i, sides + next});
        shape.triangles.push_back({i, sides + next, next});
    }
    for (int i = 1; i + 1 < sides; ++i) {
        shape.triangles.push_back({0, i, i + 1});
        shape.triangles.push_back({sides, sides + i + 1, sides + i});
    }
    finish_polytope(shape);

    // Mass and inertia are the true cylinder's.
    const double height = 2 * half_height, side_moment = (3 * radius * radius + height * height) / 12;
    shape.volume = std::numbers::pi * radius * radius * height;
    shape.inertia = Mat3::diagonal(shape.volume * Vec3{side_moment, radius * radius / 2, side_moment});
    return shape;
}

RaceShape make_hull(SceneRandom& random, int count, double radius) {
    RaceShape shape{.kind = ShapeKind::hull};
    const Vec3 stretch = [&] {
        const double x = random.between(0.7, 1.2), y = random.between(0.7, 1.2), z = random.between(0.7, 1.2);
        return Vec3{x, y, z};
    }();

    // Points on a sphere with a minimum distance from each other, so that each stays a vertex of the hull.
    while (static_cast<int>(shape.vertices.size()) < count) {
        const double x = random.between(-1, 1), y = random.between(-1, 1), z = random.between(-1, 1);
        const double from_centre = length({x, y, z});
        if (from_centre < 0.2 || from_centre > 1) continue;
        const Vec3 point = Vec3{x, y, z} * (radius / from_centre);
        const auto too_near = [&](Vec3 other) { return distance(other, point) < 0.3 * radius; };
        if (std::none_of(shape.vertices.begin(), shape.vertices.end(), too_near)) shape.vertices.push_back(point);
    }
    for (Vec3& v : shape.vertices) v = scale(v, stretch);
    add_hull_triangles(shape);
    finish_polytope(shape);
    return shape;
}

}  // namespace embody::race
