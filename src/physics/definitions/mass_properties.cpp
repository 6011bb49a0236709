// SPDX-License-Identifier: MIT
// Closed forms: any table of moments of inertia. Polyhedra: sums over signed tetrahedra (geometry/mass_properties.cpp).
#include "physics/definitions/mass_properties.h"

#include <array>
#include <numbers>

#include "geometry/mean_point.h"
#include "physics/definitions/box_faces.h"

namespace embody::physics {

namespace {

using geometry::MassProperties;
using std::numbers::pi;

MassProperties round_mass(double r, double h) {
    const double m = 2 * pi * r * r * h;
    const double across = m * (r * r / 4 + h * h / 3);
    return {m, {}, Mat3::diagonal({across, m * r * r / 2, across})};
}

/// Takes the mass properties of one kind of shape.
struct Solid {
    template <class ConvexShape>
    Result<MassProperties> operator()(const ConvexShape& shape) const {
        return mass_properties(shape);
    }
    Result<MassProperties> operator()(const HasCorners auto& shape) const {
        const auto hull = geometry::build_convex_hull(shape.corners(), max_hull_vertices);
        if (!hull) return Error{"points", hull.error().why, hull.error().remedy};
        return mass_properties(*hull);
    }
    Result<MassProperties> operator()(const PlaneShape&) const { return MassProperties{}; }
    Result<MassProperties> operator()(const HeightfieldShape&) const { return MassProperties{}; }
    Result<MassProperties> operator()(const MeshShape& mesh) const { return enclosed_by(mesh).solid; }
    Result<MassProperties> operator()(const CompoundShape& compound) const {
        MassProperties sum;
        for (std::size_t i = 0; i < compound.children.size(); ++i) {
            const CompoundChild& child = compound.children[i];
            const Result<MassProperties> piece = std::visit(Solid{}, child.shape);
            if (!piece) {
                const Error& e = piece.error();
                return Error{"children[" + std::to_string(i) + "]." + e.where, e.why, e.remedy};
            }
            add_piece(sum, *piece, {child.local.position, normalized(child.local.rotation)});
        }
        return sum;
    }
    Result<MassProperties> operator()(const HasParts auto& shape) const {
        return (*this)(CompoundShape{shape.parts()});
    }
};

}  // namespace

MassProperties mass_properties(const SphereShape& sphere) {
    const double r = sphere.radius;
    const double m = 4.0 / 3 * pi * r * r * r;
    const double i = 0.4 * m * r * r;
    return {m, {}, Mat3::diagonal({i, i, i})};
}

MassProperties mass_properties(const BoxShape& box) {
    const std::array<Vec3, 8> corners = box_corners(box.half_extents);
    geometry::PolyhedronIntegral integral(geometry::mean_point(corners));
    for (const auto& [a, b, c, d] : box_faces) {
        integral.add_triangle(corners[a], corners[b], corners[c]);
        integral.add_triangle(corners[a], corners[c], corners[d]);
    }
    return integral.mass_properties();
}

MassProperties mass_properties(const CapsuleShape& capsule) {
    const double r = capsule.radius, h = capsule.half_height;
    const MassProperties middle = round_mass(r, h);
    const double caps = 4.0 / 3 * pi * r * r * r;
    // Each half sphere: about its own centre of mass 3/8 r off the cap's centre, then moved.
    const double axial = 0.4 * caps * r * r;
    const double across = caps * (0.4 * r * r + h * h + 0.75 * h * r);
    return {middle.volume + caps, {}, middle.inertia + Mat3::diagonal({across, axial, across})};
}

MassProperties mass_properties(const CylinderShape& cylinder) {
    return round_mass(cylinder.radius, cylinder.half_height);
}

MassProperties mass_properties(const ConeShape& cone) {
    const double r = cone.radius, height = 2 * cone.half_height;
    const double m = pi / 3 * r * r * height;
    const double across = m * (0.15 * r * r + 0.0375 * height * height);
    return {m, {0, -cone.half_height / 2, 0}, Mat3::diagonal({across, 0.3 * m * r * r, across})};
}

MassProperties mass_properties(const geometry::ConvexHull& hull) {
    const MassProperties solid = geometry::integrate_hull(hull);
    return solid.volume > 0 ? solid : MassProperties{};
}

void add_piece(MassProperties& sum, const MassProperties& piece, const Transform& local) {
    const MassProperties placed = geometry::transformed(local, piece);
    sum = sum.volume > 0 ? geometry::combined(sum, placed) : placed;
}

geometry::VolumeEstimate enclosed_by(const MeshShape& mesh) {
    const geometry::TriangleMesh surface{mesh.positions, mesh.triangles};
    if (!geometry::validate(surface)) return {};
    geometry::VolumeEstimate enclosed = geometry::estimate_volume(surface);
    if (enclosed.method == geometry::VolumeMethod::no_volume) enclosed.solid = {};
    return enclosed;
}

Result<MassProperties> mass_properties(const ShapeDefinition& shape) {
    if (auto valid = validate(shape); !valid) return valid.error();
    return std::visit(Solid{}, shape);
}

Result<BodyMass> body_mass(const MassDefinition& definition, const MassProperties& solid) {
    const bool has_solid = solid.volume > 0;
    if (!definition.mass && !has_solid) return Error{"mass.mass", "must be given: the body has no shape with a volume"};
    const double mass = definition.mass ? *definition.mass : definition.density * solid.volume;
    if (!(mass >= 1e-9 && mass <= 1e12)) return Error{"mass.density", "gives a mass outside 1e-9 … 1e12 kg"};
    const Vec3 center = definition.center_of_mass ? *definition.center_of_mass : solid.center;

    // A homogeneous solid's inertia, scaled to the mass; about a given centre by the parallel axis theorem.
    Mat3 inertia;
    if (definition.inertia) {
        inertia = *definition.inertia;
    } else if (has_solid) {
        inertia = geometry::inertia_about(solid.inertia, solid.volume, center - solid.center) * (mass / solid.volume);
    } else {
        return Error{"mass.inertia", "must be given: the body has no shape with a volume"};
    }
    return BodyMass{mass, center, (inertia + transpose(inertia)) * 0.5};
}

}  // namespace embody::physics
