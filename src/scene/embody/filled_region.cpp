// SPDX-License-Identifier: MIT
#include "scene/embody/filled_region.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace embody::scene {

namespace {

using physics::BoxShape;
using physics::CapsuleShape;
using physics::CompoundChild;
using physics::CompoundShape;
using physics::ConeShape;
using physics::CylinderShape;
using physics::SphereShape;

// Whether a ball about p is inside, in the region's own frame.
struct HoldsBall {
    Vec3 p;
    double r;

    [[nodiscard]] double off_axis() const { return std::sqrt(p.x * p.x + p.z * p.z); }
    bool operator()(const SphereShape& sphere) const { return length(p) <= sphere.radius - r; }
    bool operator()(const BoxShape& box) const {
        const Vec3 h = box.half_extents;
        return std::fabs(p.x) <= h.x - r && std::fabs(p.y) <= h.y - r && std::fabs(p.z) <= h.z - r;
    }
    bool operator()(const CapsuleShape& capsule) const {
        const Vec3 on_axis{0, std::clamp(p.y, -capsule.half_height, capsule.half_height), 0};
        return distance(p, on_axis) <= capsule.radius - r;
    }
    bool operator()(const CylinderShape& cylinder) const {
        return std::fabs(p.y) <= cylinder.half_height - r && off_axis() <= cylinder.radius - r;
    }
    bool operator()(const ConeShape& cone) const {
        const double height = 2 * cone.half_height, slant = std::sqrt(height * height + cone.radius * cone.radius);
        const double inside = cone.radius * (cone.half_height - p.y) / height - off_axis();
        return p.y >= r - cone.half_height && inside * height / slant >= r;
    }
    bool operator()(const geometry::ConvexHull& hull) const {
        return std::ranges::all_of(hull.faces,
                                   [&](const auto& face) { return dot(face.normal, p) <= face.offset - r; });
    }
};

Vec3 half_of(const SphereShape& s) { return {s.radius, s.radius, s.radius}; }
Vec3 half_of(const BoxShape& s) { return s.half_extents; }
Vec3 half_of(const CapsuleShape& s) { return {s.radius, s.radius + s.half_height, s.radius}; }
Vec3 half_of(const CylinderShape& s) { return {s.radius, s.half_height, s.radius}; }
Vec3 half_of(const ConeShape& s) { return {s.radius, s.half_height, s.radius}; }

}  // namespace

template <class Primitive>
Result<FilledRegion::Part> FilledRegion::part_of(const Primitive& primitive, const Transform& pose) {
    if constexpr (physics::HasCorners<Primitive>) {
        Result<geometry::ConvexHull> hull = geometry::build_convex_hull(primitive.corners());
        if (!hull.ok()) return hull.error();
        const Bounds bounds = transformed(pose, geometry::bounds(hull.value()));
        return Part{std::move(hull).value(), pose, bounds};
    } else {
        const Vec3 half = half_of(primitive);
        return Part{primitive, pose, transformed(pose, Bounds{-half, half})};
    }
}

Result<FilledRegion> FilledRegion::of(const physics::ShapeDefinition& shape) {
    if (physics::is_static_only(shape))
        return Error{"shape", std::string("a ") + physics::shape_name(shape) + " has no inside to fill",
                     "give it a solid shape, or another kind"};
    FilledRegion region;
    std::optional<Error> wrong;
    const auto add = [&](const auto& part, const Transform& pose) {
        Result<Part> made = part_of(part, pose);
        if (!made.ok()) {
            wrong = made.error();
            return;
        }
        region.bounds_.add(made.value().bounds);
        region.parts_.push_back(std::move(made).value());
    };
    const auto add_all = [&](const std::vector<CompoundChild>& children) {
        for (const CompoundChild& child : children)
            std::visit([&](const auto& own) { add(own, child.local); }, child.shape);
    };
    const auto add_convex = [&](const auto& part) {
        using Own = std::decay_t<decltype(part)>;
        if constexpr (std::is_same_v<Own, CompoundShape>) {
            add_all(part.children);
        } else if constexpr (physics::HasParts<Own>) {
            add_all(part.parts());
        } else if constexpr (!std::is_same_v<Own, physics::PlaneShape> && !std::is_same_v<Own, physics::MeshShape> &&
                             !std::is_same_v<Own, physics::HeightfieldShape>) {
            add(part, Transform{});
        }
    };
    std::visit(add_convex, shape);
    if (wrong) return *wrong;
    return region;
}

bool FilledRegion::holds_ball(Vec3 center, double radius) const {
    return std::ranges::any_of(parts_, [&](const Part& part) {
        return std::visit(HoldsBall{inverse_transform_point(part.pose, center), radius}, part.shape);
    });
}

}  // namespace embody::scene
