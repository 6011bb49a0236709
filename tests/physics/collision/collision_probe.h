// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "foundation/random.h"
#include "physics/collision/shapes/collision_shape.h"

namespace embody::physics::collision {

inline std::unique_ptr<CollisionShape> make_shape(const ShapeDefinition& definition) {
    auto shape = CollisionShape::create(definition);
    EXPECT_TRUE(shape.ok()) << (shape.ok() ? "" : shape.error().message());
    return shape.ok() ? *std::move(shape) : nullptr;
}

inline std::vector<Manifold> contacts(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b,
                                      const Transform& pose_b, double margin) {
    std::vector<Manifold> manifolds;
    collide(a, pose_a, b, pose_b, margin, manifolds);
    return manifolds;
}

inline std::vector<Vec3> corner_points(Vec3 half) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        points.push_back(
            {(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 4) != 0 ? half.z : -half.z});
    }
    return points;
}

/// cells x cells squares of two triangles each in the XZ plane, facing up.
inline MeshShape flat_mesh(int cells, double size, Vec3 corner) {
    MeshShape mesh;
    for (int r = 0; r <= cells; ++r) {
        for (int c = 0; c <= cells; ++c) mesh.positions.push_back(to_vec3f(corner + Vec3{c * size, 0, r * size}));
    }
    const auto at = [cells](int c, int r) { return static_cast<std::uint32_t>(r * (cells + 1) + c); };
    for (int r = 0; r < cells; ++r) {
        for (int c = 0; c < cells; ++c) {
            mesh.triangles.push_back({at(c, r), at(c, r + 1), at(c + 1, r + 1)});
            mesh.triangles.push_back({at(c, r), at(c + 1, r + 1), at(c + 1, r)});
        }
    }
    return mesh;
}

inline Quat random_rotation(Random& random) {
    for (;;) {
        const Quat q{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const double l = dot(q, q);
        if (l > 0.01 && l < 1) return normalized(q);
    }
}
inline Vec3 random_direction(Random& random) { return rotate(random_rotation(random), {1, 0, 0}); }

/// Lowest separation over all manifolds, or +infinity.
inline double deepest(const std::vector<Manifold>& manifolds) {
    double least = HUGE_VAL;
    for (const Manifold& m : manifolds) {
        for (int i = 0; i < m.count; ++i) least = std::fmin(least, m.points[static_cast<std::size_t>(i)].separation);
    }
    return least;
}

}  // namespace embody::physics::collision
