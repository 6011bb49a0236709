// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/fill.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/tetrahedra/separation.h"
#include "geometry/tetrahedra/stuffing.h"
#include "geometry/topology.h"

namespace embody::geometry {
namespace {

constexpr double weld_tolerance = 1e-6;  // of the mesh's size, as estimate_volume() does
constexpr double tetrahedra_a_cube = 12;
constexpr double most_nodes = 4e6;         // of the lattice where the cell is given
constexpr double most_nodes_sought = 3e5;  // and where it is sought
constexpr int most_tries = 8;
constexpr double near_enough = 0.1;  // of the number of tetrahedra

Error wrong(const char* field, std::string why, std::string remedy = {}) {
    return {std::string("tetrahedra: ") + field, std::move(why), std::move(remedy)};
}

Result<void> check(const TriangleMesh& surface, const TetrahedralParameters& p) {
    if (p.cell == 0 && (p.tetrahedra < least_tetrahedra || p.tetrahedra > most_tetrahedra))
        return wrong("tetrahedra", "must be 50 to 200000, got " + std::to_string(p.tetrahedra));
    if (!(p.cell >= 0) || !std::isfinite(p.cell))
        return wrong("cell", "must be 0 or a length in m, got " + std::to_string(p.cell));
    if (!(p.least_component >= 0 && p.least_component <= 1))
        return wrong("least_component", "must be 0 to 1, got " + std::to_string(p.least_component));
    if (surface.triangles.empty()) return wrong("surface", "has no triangles", "give a mesh that encloses something");
    return validate(surface);
}

TetrahedralMesh stuffed(const EnclosedSolid& solid, double cell) {
    TetrahedralMesh mesh = stuff(solid, cell);
    separate(mesh);
    return mesh;
}

struct Sought {
    TetrahedralMesh mesh;
    double cell = 0;
};

// The side of the cubes at which there are as many tetrahedra as wanted, within a tenth where possible.
Sought seek(const EnclosedSolid& solid, double volume, int wanted) {
    const double finest = [&] {
        double cell = std::cbrt(solid.bounds().size().x * solid.bounds().size().y * solid.bounds().size().z) / 100;
        cell = std::max(cell, length(solid.bounds().size()) / 1e5);
        while (count_lattice_nodes(solid.bounds(), cell) > most_nodes_sought) cell *= 1.1;
        return cell;
    }();
    // Those at the surface are cut into more, so that there are about twice as many in coarse meshes.
    double cell = std::max(finest, std::cbrt(1.6 * tetrahedra_a_cube * volume / wanted));
    double too_fine = finest, too_coarse = std::numeric_limits<double>::infinity();
    Sought best;
    double best_miss = std::numeric_limits<double>::infinity();
    for (int i = 0; i < most_tries; ++i) {
        Sought made{stuffed(solid, cell), cell};
        const double ratio = static_cast<double>(made.mesh.tetrahedra.size()) / wanted;
        const double miss = std::fabs(std::log(std::max(ratio, 1e-9)));
        (ratio > 1 ? too_fine : too_coarse) = cell;
        if (miss < best_miss) {
            best = std::move(made);
            best_miss = miss;
        }
        if (best_miss < near_enough || (ratio <= 1 && cell == finest)) break;
        // The count jumps where the lattice begins to miss a thin part, so a guess beyond the tried ones is not used.
        cell *= std::clamp(std::cbrt(ratio), 0.5, 2.0);
        if (!(cell > too_fine)) cell = std::isfinite(too_coarse) ? std::sqrt(too_fine * too_coarse) : too_fine;
        if (!(cell < too_coarse)) cell = std::sqrt(too_fine * too_coarse);
    }
    return best;
}

}  // namespace

Result<TetrahedralFilling> fill_with_tetrahedra(const TriangleMesh& surface, const TetrahedralParameters& parameters) {
    if (const auto fine = check(surface, parameters); !fine) return fine.error();
    const VolumeEstimate estimate = estimate_volume(surface);
    if (estimate.method == VolumeMethod::no_volume)
        return wrong("surface", "encloses no volume: it is a sheet or a line",
                     "close the surface or give the sheet a thickness; cloth needs no tetrahedra");
    const double size = length(bounds(surface).size());
    const EnclosedSolid solid(oriented_outwards(weld(surface, weld_tolerance * size)));
    if (parameters.cell > 0 && count_lattice_nodes(solid.bounds(), parameters.cell) > most_nodes)
        return wrong("cell", "is too small for a thing of " + std::to_string(size) + " m: above 4 million nodes",
                     "choose a larger one");

    Sought found = parameters.cell > 0 ? Sought{stuffed(solid, parameters.cell), parameters.cell}
                                       : seek(solid, estimate.solid.volume, parameters.tetrahedra);
    if (found.mesh.tetrahedra.empty())
        return wrong("surface", "is thinner everywhere than the cells of " + std::to_string(found.cell) + " m",
                     "ask for more tetrahedra or a smaller cell, or treat it as a sheet");

    TetrahedralFilling filling;
    filling.cell = found.cell;
    filling.method = estimate.method;
    TetrahedralComponents components = find_components(found.mesh);
    const double least = parameters.least_component * volume(found.mesh);
    const auto kept =
        std::find_if(components.volumes.begin() + 1, components.volumes.end(), [&](double v) { return v < least; }) -
        components.volumes.begin();
    filling.left_out_components = components.volumes.size() - static_cast<std::size_t>(kept);
    keep_components(found.mesh, components, static_cast<std::size_t>(kept));
    find_surface(found.mesh);
    filling.volume_fraction = volume(found.mesh) / estimate.solid.volume;
    filling.mesh = std::move(found.mesh);
    filling.component_of = std::move(components.component_of);
    filling.component_volumes = std::move(components.volumes);
    return filling;
}

}  // namespace embody::geometry
