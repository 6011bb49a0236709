// SPDX-License-Identifier: MIT
#include "geometry/decomposition/measure_decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "foundation/random.h"
#include "geometry/decomposition/solid_grid.h"
#include "geometry/topology.h"
#include "geometry/volume_estimate.h"

namespace embody::geometry {
namespace {

constexpr double measured_weld_share = 1e-6;  // of the longest side
constexpr double touching = 1e-9;             // m: nearer to a hull counts as on it

double height_over(const ConvexHull& hull, Vec3 p) {
    double most = -std::numeric_limits<double>::infinity();
    for (const auto& face : hull.faces) most = std::max(most, dot(face.normal, p) - face.offset);
    return most;
}

// Calls visit(point) for places spread evenly by area over the triangles, `wanted` in all; the number of each triangle
// is rounded by a fixed sequence.
template <class Visit>
void spread(const TriangleMesh& mesh, double area_of_one, Random& random, Visit visit) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = corners(mesh, i);
        const double area = 0.5 * length(cross(b - a, c - a));
        const int count = static_cast<int>(std::floor(area / area_of_one + random.unit()));
        for (int k = 0; k < count; ++k) {
            double u = random.unit(), v = random.unit();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            visit(a + u * (b - a) + v * (c - a));
        }
    }
}

}  // namespace

DecompositionMeasure measure_decomposition(const TriangleMesh& mesh, std::span<const ConvexHull> hulls, int samples) {
    DecompositionMeasure measure;
    if (mesh.triangles.empty() || hulls.empty()) return measure;
    const Vec3 size = bounds(mesh).size();
    const TriangleMesh welded = oriented_outwards(weld(mesh, measured_weld_share * std::max({size.x, size.y, size.z})));
    const SurfaceDistance surface(welded);
    const WindingNumber winding(welded);
    Random random(1);

    // From the hulls' union to the mesh: places inside another hull are not on the union.
    double hull_area = 0;
    std::vector<TriangleMesh> surfaces;
    std::vector<Bounds> boxes;
    for (const ConvexHull& hull : hulls) {
        surfaces.push_back(to_mesh(hull));
        boxes.push_back(enlarged(bounds(hull), touching));
        hull_area += surface_area(surfaces.back());
        measure.hull_volume += integrate_hull(hull).volume;
        measure.vertices += hull.vertices.size();
    }
    std::vector<double> distances;
    for (std::size_t i = 0; i < hulls.size(); ++i) {
        spread(surfaces[i], hull_area / samples, random, [&](Vec3 p) {
            for (std::size_t k = 0; k < hulls.size(); ++k) {
                if (k != i && contains(boxes[k], p) && height_over(hulls[k], p) < -touching) return;
            }
            const double away = surface.at(p);
            distances.push_back(winding.at(p) > 0.5 ? 0 : away);
        });
    }
    std::sort(distances.begin(), distances.end());
    if (!distances.empty()) {
        measure.added = distances.back();
        measure.added_95 = distances[distances.size() * 95 / 100];
    }

    // From the mesh to the hulls: the height over the nearest is at most the distance, and exact over a face.
    const auto to_hulls = [&](Vec3 p) {
        double least = std::numeric_limits<double>::infinity();
        for (const ConvexHull& hull : hulls) least = std::min(least, height_over(hull, p));
        measure.left_out = std::max(measure.left_out, least);
    };
    for (const Vec3f p : welded.positions) to_hulls(to_vec3(p));
    spread(welded, surface_area(welded) / samples, random, to_hulls);
    return measure;
}

}  // namespace embody::geometry
