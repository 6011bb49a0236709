// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"

namespace embody::race {

/// Xorshift64: small, and the same numbers for every engine on every machine.
class SceneRandom {
public:
    /// Uniform in [0, 1).
    double unit();
    /// Uniform between `low` and `high`.
    double between(double low, double high) { return low + (high - low) * unit(); }

private:
    std::uint64_t state_ = 0x9E3779B97F4A7C15ull;
};

enum class ShapeKind { box, sphere, cylinder, hull };

/// A shape that every engine can build, centred on its centre of mass, axes of cylinders along Y. Lengths in metres.
struct RaceShape {
    ShapeKind kind = ShapeKind::box;
    Vec3 half_extents;       ///< box
    double radius = 0;       ///< sphere, cylinder
    double half_height = 0;  ///< cylinder

    // The shape's polytope, for engines without the true shape and for measuring; none for a sphere, a prism for a
    // cylinder.
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
    std::vector<Vec3> face_normals;             ///< unit length, each direction once
    std::vector<Vec3> edge_directions;          ///< unit length, each line once

    double volume = 0;  ///< m³, of the true shape
    Mat3 inertia;       ///< of the true shape at unit density, about the centre of mass
    double bound = 0;   ///< radius of the bounding sphere about the centre
};

RaceShape make_box(Vec3 half_extents);
RaceShape make_sphere(double radius);
RaceShape make_cylinder(double radius, double half_height);
/// The hull of `count` points on a random ellipsoid of about `radius`; every point is a vertex.
RaceShape make_hull(SceneRandom& random, int count, double radius);

}  // namespace embody::race
