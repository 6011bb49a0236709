// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "math/bounds.h"
#include "math/mat3.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/collision/shapes/convex.h"
#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/near_triangles.h"

namespace embody::physics::fluid {

/// Signed distance to an obstacle: exact next to its faces, else at most the true distance; < 0 inside.
struct ObstacleDistance {
    double distance = 0;  ///< m
    Vec3 normal;          ///< unit, outwards
};

/// Queries of a placed shape by a fluid: signed distances, filled fractions of small cubes, and whether a path is
/// blocked. Of meshes and heightfields the front of a triangle is outside, and what lies behind it within the queried
/// reach is inside. The hulls of a compound, which stand for one surface, leave gaps: each is made a millimetre or so
/// thicker (not for the fractions of cubes).
class ObstacleProbe {
public:
    ObstacleProbe(const CollisionShape& shape, const Transform& pose, const FluidObstacleSettings& settings);

    [[nodiscard]] const Bounds& bounds() const { return bounds_; }
    /// Chooses the parts within `reach` of the box; the queries below are for points in the box alone. False if there
    /// are none.
    bool look_at(const Bounds& box, double reach);
    /// Signed distance; the reach where it is larger.
    [[nodiscard]] ObstacleDistance nearest(Vec3 p) const;
    /// Fractions of the eight octants of the axis-aligned cube around p, of that edge, inside the obstacle: 0 … 1,
    /// added to `fractions`. Bit 0 of an octant's number: its upper half in x, bit 1: in y, bit 2: in z.
    void add_octants(Vec3 p, double edge, float* fractions) const;
    /// Whether the obstacle ends within `depth` behind the surface nearest to p, which is inside.
    [[nodiscard]] bool is_thinner(Vec3 p, Vec3 normal, double depth) const;
    /// First hit of the path from a to b with a surface, from either side of triangles, from outside of obstacles:
    /// fraction of the path, and the normal against it.
    struct Crossing {
        double fraction = 0;
        Vec3 normal;
    };
    [[nodiscard]] std::optional<Crossing> crossing(Vec3 a, Vec3 b) const;
    /// Whether it consists of triangles, which have liquid on both sides.
    [[nodiscard]] bool is_surface() const;
    /// Whether a place is in the solid that triangles enclose, however thick; false for other shapes.
    [[nodiscard]] bool encloses(Vec3 p) const;
    /// Whether it has no hollow that could hold liquid.
    [[nodiscard]] bool is_convex() const { return pieces_.size() == 1; }

private:
    struct Piece {
        const Convex* convex;
        Mat3 rotation;
        Vec3 position;
        Bounds bounds;
    };
    [[nodiscard]] ObstacleDistance nearest_triangle(Vec3 p) const;
    [[nodiscard]] std::optional<Crossing> crossing_of_pieces(Vec3 a, Vec3 direction, double whole) const;

    const CollisionShape* shape_;
    Transform pose_;
    Bounds bounds_;
    double seal_ = 0;  // m: thickness added to its hulls
    std::vector<Piece> pieces_;
    double reach_ = 0;
    std::vector<std::uint32_t> near_pieces_;
    NearTriangles near_triangles_;
    std::vector<std::uint32_t> found_;
};

}  // namespace embody::physics::fluid
