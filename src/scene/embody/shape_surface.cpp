// SPDX-License-Identifier: MIT
#include "scene/embody/shape_surface.h"

#include <cmath>
#include <numbers>
#include <type_traits>

#include "geometry/convex_hull.h"

namespace embody::scene {

namespace {

using physics::ShapeDefinition;

constexpr int sides = 32;  // of a round surface
constexpr int rings = 8;   // in a quarter turn

void add_ring(std::vector<Vec3>& points, double radius, double height) {
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        points.push_back({radius * std::cos(angle), height, radius * std::sin(angle)});
    }
}

// Adds a cap of a sphere about (0, center, 0), up or down.
void add_cap(std::vector<Vec3>& points, double radius, double center, double up) {
    for (int ring = 0; ring < rings; ++ring) {
        const double angle = std::numbers::pi / 2 * ring / rings;
        add_ring(points, radius * std::cos(angle), center + up * radius * std::sin(angle));
    }
    points.push_back({0, center + up * radius, 0});
}

std::vector<Vec3> corners(const physics::SphereShape& s) {
    std::vector<Vec3> points;
    for (const double up : {-1.0, 1.0}) add_cap(points, s.radius, 0, up);
    return points;
}
std::vector<Vec3> corners(const physics::BoxShape& s) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(scale({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}, s.half_extents));
    return points;
}
std::vector<Vec3> corners(const physics::CapsuleShape& s) {
    std::vector<Vec3> points;
    for (const double up : {-1.0, 1.0}) add_cap(points, s.radius, up * s.half_height, up);
    return points;
}
std::vector<Vec3> corners(const physics::CylinderShape& s) {
    std::vector<Vec3> points;
    for (const double up : {-1.0, 1.0}) add_ring(points, s.radius, up * s.half_height);
    return points;
}
std::vector<Vec3> corners(const physics::ConeShape& s) {
    std::vector<Vec3> points;
    add_ring(points, s.radius, -s.half_height);
    points.push_back({0, s.half_height, 0});
    return points;
}
std::vector<Vec3> corners(const physics::HasCorners auto& s) { return s.corners(); }

// The surface of a convex shape is the hull of its corners.
template <class Convex>
Result<void> add_convex(const Convex& convex, const Transform& local, geometry::TriangleMesh& mesh) {
    std::vector<Vec3> points = corners(convex);
    for (Vec3& point : points) point = transform_point(local, point);
    const auto hull = geometry::build_convex_hull(points, geometry::max_hull_vertices);
    if (!hull) return hull.error();
    const geometry::TriangleMesh faces = geometry::to_mesh(*hull);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), faces.positions.begin(), faces.positions.end());
    for (const auto& t : faces.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return {};
}

Result<void> add(const ShapeDefinition& shape, geometry::TriangleMesh& mesh) {
    return std::visit(
        [&](const auto& one) -> Result<void> {
            using Shape = std::decay_t<decltype(one)>;
            if constexpr (std::is_same_v<Shape, physics::MeshShape>) {
                mesh.positions = one.positions;
                mesh.triangles = one.triangles;
                return {};
            } else if constexpr (std::is_same_v<Shape, physics::CompoundShape>) {
                for (const physics::CompoundChild& child : one.children) {
                    Result<void> added = std::visit(
                        [&](const auto& convex) { return add_convex(convex, child.local, mesh); }, child.shape);
                    if (!added) return added;
                }
                return {};
            } else if constexpr (physics::HasParts<Shape>) {
                return add(physics::CompoundShape{one.parts()}, mesh);
            } else if constexpr (std::is_same_v<Shape, physics::PlaneShape> ||
                                 std::is_same_v<Shape, physics::HeightfieldShape>) {
                return Error{"shape", std::string("a ") + physics::shape_name(shape) + " has no inside"};
            } else {
                return add_convex(one, Transform{}, mesh);
            }
        },
        shape);
}

}  // namespace

Result<geometry::TriangleMesh> surface_of(const ShapeDefinition& shape) {
    geometry::TriangleMesh mesh;
    if (auto added = add(shape, mesh); !added) return added.error();
    return mesh;
}

}  // namespace embody::scene
