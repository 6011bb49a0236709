// SPDX-License-Identifier: MIT
#include "catalog/soft_mesh.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "attributes/physical_kind.h"
#include "catalog/prepare/byte_stream.h"
#include "geometry/tetrahedra/fill.h"
#include "geometry/tetrahedra/separation.h"
#include "geometry/topology.h"

namespace embody::catalog {
namespace {

constexpr int revision = 2;                  // of make_soft_mesh(): a change makes all of them anew
constexpr double min_volume_fraction = 0.4;  // of the volume: with less it is mostly thin parts
constexpr double min_piece_fraction = 0.5;   // of the mesh: with less there is no piece that the others hang on
constexpr double weld_fraction = 1e-6;       // of the size, as the volume estimate welds
constexpr std::size_t max_nodes = 100'000;
// A count more than this many times the wanted one is not by chance: the body is flat.
constexpr double max_surplus = 1.3;
constexpr double max_flatness = 8;

// The smallest extent, or for hollow or branched bodies that of a plate of as much surface, and half of it more for
// edges: 3 V/A (ball: half its diameter).
double thickness_of(double volume, double area, Vec3 size) {
    return std::min(std::min({size.x, size.y, size.z}), 3 * volume / area);
}

// Two of the lattice's cubes across the thickness, with 12 tetrahedra each.
int wanted_tetrahedra(double volume, double thickness) {
    const double cell = thickness / 2;
    const double count = 12 * volume / (cell * cell * cell);
    if (!(count < max_soft_tetrahedra)) return max_soft_tetrahedra;
    return std::max(min_soft_tetrahedra, static_cast<int>(count));
}

constexpr const char* soft_mesh_place = "soft mesh";

Error cannot_be_soft(std::string why, std::string remedy) {
    return {soft_mesh_place, std::move(why), std::move(remedy)};
}

std::string percent(double fraction) { return std::to_string(std::lround(100 * fraction)) + " %"; }

bool has_too_many(const geometry::TetrahedralMesh& mesh) {
    return static_cast<double>(mesh.tetrahedra.size()) > max_surplus * max_soft_tetrahedra;
}

// Across the thinnest extent, by a factor.
template <class Points>
void stretch(Points& points, Vec3 size, double factor) {
    const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    for (auto& point : points) {
        Vec3 moved = Vec3{point.x, point.y, point.z};
        moved[axis] *= factor;
        if constexpr (std::is_same_v<std::decay_t<decltype(point)>, Vec3>)
            point = moved;
        else
            point = to_vec3f(moved);
    }
}

struct Filled {
    geometry::TetrahedralFilling filling;
    double flatness = 1;
};

// Cubes, so many across the thickness.
Result<Filled> fill_with(const geometry::TriangleMesh& welded, double volume, double thickness, int resolution) {
    const double cell = thickness / resolution, wanted = 12 * volume / (cell * cell * cell);
    const auto limit = static_cast<double>(max_resolved_tetrahedra);
    if (!(wanted < 2 * limit)) return too_fine(resolution, static_cast<std::size_t>(std::min(wanted, 1e12)));
    geometry::TetrahedralParameters parameters;
    parameters.cell = cell;
    auto filling = geometry::fill_with_tetrahedra(welded, parameters);
    if (!filling) return filling.error();
    const std::size_t count = filling->mesh.tetrahedra.size();
    if (count > max_resolved_tetrahedra) return too_fine(resolution, count);
    return Filled{std::move(*filling), 1};
}

// Cubes, or where that takes too many, cells as if the body were thicker, which makes them flat.
Result<Filled> fill(const geometry::TriangleMesh& welded, double volume, double thickness, Vec3 size) {
    geometry::TetrahedralParameters parameters;
    parameters.tetrahedra = wanted_tetrahedra(volume, thickness);
    auto filling = geometry::fill_with_tetrahedra(welded, parameters);
    if (!filling) return filling.error();
    Filled filled{std::move(*filling), 1};
    while (has_too_many(filled.filling.mesh)) {
        const double flatness = 2 * filled.flatness;
        if (flatness > max_flatness)
            return Error{"surface", "is too flat: even with cells 8 times as wide as thick it takes " +
                                        std::to_string(filled.filling.mesh.tetrahedra.size()) + " tetrahedra"};
        geometry::TriangleMesh thicker = welded;
        stretch(thicker.positions, size, flatness);
        auto flat = geometry::fill_with_tetrahedra(thicker, parameters);
        if (!flat) return flat.error();
        filled = {std::move(*flat), flatness};
        stretch(filled.filling.mesh.nodes, size, 1 / flatness);
    }
    return filled;
}

// Only the largest component: the others would fall off.
Result<std::size_t> keep_largest(geometry::TetrahedralMesh& mesh) {
    geometry::TetrahedralComponents pieces = geometry::find_components(mesh);
    double whole = 0;
    for (const double volume : pieces.volumes) whole += volume;
    const std::size_t count = pieces.volumes.size();
    if (pieces.volumes.front() < min_piece_fraction * whole)
        return cannot_be_soft("it has " + std::to_string(count) + " pieces that do not hang together",
                              "import them as models of their own");
    geometry::keep_components(mesh, pieces, 1);
    return count - 1;
}

// Through an array of floats: gcc 12 removes a rounding there and back of the same value when it vectorises.
void to_single_precision(std::vector<Vec3>& nodes) {
    std::vector<Vec3f> rounded;
    rounded.reserve(nodes.size());
    for (const Vec3 node : nodes) rounded.push_back(to_vec3f(node));
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = to_vec3(rounded[i]);
}

}  // namespace

Error too_fine(int resolution, std::size_t tetrahedra) {
    return cannot_be_soft("its soft_resolution of " + std::to_string(resolution) + " takes " +
                              std::to_string(tetrahedra) + " tetrahedra, more than " +
                              std::to_string(max_resolved_tetrahedra),
                          "give it a lower soft_resolution, or 0");
}

Result<SoftMesh> make_soft_mesh(const geometry::TriangleMesh& surface, int resolution) {
    const Vec3 size = geometry::bounds(surface).size();
    const geometry::TriangleMesh welded = geometry::weld(surface, weld_fraction * std::max({size.x, size.y, size.z}));
    const geometry::VolumeEstimate estimate = geometry::estimate_volume(welded);
    if (estimate.method == geometry::VolumeMethod::no_volume)
        return cannot_be_soft("its surface encloses nothing", "make it rigid, or cloth if it is a sheet");
    const double volume = estimate.solid.volume, thickness = thickness_of(volume, geometry::surface_area(welded), size);
    auto made =
        resolution > 0 ? fill_with(welded, volume, thickness, resolution) : fill(welded, volume, thickness, size);
    if (!made && made.error().where == soft_mesh_place) return made.error();
    if (!made) return cannot_be_soft("its surface " + made.error().why, "make it rigid, or cloth if it is a sheet");
    geometry::TetrahedralFilling* filled = &made->filling;
    if (filled->volume_fraction < min_volume_fraction)
        return cannot_be_soft("it is too thin: " + std::to_string(filled->mesh.tetrahedra.size()) +
                                  " tetrahedra fill only " + percent(filled->volume_fraction) + " of its volume",
                              "make it rigid, or cloth if it is a sheet");
    SoftMesh soft{std::move(filled->mesh), filled->cell, made->flatness, filled->volume_fraction,
                  filled->left_out_components};
    const auto left_out = keep_largest(soft.mesh);
    if (!left_out) return left_out.error();
    soft.left_out += *left_out;
    to_single_precision(soft.mesh.nodes);
    geometry::find_surface(soft.mesh);
    return soft;
}

database::StoredSimulationMesh stored_form(const Result<SoftMesh>& mesh) {
    database::StoredSimulationMesh stored{attributes::to_text(attributes::PhysicalKind::soft), revision, {}, {}};
    if (!mesh) {
        stored.problem = mesh.error().why;
        if (!mesh.error().remedy.empty()) stored.problem += "\n" + mesh.error().remedy;
        return stored;
    }
    ByteWriter out;
    out.number(mesh->cell);
    out.number(mesh->flatness);
    out.number(mesh->volume_fraction);
    out.number(static_cast<std::uint64_t>(mesh->left_out));
    out.number(static_cast<std::uint64_t>(mesh->mesh.nodes.size()));
    for (const Vec3 node : mesh->mesh.nodes) {
        for (int i = 0; i < 3; ++i) out.number(static_cast<float>(node[i]));
    }
    out.number(static_cast<std::uint64_t>(mesh->mesh.tetrahedra.size()));
    for (const geometry::Tetrahedron& t : mesh->mesh.tetrahedra) {
        for (const std::uint32_t node : t) out.number(node);
    }
    stored.mesh = out.take();
    return stored;
}

bool is_current(const database::StoredSimulationMesh& stored) { return stored.revision == revision; }

Result<SoftMesh> soft_mesh_from(const database::StoredSimulationMesh& stored) {
    if (!stored.problem.empty()) {
        const std::size_t line = stored.problem.find('\n');
        return cannot_be_soft(stored.problem.substr(0, line),
                              line == std::string::npos ? std::string() : stored.problem.substr(line + 1));
    }
    ByteReader in(stored.mesh);
    SoftMesh soft;
    soft.cell = in.number<double>();
    soft.flatness = in.number<double>();
    soft.volume_fraction = in.number<double>();
    soft.left_out = static_cast<std::size_t>(in.number<std::uint64_t>());
    soft.mesh.nodes.resize(in.count(max_nodes, 3 * sizeof(float)));
    for (Vec3& node : soft.mesh.nodes) {
        for (int i = 0; i < 3; ++i) node[i] = in.number<float>();
        if (!is_finite(node)) in.fail();
    }
    soft.mesh.tetrahedra.resize(in.count(8 * max_nodes, 4 * sizeof(std::uint32_t)));
    for (geometry::Tetrahedron& t : soft.mesh.tetrahedra) {
        for (std::uint32_t& node : t) node = in.number<std::uint32_t>();
        const bool is_inside = std::ranges::all_of(t, [&](std::uint32_t n) { return n < soft.mesh.nodes.size(); });
        if (!is_inside || !(geometry::signed_volume(soft.mesh, t) > 0)) {
            in.fail();
            break;
        }
    }
    if (!in.is_complete() || soft.mesh.tetrahedra.empty() || !(soft.cell > 0))
        return Error{soft_mesh_place, "is damaged", "import the model again"};
    geometry::find_surface(soft.mesh);
    return soft;
}

}  // namespace embody::catalog
