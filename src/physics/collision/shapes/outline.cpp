// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/outline.h"

#include <cmath>
#include <numbers>
#include <tuple>

#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {

namespace {

constexpr Vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
constexpr int plane_grid_lines = 11;  // each way

// Part of a circle about `center`, from its point at `start` on, over the one at `side`; both are radii.
void add_arc(Vec3 center, Vec3 start, Vec3 side, double angle, int lines, const OutlineVisit& visit) {
    Vec3 last = center + start;
    for (int i = 1; i <= lines; ++i) {
        const double at = angle * i / lines;
        const Vec3 next = center + std::cos(at) * start + std::sin(at) * side;
        visit(last, next);
        last = next;
    }
}

void add_circle(Vec3 center, Vec3 start, Vec3 side, const OutlineVisit& visit) {
    add_arc(center, start, side, 2 * std::numbers::pi, outline_circle_lines, visit);
}

void add_sphere(double radius, const OutlineVisit& visit) {
    add_circle({}, radius * x_axis, radius * y_axis, visit);
    add_circle({}, radius * y_axis, radius * z_axis, visit);
    add_circle({}, radius * z_axis, radius * x_axis, visit);
}

// Two circles and four lines between them; the upper radius of a cone is zero, and there is no upper circle.
void add_sides(double lower_radius, double upper_radius, double half_height, const OutlineVisit& visit) {
    const Vec3 up = half_height * y_axis;
    add_circle(-up, lower_radius * x_axis, lower_radius * z_axis, visit);
    if (upper_radius > 0) add_circle(up, upper_radius * x_axis, upper_radius * z_axis, visit);
    for (const Vec3 out : {x_axis, z_axis, -x_axis, -z_axis}) visit(lower_radius * out - up, upper_radius * out + up);
}

void add_capsule(const Convex& capsule, const OutlineVisit& visit) {
    add_sides(capsule.radius, capsule.radius, capsule.half_height, visit);
    for (const double sign : {1.0, -1.0}) {
        const Vec3 center = sign * capsule.half_height * y_axis, over = sign * capsule.radius * y_axis;
        for (const Vec3 out : {x_axis, z_axis})
            add_arc(center, capsule.radius * out, over, std::numbers::pi, outline_circle_lines / 2, visit);
    }
}

void add_convex(const Convex& convex, const OutlineVisit& visit) {
    switch (convex.kind) {
        case ConvexKind::sphere:
            return add_sphere(convex.radius, visit);
        case ConvexKind::capsule:
            return add_capsule(convex, visit);
        case ConvexKind::cylinder:
            return add_sides(convex.radius, convex.radius, convex.half_height, visit);
        case ConvexKind::cone:
            return add_sides(convex.radius, 0, convex.half_height, visit);
        case ConvexKind::polytope:
            for (const Polytope::Edge& edge : convex.polytope.edges)
                visit(convex.polytope.vertices[edge.from], convex.polytope.vertices[edge.to]);
            return;
    }
}

// An edge between two triangles has opposite directions in them: it is drawn where it runs upwards. An edge at the end
// of the surface is always drawn.
void add_surface(const TriangleSurface& surface, const OutlineVisit& visit) {
    const auto key = [](Vec3 p) { return std::tuple(p.x, p.y, p.z); };
    for (std::uint32_t triangle = 0; triangle < surface.count(); ++triangle) {
        const std::array<Vec3, 3> corners = surface.corners(triangle);
        const std::array<float, 3>& dihedrals = surface.signed_half_dihedrals(triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 from = corners[k], to = corners[(k + 1) % 3];
            if (std::isinf(dihedrals[k]) || key(from) < key(to)) visit(from, to);
        }
    }
}

void add_plane(Vec3 normal, double offset, double half_size, const OutlineVisit& visit) {
    const Vec3 along = half_size * any_perpendicular(normal), across = cross(normal, along), center = offset * normal;
    for (int i = 0; i < plane_grid_lines; ++i) {
        const double at = 2.0 * i / (plane_grid_lines - 1) - 1;
        visit(center + at * along - across, center + at * along + across);
        visit(center + at * across - along, center + at * across + along);
    }
}

}  // namespace

void outline(const CollisionShape& shape, const Transform& pose, double plane_half_size, const OutlineVisit& visit) {
    const CollisionShape::Data& data = shape.data();
    const OutlineVisit placed = [&](Vec3 from, Vec3 to) {
        visit(transform_point(pose, from), transform_point(pose, to));
    };
    if (data.is_plane) return add_plane(data.plane_normal, data.plane_offset, plane_half_size, placed);
    if (data.surface) return add_surface(*data.surface, placed);
    for (const ConvexPiece& piece : data.pieces) {
        const Transform place = pose * piece.local;
        add_convex(piece.convex,
                   [&](Vec3 from, Vec3 to) { visit(transform_point(place, from), transform_point(place, to)); });
    }
}

}  // namespace embody::physics::collision
