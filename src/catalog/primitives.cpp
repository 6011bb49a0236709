// SPDX-License-Identifier: MIT
// What they weigh is the physics' own answer (mass_properties); surface areas are from any table.
#include "catalog/primitives.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "catalog/prepare/geometry_measurement.h"
#include "catalog/prepare/surface_finish.h"
#include "catalog/prepare/thumbnail.h"
#include "interchange/compact/compact_geometry.h"
#include "physics/definitions/mass_properties.h"
#include "physics/definitions/shape_bounds.h"

namespace embody::catalog {
namespace {

using attributes::GeometryFacts;
using interchange::RawMesh;
constexpr double pi = std::numbers::pi;
constexpr std::uint32_t segments = 48;  // around the axis: smooth on a screen

struct ProfilePoint {
    double radius, height;  ///< m
};

/// The surface of a profile that turns about Y, from the bottom pole to the top pole (both of radius 0).
RawMesh revolve(const std::vector<ProfilePoint>& profile) {
    RawMesh mesh;
    const auto add = [&](double x, double y, double z) {
        mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
    };
    // One vertex at each pole, a ring at each point between.
    add(0, profile.front().height, 0);
    for (std::size_t i = 1; i + 1 < profile.size(); ++i) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            const double angle = 2 * pi * s / segments;
            add(profile[i].radius * std::cos(angle), profile[i].height, profile[i].radius * std::sin(angle));
        }
    }
    add(0, profile.back().height, 0);

    // Counter-clockwise from outside: up × along is outwards.
    const auto rings = static_cast<std::uint32_t>(profile.size() - 2);
    const std::uint32_t top = 1 + rings * segments;
    for (std::uint32_t s = 0; s < segments; ++s) {
        const std::uint32_t next = (s + 1) % segments;
        mesh.triangles.push_back({0, 1 + s, 1 + next});
        for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
            const std::uint32_t low = 1 + ring * segments, high = low + segments;
            mesh.triangles.push_back({low + s, high + s, low + next});
            mesh.triangles.push_back({low + next, high + s, high + next});
        }
        mesh.triangles.push_back({top - segments + next, top - segments + s, top});
    }
    return mesh;
}

/// Two half spheres, `apart` between their centres, standing on the ground.
RawMesh round_mesh(double radius, double apart) {
    constexpr int steps = 12;  // of a quarter turn
    std::vector<ProfilePoint> profile;
    for (int half = 0; half < 2; ++half) {
        for (int i = 0; i <= steps; ++i) {
            const double angle = pi / 2 * (half == 0 ? i - steps : i) / steps;
            // A sphere has its equator once.
            if (half == 1 && i == 0 && apart == 0) continue;
            const bool pole = (half == 0 && i == 0) || (half == 1 && i == steps);
            profile.push_back({pole ? 0 : radius * std::cos(angle), radius + half * apart + radius * std::sin(angle)});
        }
    }
    return revolve(profile);
}

RawMesh box_mesh(Vec3 half) {
    RawMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.push_back({static_cast<float>(corner & 1 ? half.x : -half.x),
                                  static_cast<float>(corner & 2 ? 2 * half.y : 0),
                                  static_cast<float>(corner & 4 ? half.z : -half.z)});
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

RawMesh plane_mesh(double half) {
    const auto h = static_cast<float>(half);
    RawMesh mesh;
    mesh.positions = {{-h, 0, -h}, {h, 0, -h}, {h, 0, h}, {-h, 0, h}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
    return mesh;
}

/// Puts the numbers of the shape, which stands on the ground, in the place of the triangles'.
template <class Shape>
void set_solid(GeometryFacts& facts, const Shape& shape, double area) {
    const geometry::MassProperties solid = physics::mass_properties(shape);
    facts.closed = true;
    facts.volume = facts.hull_volume = solid.volume;
    facts.volume_method = "formula of the shape";
    facts.volume_relative_error = 0;
    facts.surface_area = area;
    facts.center_of_volume = solid.center - Vec3{0, physics::bounds_of(shape).lower.y, 0};
    facts.unit_inertia = solid.inertia;
    facts.parts.clear();  // solid, of one material
}

void set_fit(GeometryFacts& facts, std::string shape, Vec3 dimensions) {
    facts.fitted_shape = std::move(shape);
    facts.fitted_dimensions = dimensions;
    facts.fitted_pose = {facts.center_of_volume, {}};
    facts.fitted_error = 0;
}

void describe(GeometryFacts& facts, const physics::BoxShape& box) {
    const Vec3 s = 2.0 * box.half_extents;
    set_solid(facts, box, 2 * (s.x * s.y + s.y * s.z + s.z * s.x));
    set_fit(facts, "box", box.half_extents);
}

void describe(GeometryFacts& facts, const physics::SphereShape& sphere) {
    set_solid(facts, sphere, 4 * pi * sphere.radius * sphere.radius);
    set_fit(facts, "sphere", {sphere.radius, 0, 0});
}

void describe(GeometryFacts& facts, const physics::CapsuleShape& capsule) {
    const double r = capsule.radius;
    set_solid(facts, capsule, 4 * pi * r * capsule.half_height + 4 * pi * r * r);
    set_fit(facts, "capsule", {r, capsule.half_height, 0});
}

void describe(GeometryFacts& facts, const physics::CylinderShape& cylinder) {
    const double r = cylinder.radius;
    set_solid(facts, cylinder, 2 * pi * r * (r + 2 * cylinder.half_height));
    set_fit(facts, "cylinder", {r, cylinder.half_height, 0});
}

void describe(GeometryFacts& facts, const physics::ConeShape& cone) {
    const double r = cone.radius, h = 2 * cone.half_height;
    set_solid(facts, cone, pi * r * (r + std::sqrt(r * r + h * h)));
    set_fit(facts, "convex_hull", {});
}

Result<Primitive> make_primitive(const std::string& word, const std::string& name, RawMesh mesh) {
    Primitive primitive;
    primitive.item.key = "primitive:" + word;
    primitive.item.name = name;
    primitive.item.source = "Embody";
    primitive.item.licence = "CC0";
    primitive.item.category = "primitives";
    primitive.item.tags = {"primitive", "shape", word};

    interchange::RawScene scene;
    mesh.name = word;
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back({.name = "plain",
                               .base_color = {0.35f, 0.45f, 0.6f, 1},
                               .base_color_image = -1,
                               .metallic = 0,
                               .roughness = 0.6f,
                               .emissive = {0, 0, 0},
                               .double_sided = false});
    finish_surfaces(scene);

    const GeometryMeasurement measured = measure_geometry(scene, Decompose::no);
    auto compact = interchange::encode(scene);
    if (!compact) return compact.error();
    PreparedModel& model = primitive.model;
    model.geometry = std::move(compact->bytes);
    model.thumbnail = render_thumbnail(scene);
    model.hull_points = measured.hull_points;
    model.facts.geometry = measured.facts;
    model.vertices = compact->vertices;
    model.triangles = compact->triangles;
    model.parts = compact->parts;
    model.materials = compact->materials;
    model.quality = 3;
    return primitive;
}

}  // namespace

Result<std::vector<Primitive>> make_primitives() {
    const physics::BoxShape box;
    const physics::SphereShape sphere;
    const physics::CapsuleShape capsule;
    const physics::CylinderShape cylinder;
    const physics::ConeShape cone;
    const double top = 2 * cylinder.half_height, apex = 2 * cone.half_height;

    std::vector<Result<Primitive>> made;
    made.push_back(make_primitive("box", "Box", box_mesh(box.half_extents)));
    made.push_back(make_primitive("sphere", "Sphere", round_mesh(sphere.radius, 0)));
    made.push_back(make_primitive("capsule", "Capsule", round_mesh(capsule.radius, 2 * capsule.half_height)));
    made.push_back(make_primitive("cylinder", "Cylinder",
                                  revolve({{0, 0}, {cylinder.radius, 0}, {cylinder.radius, top}, {0, top}})));
    made.push_back(make_primitive("cone", "Cone", revolve({{0, 0}, {cone.radius, 0}, {0, apex}})));
    made.push_back(make_primitive("plane", "Plane", plane_mesh(2)));

    std::vector<Primitive> primitives;
    for (Result<Primitive>& one : made) {
        if (!one) return one.error();
        primitives.push_back(std::move(*one));
    }
    describe(primitives[0].model.facts.geometry, box);
    describe(primitives[1].model.facts.geometry, sphere);
    describe(primitives[2].model.facts.geometry, capsule);
    describe(primitives[3].model.facts.geometry, cylinder);
    describe(primitives[4].model.facts.geometry, cone);
    primitives[5].item.movable = false;
    return primitives;
}

}  // namespace embody::catalog
