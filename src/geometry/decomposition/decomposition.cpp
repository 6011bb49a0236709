// SPDX-License-Identifier: MIT
#include "geometry/decomposition/decomposition.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "geometry/decomposition/part.h"
#include "geometry/topology.h"

namespace embody::geometry {
namespace {

constexpr double weld_share = 1e-6;            // of the size
constexpr double largest_extent = 1e5;         // m
constexpr double most_sheet_thickness = 2e-3;  // m
constexpr std::size_t most_points_to_search = 4000;
constexpr std::size_t most_components = 128;  // more, and the whole is cut instead

Result<void> validate(const DecompositionParameters& p) {
    const std::string where = "convex decomposition: ";
    if (p.max_hulls < 1 || p.max_hulls > max_decomposition_hulls) {
        return Error{where + "max_hulls", "must be from 1 to 256, got " + std::to_string(p.max_hulls)};
    }
    if (!(p.hull_error >= min_hull_error) || !(p.hull_error <= largest_extent)) {
        return Error{where + "hull_error",
                     "must be from 0.0001 m to 100 km, got " + std::to_string(p.hull_error) + " m"};
    }
    if (p.max_vertices < 8 || p.max_vertices > 256) {
        return Error{where + "max_vertices", "must be from 8 to 256, got " + std::to_string(p.max_vertices)};
    }
    if (p.cells < 4096 || p.cells > (1 << 24)) {
        return Error{where + "cells", "must be from 4096 to 16777216, got " + std::to_string(p.cells)};
    }
    return {};
}

Result<TriangleMesh> checked_and_welded(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) {
        return Error{"convex decomposition", "the mesh has no triangles", "take the hull of its points"};
    }
    if (auto valid = geometry::validate(mesh); !valid) return valid.error();
    const Vec3 size = bounds(mesh).size();
    const double largest = std::max({size.x, size.y, size.z});
    if (largest > largest_extent) {
        return Error{"convex decomposition", "the mesh is larger than 100 km", "check the unit of its file"};
    }
    TriangleMesh welded = weld(mesh, weld_share * largest);
    if (welded.triangles.empty()) {
        return Error{"convex decomposition", "no triangle of the mesh has an area", "take the hull of its points"};
    }
    return welded;
}

// Vertices of one small cell become the first of them. Cells grow until few enough vertices are left to search with.
TriangleMesh simplified(const TriangleMesh& mesh, double pitch) {
    const Bounds box = bounds(mesh);
    TriangleMesh result = mesh;
    while (result.positions.size() > most_points_to_search) {
        std::map<std::array<int, 3>, std::uint32_t> cells;
        TriangleMesh coarse;
        std::vector<std::uint32_t> index(result.positions.size());
        for (std::size_t i = 0; i < index.size(); ++i) {
            const Vec3 at = (to_vec3(result.positions[i]) - box.lower) / pitch;
            const auto next = static_cast<std::uint32_t>(coarse.positions.size());
            const auto [cell, is_new] = cells.try_emplace({int(at.x), int(at.y), int(at.z)}, next);
            index[i] = cell->second;
            if (is_new) coarse.positions.push_back(result.positions[i]);
        }
        for (const auto& t : result.triangles) {
            const std::array<std::uint32_t, 3> moved{index[t[0]], index[t[1]], index[t[2]]};
            if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) coarse.triangles.push_back(moved);
        }
        if (coarse.triangles.empty()) return result;
        result = weld(coarse, 0);
        pitch *= 1.5;
    }
    return result;
}

// Parts connected through edges: a corner is not enough, since a chair's legs often touch the seat's. None
// where there are very many.
std::vector<Part> connected_parts(const TriangleMesh& mesh) {
    const Topology topology = find_topology(mesh);
    std::vector<Part> parts;
    if (topology.component_count > most_components) return parts;
    for (const TriangleMesh& component : split_components(mesh, topology)) {
        Part& part = parts.emplace_back();
        for (const Vec3f p : component.positions) part.points.push_back(to_vec3(p));
        part.triangles = component.triangles;
    }
    return parts;
}

class Decomposer {
public:
    Decomposer(const TriangleMesh& welded, const DecompositionParameters& parameters);
    Result<Decomposition> run();
    [[nodiscard]] double hull_concavity() const { return whole_.concavity; }

private:
    Result<void> split();
    Result<Decomposition> finish();
    void reach_all_vertices();
    [[nodiscard]] bool tell(double share) const { return !parameters_.progress || parameters_.progress(share); }
    [[nodiscard]] static Error stopped() { return {"convex decomposition", "stopped as asked"}; }

    const TriangleMesh& mesh_;
    const DecompositionParameters& parameters_;
    TriangleMesh searched_;
    SolidGrid grid_;
    DecompositionSearch search_;
    Part whole_;
    std::vector<Part> parts_;
};

Decomposer::Decomposer(const TriangleMesh& welded, const DecompositionParameters& parameters)
    : mesh_(welded),
      parameters_(parameters),
      searched_(simplified(welded, 0.25 * parameters.hull_error)),
      grid_(searched_, parameters.cells, parameters.hull_error / 3, parameters.open_below),
      search_{grid_, parameters.hull_error, 0.05 * parameters.hull_error, grid_.cell(), 0.5 * parameters.hull_error} {
    for (const Vec3f p : searched_.positions) whole_.points.push_back(to_vec3(p));
    whole_.triangles = searched_.triangles;
    complete(whole_, grid_.voids(search_.void_depth), search_);
}

Result<void> Decomposer::split() {
    const std::size_t budget = parts_.size() + 2 * static_cast<std::size_t>(parameters_.max_hulls);
    while (parts_.size() < budget) {
        // Cuts the deepest part next.
        std::size_t deepest = parts_.size();
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            if (parts_[i].is_final || parts_[i].concavity <= parameters_.hull_error) continue;
            if (deepest == parts_.size() || parts_[i].concavity > parts_[deepest].concavity) deepest = i;
        }
        if (deepest == parts_.size()) return {};
        if (!tell(0.2 + 0.6 * static_cast<double>(parts_.size()) / static_cast<double>(budget))) return stopped();

        const auto plane = choose_cut(parts_[deepest], search_);
        auto sides = plane ? cut(parts_[deepest], *plane, search_) : std::nullopt;
        if (!sides) {
            parts_[deepest].is_final = true;
            continue;
        }
        parts_[deepest] = std::move(sides->first);
        parts_.push_back(std::move(sides->second));
    }
    return {};
}

// Vertices that simplification left out are added to the nearest hull.
void Decomposer::reach_all_vertices() {
    if (searched_.positions.size() == mesh_.positions.size()) return;
    for (const Vec3f position : mesh_.positions) {
        const Vec3 p = to_vec3(position);
        std::size_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < parts_.size() && least > search_.tolerance; ++i) {
            const double height = parts_[i].hull.height(p);
            if (height < least) {
                least = height;
                nearest = i;
            }
        }
        if (least > search_.tolerance) parts_[nearest].points.push_back(p);
    }
}

Result<Decomposition> Decomposer::finish() {
    reach_all_vertices();
    const double thickness = std::min(most_sheet_thickness, 0.5 * parameters_.hull_error);
    std::vector<std::pair<ConvexHull, double>> made;
    for (const Part& part : parts_) {
        auto hull = build_convex_hull(thickened(part.points, thickness), parameters_.max_vertices);
        if (!hull) hull = build_convex_hull(thickened(part.hull.vertices, grid_.cell()), parameters_.max_vertices);
        if (!hull) continue;
        made.emplace_back(std::move(*hull), part.concavity);
    }
    if (made.empty()) return Error{"convex decomposition", "no part has a hull", "take a box"};
    std::vector<double> volume(made.size());
    std::vector<std::size_t> order(made.size());
    for (std::size_t i = 0; i < made.size(); ++i) volume[i] = integrate_hull(made[i].first).volume;
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return volume[a] > volume[b]; });

    Decomposition result;
    result.hull_concavity = whole_.concavity;
    result.cell = grid_.cell();
    for (const std::size_t i : order) {
        result.hulls.push_back(std::move(made[i].first));
        result.depths.push_back(made[i].second);
        result.concavity = std::max(result.concavity, made[i].second);
    }
    return result;
}

Result<Decomposition> Decomposer::run() {
    if (!tell(0.2)) return stopped();
    const double enough = std::max(parameters_.hull_error, parameters_.keep_below);
    if (whole_.concavity <= enough || parameters_.max_hulls == 1) {
        parts_.push_back(whole_);
        return finish();
    }
    parts_ = connected_parts(searched_);
    if (parts_.size() < 2) {
        parts_.assign(1, whole_);
    } else {
        for (Part& part : parts_) complete(part, whole_.voids, search_);
    }
    if (auto done = split(); !done) return done.error();
    if (!tell(0.8)) return stopped();
    merge_parts(parts_, static_cast<std::size_t>(parameters_.max_hulls), search_);
    if (!tell(0.95)) return stopped();
    return finish();
}

}  // namespace

Result<Decomposition> decompose(const TriangleMesh& mesh, const DecompositionParameters& parameters) {
    if (auto valid = validate(parameters); !valid) return valid.error();
    const auto welded = checked_and_welded(mesh);
    if (!welded) return welded.error();
    return Decomposer(*welded, parameters).run();
}

Result<double> measure_hull_concavity(const TriangleMesh& mesh, const DecompositionParameters& parameters) {
    if (auto valid = validate(parameters); !valid) return valid.error();
    const auto welded = checked_and_welded(mesh);
    if (!welded) return welded.error();
    return Decomposer(*welded, parameters).hull_concavity();
}

}  // namespace embody::geometry
