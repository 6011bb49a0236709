// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/body_features.h"

namespace embody::physics::deformable {

namespace {

// Directions around the Y axis, an eighth of a turn apart.
constexpr double half_root = 0.70710678118654752;  // √½
constexpr std::array<std::array<double, 2>, 8> around{{{1, 0},
                                                       {half_root, half_root},
                                                       {0, 1},
                                                       {-half_root, half_root},
                                                       {-1, 0},
                                                       {-half_root, -half_root},
                                                       {0, -1},
                                                       {half_root, -half_root}}};

void add_rim(double radius, double height, std::vector<BodyFeature>& features) {
    for (const auto& [x, z] : around) features.push_back({{radius * x, height, radius * z}, 0});
}

struct Finder {
    std::vector<BodyFeature>& features;

    void operator()(const SphereShape& sphere) const { features.push_back({{}, sphere.radius}); }
    void operator()(const BoxShape& box) const {
        const Vec3 h = box.half_extents;
        for (const double x : {-h.x, h.x}) {
            for (const double y : {-h.y, h.y}) {
                for (const double z : {-h.z, h.z}) features.push_back({{x, y, z}, 0});
            }
        }
    }
    void operator()(const CapsuleShape& capsule) const {
        for (const double y : {-1.0, -0.5, 0.0, 0.5, 1.0})
            features.push_back({{0, y * capsule.half_height, 0}, capsule.radius});
    }
    void operator()(const CylinderShape& cylinder) const {
        for (const double y : {-cylinder.half_height, cylinder.half_height}) add_rim(cylinder.radius, y, features);
    }
    void operator()(const ConeShape& cone) const {
        features.push_back({{0, cone.half_height, 0}, 0});
        add_rim(cone.radius, -cone.half_height, features);
    }
    void operator()(const HasCorners auto& hull) const {
        for (const Vec3 point : hull.corners()) features.push_back({point, 0});
    }
    void operator()(const CompoundShape& compound) const {
        for (const CompoundChild& child : compound.children) {
            std::vector<BodyFeature> own;
            std::visit(Finder{own}, child.shape);
            for (const BodyFeature& feature : own)
                features.push_back({transform_point(child.local, feature.point), feature.radius});
        }
    }
    void operator()(const HasParts auto& shape) const { (*this)(CompoundShape{shape.parts()}); }
    void operator()(const PlaneShape&) const {}
    void operator()(const HeightfieldShape&) const {}
    void operator()(const MeshShape&) const {}
};

}  // namespace

std::vector<BodyFeature> find_features(const ShapeDefinition& shape) {
    std::vector<BodyFeature> features;
    std::visit(Finder{features}, shape);
    return features;
}

}  // namespace embody::physics::deformable
