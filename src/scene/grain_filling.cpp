// SPDX-License-Identifier: MIT
// Face-centred cubic rows, loosened and shaken (docs/physics/grains.md: Filling).
#include "scene/grain_filling.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "foundation/random.h"
#include "geometry/convex_hull.h"
#include "math/bounds.h"

namespace embody::scene {

namespace {

using physics::BoxShape;
using physics::CapsuleShape;
using physics::CompoundChild;
using physics::CompoundShape;
using physics::ConeShape;
using physics::CylinderShape;
using physics::HullShape;
using physics::SphereShape;

constexpr double spacing = 1.1;  // of the rows, in diameters: 0.74 / 1.1³ = 0.556 of the space is grain
// Largest shift along an axis, in diameters: two balls 0.1 d apart that move towards each other by √3 as much still
// do not touch.
constexpr double shake = 0.028;
// Places looked at: so many are a second's work.
constexpr std::size_t most_places = 50'000'000;

/// A convex part of the shape, in the shape's frame.
struct Region {
    std::variant<SphereShape, BoxShape, CapsuleShape, CylinderShape, ConeShape, geometry::ConvexHull> shape;
    Transform pose;
    Bounds bounds;
};

// Whether a ball about p lies within, in the region's own frame.
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

template <class Primitive>
Result<Region> region_of(const Primitive& primitive, const Transform& pose) {
    const Vec3 half = half_of(primitive);
    return Region{primitive, pose, transformed(pose, Bounds{-half, half})};
}

Result<Region> region_of(const HullShape& points, const Transform& pose) {
    Result<geometry::ConvexHull> hull = geometry::build_convex_hull(points.points);
    if (!hull.ok()) return hull.error();
    const Bounds bounds = transformed(pose, geometry::bounds(hull.value()));
    return Region{std::move(hull).value(), pose, bounds};
}

Result<std::vector<Region>> regions_of(const physics::ShapeDefinition& shape) {
    if (physics::is_static_only(shape))
        return Error{"shape", std::string("a ") + physics::shape_name(shape) + " has no inside to fill with grains",
                     "give it a solid shape, or another kind"};
    std::vector<Region> regions;
    std::optional<Error> wrong;
    const auto add = [&](const auto& part, const Transform& pose) {
        Result<Region> region = region_of(part, pose);
        if (region.ok())
            regions.push_back(std::move(region).value());
        else
            wrong = region.error();
    };
    const auto add_convex = [&](const auto& part) {
        using Part = std::decay_t<decltype(part)>;
        if constexpr (std::is_same_v<Part, CompoundShape>) {
            for (const CompoundChild& child : part.children)
                std::visit([&](const auto& own) { add(own, child.local); }, child.shape);
        } else if constexpr (!std::is_same_v<Part, physics::PlaneShape> && !std::is_same_v<Part, physics::MeshShape> &&
                             !std::is_same_v<Part, physics::HeightfieldShape>) {
            add(part, Transform{});
        }
    };
    std::visit(add_convex, shape);
    if (wrong) return *wrong;
    return regions;
}

bool holds_ball(const std::vector<Region>& regions, Vec3 center, double radius) {
    return std::ranges::any_of(regions, [&](const Region& region) {
        return std::visit(HoldsBall{inverse_transform_point(region.pose, center), radius}, region.shape);
    });
}

}  // namespace

Result<std::vector<Vec3>> fill_with_grains(const physics::ShapeDefinition& shape, double diameter, std::size_t most,
                                           std::uint64_t seed) {
    const Result<std::vector<Region>> regions = regions_of(shape);
    if (!regions.ok()) return regions.error();
    Bounds bounds;
    for (const Region& region : regions.value()) bounds.add(region.bounds);

    // Rows along X in layers upwards; every third layer lies above the first.
    const double a = spacing * diameter, row = a * std::sqrt(3.0) / 2, layer = a * std::sqrt(2.0 / 3);
    const Vec3 first = bounds.lower + Vec3{diameter, diameter, diameter} * (0.5 + shake);
    const auto count = [&](double extent, double step) {
        return static_cast<std::int64_t>(std::max(0.0, (extent - diameter) / step)) + 2;
    };
    const Vec3 size = bounds.size();
    Random random(seed);
    std::vector<Vec3> centers;
    std::size_t looked_at = 0;
    for (std::int64_t iy = 0; iy < count(size.y, layer); ++iy) {
        for (std::int64_t iz = 0; iz < count(size.z, row); ++iz) {
            for (std::int64_t ix = 0; ix < count(size.x, a); ++ix) {
                if (centers.size() == most) return centers;
                if (++looked_at > most_places)
                    return Error{"simulated_diameter", "is too small to fill so large a shape", "make it larger"};
                const double shift_x = static_cast<double>((iz + iy % 3) % 2) * a / 2;
                const double shift_z = static_cast<double>(iy % 3) * row / 3;
                const Vec3 shaken{random.between(-shake, shake), random.between(-shake, shake),
                                  random.between(-shake, shake)};
                const Vec3 place = first +
                                   Vec3{static_cast<double>(ix) * a + shift_x, static_cast<double>(iy) * layer,
                                        static_cast<double>(iz) * row + shift_z} +
                                   shaken * diameter;
                if (holds_ball(regions.value(), place, diameter / 2)) centers.push_back(place);
            }
        }
    }
    if (centers.empty())
        return Error{"simulated_diameter", "is too large: no grain fits into the shape",
                     "make it smaller, or allow more grains with grain_budget"};
    return centers;
}

}  // namespace embody::scene
