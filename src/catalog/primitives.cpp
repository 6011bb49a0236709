// SPDX-License-Identifier: MIT
// Volumes and inertias: Beer, Johnston, Vector Mechanics for Engineers, inside back cover; the capsule by adding a
// cylinder and two half spheres, moved apart by the parallel axis theorem.
#include "catalog/primitives.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "catalog/prepare/geometry_measurement.h"
#include "catalog/prepare/surface_finish.h"
#include "catalog/prepare/thumbnail.h"
#include "interchange/compact/compact_geometry.h"
#include "physics/definitions/shape_definition.h"

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

/// Puts the formula's numbers in the place of the triangles'.
void set_solid(GeometryFacts& facts, double volume, double area, double center_height, Vec3 unit_inertia) {
    facts.closed = true;
    facts.volume = facts.hull_volume = volume;
    facts.volume_method = "formula of the shape";
    facts.volume_relative_error = 0;
    facts.surface_area = area;
    facts.center_of_volume = {0, center_height, 0};
    facts.unit_inertia = Mat3::diagonal(unit_inertia);
    facts.parts.clear();  // solid, of one material
}

void set_fit(GeometryFacts& facts, std::string shape, Vec3 dimensions) {
    facts.fitted_shape = std::move(shape);
    facts.fitted_dimensions = dimensions;
    facts.fitted_pose = {facts.center_of_volume, {}};
    facts.fitted_error = 0;
}

void describe_box(GeometryFacts& facts, Vec3 half) {
    const Vec3 s = 2.0 * half;
    const double volume = s.x * s.y * s.z;
    const Vec3 inertia = volume / 12 * Vec3{s.y * s.y + s.z * s.z, s.x * s.x + s.z * s.z, s.x * s.x + s.y * s.y};
    set_solid(facts, volume, 2 * (s.x * s.y + s.y * s.z + s.z * s.x), half.y, inertia);
    set_fit(facts, "box", half);
}

// A sphere is a capsule without a middle.
void describe_round(GeometryFacts& facts, double r, double half_height) {
    const double l = 2 * half_height, middle = pi * r * r * l, ends = 4.0 / 3 * pi * r * r * r;
    const double about_axis = middle * r * r / 2 + ends * 2 / 5 * r * r;
    const double across = middle * (l * l / 12 + r * r / 4) + ends * (2.0 / 5 * r * r + l * l / 4 + 3.0 / 8 * l * r);
    set_solid(facts, middle + ends, 2 * pi * r * l + 4 * pi * r * r, r + half_height, {across, about_axis, across});
    set_fit(facts, l > 0 ? "capsule" : "sphere", {r, half_height, 0});
}

void describe_cylinder(GeometryFacts& facts, double r, double half_height) {
    const double h = 2 * half_height, volume = pi * r * r * h;
    const double across = volume * (3 * r * r + h * h) / 12;
    set_solid(facts, volume, 2 * pi * r * (r + h), half_height, {across, volume * r * r / 2, across});
    set_fit(facts, "cylinder", {r, half_height, 0});
}

void describe_cone(GeometryFacts& facts, double r, double half_height) {
    const double h = 2 * half_height, volume = pi * r * r * h / 3;
    const double across = volume * (3.0 / 20 * r * r + 3.0 / 80 * h * h);
    set_solid(facts, volume, pi * r * (r + std::sqrt(r * r + h * h)), h / 4, {across, volume * 3 / 10 * r * r, across});
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
    describe_box(primitives[0].model.facts.geometry, box.half_extents);
    describe_round(primitives[1].model.facts.geometry, sphere.radius, 0);
    describe_round(primitives[2].model.facts.geometry, capsule.radius, capsule.half_height);
    describe_cylinder(primitives[3].model.facts.geometry, cylinder.radius, cylinder.half_height);
    describe_cone(primitives[4].model.facts.geometry, cone.radius, cone.half_height);
    primitives[5].item.movable = false;
    return primitives;
}

}  // namespace embody::catalog
