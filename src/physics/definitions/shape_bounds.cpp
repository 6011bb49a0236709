// SPDX-License-Identifier: MIT
#include "physics/definitions/shape_bounds.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/box_faces.h"

namespace embody::physics {

namespace {

/// Adds one kind of shape, placed, to `all`.
struct Extent {
    Bounds& all;
    Transform pose;

    void operator()(const SphereShape& sphere) const { add_ball({}, sphere.radius); }
    void operator()(const BoxShape& box) const {
        for (const Vec3 corner : box_corners(box.half_extents)) all.add(transform_point(pose, corner));
    }
    void operator()(const CapsuleShape& capsule) const {
        for (const double end : {-1.0, 1.0}) add_ball({0, end * capsule.half_height, 0}, capsule.radius);
    }
    void operator()(const CylinderShape& cylinder) const {
        for (const double end : {-1.0, 1.0}) add_disc(end * cylinder.half_height, cylinder.radius);
    }
    void operator()(const ConeShape& cone) const {
        add_disc(-cone.half_height, cone.radius);
        all.add(transform_point(pose, {0, cone.half_height, 0}));
    }
    void operator()(const HasCorners auto& hull) const {
        for (const Vec3 point : hull.corners()) all.add(transform_point(pose, point));
    }
    void operator()(const PlaneShape&) const {}
    void operator()(const HeightfieldShape& field) const {
        for (const float height : field.heights) {
            const double y = static_cast<double>(height);
            all.add(transform_point(pose, {0, y, 0}));
            all.add(transform_point(pose, {(field.columns - 1) * field.cell_x, y, (field.rows - 1) * field.cell_z}));
        }
    }
    void operator()(const MeshShape& mesh) const {
        for (const Vec3f position : mesh.positions) all.add(transform_point(pose, to_vec3(position)));
    }
    void operator()(const CompoundShape& compound) const {
        for (const CompoundChild& child : compound.children)
            std::visit(Extent{all, {child.local.position, normalized(child.local.rotation)}}, child.shape);
    }

    void operator()(const HasParts auto& shape) const { (*this)(CompoundShape{shape.parts()}); }

private:
    void add_ball(Vec3 center, double radius) const {
        const Vec3 at = transform_point(pose, center), reach{radius, radius, radius};
        all.add(Bounds{at - reach, at + reach});
    }
    // The extent of a unit disc along an axis is the length of the axis's projection onto its plane.
    void add_disc(double height, double radius) const {
        const Vec3 normal = rotate(pose.rotation, {0, 1, 0}), at = transform_point(pose, {0, height, 0});
        Vec3 reach;
        for (int k = 0; k < 3; ++k) reach[k] = radius * std::sqrt(std::max(0.0, 1 - normal[k] * normal[k]));
        all.add(Bounds{at - reach, at + reach});
    }
};

}  // namespace

Bounds bounds_of(const ShapeDefinition& shape) {
    Bounds all;
    std::visit(Extent{all, {}}, shape);
    return all;
}

}  // namespace embody::physics
