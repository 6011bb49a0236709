// SPDX-License-Identifier: MIT
#include "catalog/soft_mesh.h"

#include <algorithm>
#include <cmath>

#include "catalog/prepare/byte_stream.h"
#include "geometry/tetrahedra/fill.h"
#include "geometry/tetrahedra/separation.h"
#include "geometry/topology.h"

namespace embody::catalog {
namespace {

constexpr int revision = 1;          // of make_soft_mesh(): a change makes all of them anew
constexpr double least_share = 0.4;  // of the volume: with less it is mostly thin parts
constexpr double least_piece = 0.5;  // of the mesh: with less there is no piece that the others hang on
constexpr double weld_share = 1e-6;  // of the size, as the volume estimate welds
constexpr std::size_t most_nodes = 100'000;

// Two of the lattice's cubes across the thickness, with 12 tetrahedra each. Thickness is the least extent, or for what
// is hollow or branched that of a plate of as much surface, and half of it more for edges: 3 V/A (ball: half its
// diameter).
int wanted_tetrahedra(double volume, double area, Vec3 size) {
    const double thickness = std::min(std::min({size.x, size.y, size.z}), 3 * volume / area);
    const double cell = thickness / 2;
    const double count = 12 * volume / (cell * cell * cell);
    if (!(count < most_soft_tetrahedra)) return most_soft_tetrahedra;
    return std::max(fewest_soft_tetrahedra, static_cast<int>(count));
}

Error cannot_be_soft(std::string why, std::string remedy) { return {"soft mesh", std::move(why), std::move(remedy)}; }

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

// The largest piece alone: the others would fall apart from it.
Result<std::size_t> keep_largest(geometry::TetrahedralMesh& mesh) {
    geometry::TetrahedralComponents pieces = geometry::find_components(mesh);
    double whole = 0;
    for (const double volume : pieces.volumes) whole += volume;
    const std::size_t count = pieces.volumes.size();
    if (pieces.volumes.front() < least_piece * whole)
        return cannot_be_soft("it has " + std::to_string(count) + " pieces that do not hang together",
                              "import them as models of their own");
    geometry::keep_components(mesh, pieces, 1);
    return count - 1;
}

// By way of an array of floats: gcc 12 takes a rounding there and back of the same value for none when it vectorises.
void to_single_precision(std::vector<Vec3>& nodes) {
    std::vector<Vec3f> rounded;
    rounded.reserve(nodes.size());
    for (const Vec3 node : nodes) rounded.push_back(to_vec3f(node));
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = to_vec3(rounded[i]);
}

}  // namespace

Result<SoftMesh> make_soft_mesh(const geometry::TriangleMesh& surface) {
    const Vec3 size = geometry::bounds(surface).size();
    const geometry::TriangleMesh welded = geometry::weld(surface, weld_share * std::max({size.x, size.y, size.z}));
    const geometry::VolumeEstimate estimate = geometry::estimate_volume(welded);
    if (estimate.method == geometry::VolumeMethod::no_volume)
        return cannot_be_soft("its surface encloses nothing", "make it rigid, or cloth if it is a sheet");
    geometry::TetrahedralParameters parameters;
    parameters.tetrahedra = wanted_tetrahedra(estimate.solid.volume, geometry::surface_area(welded), size);
    auto filled = geometry::fill_with_tetrahedra(welded, parameters);
    if (!filled) return cannot_be_soft("its surface " + filled.error().why, "make it rigid, or cloth if it is a sheet");
    if (filled->volume_share < least_share)
        return cannot_be_soft("it is too thin: " + std::to_string(filled->mesh.tetrahedra.size()) +
                                  " tetrahedra fill only " + percent(filled->volume_share) + " of its volume",
                              "make it rigid, or cloth if it is a sheet");
    SoftMesh soft{std::move(filled->mesh), filled->cell, filled->volume_share, filled->left_out_components};
    const auto left_out = keep_largest(soft.mesh);
    if (!left_out) return left_out.error();
    soft.left_out += *left_out;
    to_single_precision(soft.mesh.nodes);
    geometry::find_surface(soft.mesh);
    return soft;
}

database::StoredSimulationMesh stored_form(const Result<SoftMesh>& mesh) {
    database::StoredSimulationMesh stored{"soft", revision, {}, {}};
    if (!mesh) {
        stored.problem = mesh.error().why;
        if (!mesh.error().remedy.empty()) stored.problem += "\n" + mesh.error().remedy;
        return stored;
    }
    ByteWriter out;
    out.number(mesh->cell);
    out.number(mesh->volume_share);
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
    soft.volume_share = in.number<double>();
    soft.left_out = static_cast<std::size_t>(in.number<std::uint64_t>());
    soft.mesh.nodes.resize(in.count(most_nodes, 3 * sizeof(float)));
    for (Vec3& node : soft.mesh.nodes) {
        for (int i = 0; i < 3; ++i) node[i] = in.number<float>();
        if (!is_finite(node)) in.fail();
    }
    soft.mesh.tetrahedra.resize(in.count(8 * most_nodes, 4 * sizeof(std::uint32_t)));
    for (geometry::Tetrahedron& t : soft.mesh.tetrahedra) {
        for (std::uint32_t& node : t) node = in.number<std::uint32_t>();
        const bool is_inside = std::ranges::all_of(t, [&](std::uint32_t n) { return n < soft.mesh.nodes.size(); });
        if (!is_inside || !(geometry::signed_volume(soft.mesh, t) > 0)) {
            in.fail();
            break;
        }
    }
    if (!in.is_complete() || soft.mesh.tetrahedra.empty() || !(soft.cell > 0))
        return Error{"soft mesh", "is damaged", "import the model again"};
    geometry::find_surface(soft.mesh);
    return soft;
}

}  // namespace embody::catalog
