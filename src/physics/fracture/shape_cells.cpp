// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "geometry/convex_hull.h"
#include "physics/definitions/box_faces.h"
#include "physics/fracture/convex_cell.h"

namespace embody::physics::fracture {

namespace {

// Points around a rim, and rings from the middle of a ball to its pole: pieces of what is round look round, and a cell
// has few corners. Numbers of points; what they cost of the volume: SplitSolid.RoundShapesLoseLittle.
constexpr int rim_points = 24, ball_rings = 5;

void add_rim(std::vector<Vec3>& points, double radius, double height) {
    for (int i = 0; i < rim_points; ++i) {
        const double angle = 2 * std::numbers::pi * i / rim_points;
        points.push_back({radius * std::cos(angle), height, radius * std::sin(angle)});
    }
}

// Half of a ball about a point of the axis; `up` is 1 or -1.
void add_half_ball(std::vector<Vec3>& points, double radius, double height, double up) {
    for (int ring = 0; ring < ball_rings; ++ring) {
        const double latitude = std::numbers::pi / 2 * ring / ball_rings;
        add_rim(points, radius * std::cos(latitude), height + up * radius * std::sin(latitude));
    }
    points.push_back({0, height + up * radius, 0});
}

std::vector<Vec3> points_of(const SphereShape& sphere) {
    std::vector<Vec3> points;
    add_half_ball(points, sphere.radius, 0, 1);
    add_half_ball(points, sphere.radius, 0, -1);
    return points;
}
std::vector<Vec3> points_of(const BoxShape& box) {
    const auto corners = box_corners(box.half_extents);
    return {corners.begin(), corners.end()};
}
std::vector<Vec3> points_of(const CapsuleShape& capsule) {
    std::vector<Vec3> points;
    add_half_ball(points, capsule.radius, capsule.half_height, 1);
    add_half_ball(points, capsule.radius, -capsule.half_height, -1);
    return points;
}
std::vector<Vec3> points_of(const CylinderShape& cylinder) {
    std::vector<Vec3> points;
    for (const double side : {1.0, -1.0}) add_rim(points, cylinder.radius, side * cylinder.half_height);
    return points;
}
std::vector<Vec3> points_of(const ConeShape& cone) {
    std::vector<Vec3> points{{0, cone.half_height, 0}};
    add_rim(points, cone.radius, -cone.half_height);
    return points;
}
std::vector<Vec3> points_of(const HasCorners auto& shape) { return shape.corners(); }

Result<ConvexCell> hull_cell(std::span<const Vec3> points) {
    const auto hull = geometry::build_convex_hull(points, max_hull_vertices);
    if (!hull) return Error{"points", hull.error().why, hull.error().remedy};
    // As triangles: a polygon of the hull may be bent by its planarity, and what a plane cuts of it would not add up.
    std::vector<ConvexCell::Face> faces;
    for (const geometry::ConvexHull::Face& face : hull->faces) {
        const auto corners = hull->corners(face);
        for (std::size_t i = 2; i < corners.size(); ++i)
            faces.push_back(
                {{hull->vertices[corners[0]], hull->vertices[corners[i - 1]], hull->vertices[corners[i]]}, false});
    }
    return ConvexCell(std::move(faces));
}

struct Cells {
    using Found = Result<std::vector<ConvexCell>>;

    Found operator()(const CompoundShape& compound) const {
        std::vector<ConvexCell> cells;
        for (const CompoundChild& child : compound.children) {
            std::vector<Vec3> points = std::visit([](const auto& shape) { return points_of(shape); }, child.shape);
            const Quat rotation = normalized(child.local.rotation);
            for (Vec3& point : points) point = child.local.position + rotate(rotation, point);
            auto cell = hull_cell(points);
            if (!cell) return cell.error();
            cells.push_back(std::move(cell).value());
        }
        return cells;
    }
    Found operator()(const HasParts auto& shape) const { return (*this)(CompoundShape{shape.parts()}); }
    Found operator()(const PlaneShape&) const { return has_no_inside(); }
    Found operator()(const HeightfieldShape&) const { return has_no_inside(); }
    Found operator()(const MeshShape&) const { return has_no_inside(); }
    Found operator()(const auto& convex) const {
        auto cell = hull_cell(points_of(convex));
        if (!cell) return cell.error();
        return std::vector<ConvexCell>{std::move(cell).value()};
    }

private:
    static Error has_no_inside() { return {"shape", "has no inside that could break"}; }
};

}  // namespace

Result<std::vector<ConvexCell>> cells_of(const ShapeDefinition& shape) {
    if (auto valid = validate(shape); !valid) return valid.error();
    return std::visit(Cells{}, shape);
}

}  // namespace embody::physics::fracture
