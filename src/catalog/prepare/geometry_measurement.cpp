// SPDX-License-Identifier: MIT
#include "catalog/prepare/geometry_measurement.h"

#include <algorithm>
#include <limits>

#include "catalog/prepare/join_meshes.h"
#include "catalog/prepare/part_measurement.h"
#include "geometry/convex_hull.h"
#include "geometry/decomposition/decomposition.h"
#include "geometry/fit.h"
#include "geometry/topology.h"

namespace embody::catalog {
namespace {

constexpr double weld_fraction = 1e-6;  // of the largest extent, as the volume estimate welds
constexpr double min_thickness = 1e-3;  // m, of a flat model's box
constexpr int max_hull_points = 256;
constexpr int volume_cells = 16384;  // half of the usual: the grid is two thirds of an import's time

std::string words_for(geometry::VolumeMethod method) {
    switch (method) {
        case geometry::VolumeMethod::closed_mesh:
            return "polyhedral integration of the closed mesh (Mirtich 1996)";
        case geometry::VolumeMethod::closed_parts:
            return "polyhedral integration of closed parts, overlaps counted once";
        case geometry::VolumeMethod::winding_number:
            return "generalised winding number on a grid (Jacobson et al. 2013)";
        case geometry::VolumeMethod::no_volume:
            break;
    }
    return "none: the surface encloses nothing";
}

/// The corners of the bounds, thickened where they are flat.
void add_box_as_hull(const Bounds& bounds, GeometryMeasurement& measured) {
    const Vec3 half = max(bounds.half_extents(), Vec3{1, 1, 1} * (min_thickness / 2));
    const Vec3 c = bounds.center();
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 signs{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
        measured.hull_points.push_back(to_vec3f(c + scale(signs, half)));
    }
    measured.facts.hull_volume = 8 * half.x * half.y * half.z;
}

/// The primitive that stands well for the hull, else the hull itself.
void add_fit(const geometry::ConvexHull& hull, attributes::GeometryFacts& facts) {
    const auto fit = geometry::best_primitive(hull);
    if (!fit) return;
    facts.fitted_shape = geometry::name(fit->kind);
    facts.fitted_dimensions =
        fit->kind == geometry::PrimitiveKind::box ? fit->half_extents : Vec3{fit->radius, fit->half_height, 0};
    facts.fitted_pose = fit->local;
    facts.fitted_error = fit->deviation;
}

/// Measures how hollow the hull is, and decomposes a hollow body. A body that cannot be decomposed stays one hull.
void add_parts(const geometry::TriangleMesh& mesh, Decompose decompose, GeometryMeasurement& measured) {
    const geometry::DecompositionParameters usual;
    const double kept = decompose == Decompose::no ? std::numeric_limits<double>::infinity()
                                                   : attributes::negligible_concavity(measured.facts.size);
    auto parts = make_convex_parts(mesh, usual.max_hulls, usual.hull_error, kept);
    if (!parts) return;
    measured.facts.hull_concavity = parts->hull_concavity;
    if (parts->hulls.size() > 1) measured.convex_parts = std::move(*parts);
}

}  // namespace

GeometryMeasurement measure_geometry(const interchange::RawScene& scene, Decompose decompose) {
    const geometry::TriangleMesh raw = joined(scene, [](const interchange::RawMesh&) { return true; });
    const Bounds bounds = geometry::bounds(raw);
    const Vec3 size = bounds.size();
    const geometry::TriangleMesh mesh = geometry::weld(raw, weld_fraction * std::max({size.x, size.y, size.z}));

    GeometryMeasurement measured;
    measured.triangles = raw.triangles.size();
    measured.triangles_kept = mesh.triangles.size();
    attributes::GeometryFacts& facts = measured.facts;
    facts.size = size;
    facts.surface_area = geometry::surface_area(mesh);
    const geometry::Topology topology = geometry::find_topology(mesh);
    measured.inconsistent_edges = topology.inconsistent_edges;

    // The volume that it encloses, by the most certain method that applies.
    const geometry::VolumeEstimate estimate = geometry::estimate_volume(mesh, volume_cells);
    measured.volume_method = estimate.method;
    facts.closed = estimate.method == geometry::VolumeMethod::closed_mesh;
    facts.volume = estimate.solid.volume;
    facts.volume_method = words_for(estimate.method);
    facts.volume_relative_error = estimate.relative_error;
    facts.center_of_volume = estimate.solid.center;
    facts.unit_inertia = estimate.solid.inertia;
    facts.parts = measure_parts(scene);

    // Hull, or a box where the model is flat.
    facts.fitted_shape = "convex_hull";
    const auto hull = geometry::build_convex_hull(mesh, max_hull_points);
    if (!hull) {
        add_box_as_hull(bounds, measured);
    } else {
        for (const Vec3 p : hull->vertices) measured.hull_points.push_back(to_vec3f(p));
        facts.hull_volume = geometry::integrate_hull(*hull).volume;
        add_fit(*hull, facts);
        add_parts(mesh, decompose, measured);
    }
    return measured;
}

}  // namespace embody::catalog
