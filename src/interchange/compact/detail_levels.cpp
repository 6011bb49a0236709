// SPDX-License-Identifier: MIT
#include "interchange/compact/detail_levels.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>
#include <map>

#include "math/vec3.h"

namespace embody::interchange {
namespace {

using Point = std::array<float, 3>;

/// Steps of the grid along the model's largest extent.
constexpr double grid_extent = 65535;
/// A level that keeps more than this share of the triangles is not worth its memory: the one before serves.
constexpr double worthwhile_fraction = 0.8;
/// From this error on clusters of vertices may become one (sloppily: what is near is joined, whether or not an edge
/// joins it), where edges alone keep more than twice as many triangles.
constexpr double min_sloppy_error = 0.015;
constexpr std::size_t min_sloppy_indices = 3 * 64;
/// A cluster's vertices move up to its diagonal, about 1.7 times its side.
constexpr double cluster_fraction = 0.6;

/// Vertices that share place and texture are one here: normals do not keep edges from being collapsed.
struct WeldedPart {
    std::vector<Point> points;
    std::vector<std::uint32_t> welded_of;                 ///< of each vertex of the part
    std::vector<std::vector<std::uint32_t>> vertices_of;  ///< of each welded one, those of the part
};

WeldedPart weld(const StoredPart& part) {
    using Key = std::pair<GridPoint, ExpTexture>;
    WeldedPart welded;
    std::map<Key, std::uint32_t> known;
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
        const GridPoint& p = part.positions[i];
        const Key key{{p[0], p[1], p[2], 0}, part.textures.empty() ? ExpTexture{} : part.textures[i]};
        const auto [at, is_new] = known.try_emplace(key, static_cast<std::uint32_t>(welded.points.size()));
        if (is_new) {
            welded.points.push_back({float(p[0]), float(p[1]), float(p[2])});
            welded.vertices_of.emplace_back();
        }
        welded.welded_of.push_back(at->second);
        welded.vertices_of[at->second].push_back(static_cast<std::uint32_t>(i));
    }
    return welded;
}

Vec3 place_of(const WeldedPart& welded, std::uint32_t vertex) {
    const Point& p = welded.points[vertex];
    return {p[0], p[1], p[2]};
}

/// Back to vertices of the part: each corner takes the one whose normal is nearest to the triangle's.
std::vector<std::uint32_t> dress(const WeldedPart& welded, const StoredPart& part,
                                 const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t> dressed;
    dressed.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const Vec3 a = place_of(welded, triangles[i]);
        const Vec3 face = cross(place_of(welded, triangles[i + 1]) - a, place_of(welded, triangles[i + 2]) - a);
        for (std::size_t k = i; k < i + 3; ++k) {
            const auto along = [&](std::uint32_t vertex) {
                const OctNormal& n = part.normals[vertex];
                return dot(face, Vec3{double(n[0]), double(n[1]), double(n[2])});
            };
            dressed.push_back(std::ranges::max(welded.vertices_of[triangles[k]], {}, along));
        }
    }
    return dressed;
}

/// Collapses edges, or joins clusters where that leaves far fewer triangles. `error` in steps of the grid.
std::vector<std::uint32_t> simplify(const WeldedPart& welded, const std::vector<std::uint32_t>& indices, double error,
                                    double scale, bool may_be_sloppy) {
    const float* points = welded.points[0].data();
    const std::size_t count = welded.points.size();
    const auto relative = static_cast<float>(error / scale);
    std::vector<std::uint32_t> result(indices.size());
    result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), points, count, sizeof(Point), 0,
                                   relative, 0, nullptr));
    if (!may_be_sloppy || result.size() < min_sloppy_indices) return result;
    std::vector<std::uint32_t> sloppy(indices.size());
    sloppy.resize(meshopt_simplifySloppy(sloppy.data(), indices.data(), indices.size(), points, count, sizeof(Point), 0,
                                         static_cast<float>(cluster_fraction) * relative, nullptr));
    return 2 * sloppy.size() < result.size() ? sloppy : result;
}

}  // namespace

std::vector<DetailLevel> detail_levels(const StoredPart& part) {
    const WeldedPart welded = weld(part);
    std::vector<std::uint32_t> indices;
    indices.reserve(part.indices.size());
    for (const std::uint32_t index : part.indices) indices.push_back(welded.welded_of[index]);
    const double scale =
        welded.points.empty()
            ? 0
            : double(meshopt_simplifyScale(welded.points[0].data(), welded.points.size(), sizeof(Point)));

    std::vector<DetailLevel> levels;
    DetailLevel before{.indices = part.indices, .error = 0};
    double reached = 0;
    for (const double fraction : level_errors) {
        const double error = fraction * grid_extent;
        if (scale <= error) {
            before = {.indices = {}, .error = scale};
        } else {
            // Each level is made from the one before, so that their errors add up.
            auto coarser = simplify(welded, indices, error - reached, scale, fraction > min_sloppy_error);
            if (static_cast<double>(coarser.size()) <= worthwhile_fraction * static_cast<double>(indices.size())) {
                indices = std::move(coarser);
                reached = error;
                before = {.indices = dress(welded, part, indices), .error = error};
                meshopt_optimizeVertexCache(before.indices.data(), before.indices.data(), before.indices.size(),
                                            part.positions.size());
            }
        }
        levels.push_back(before);
    }
    return levels;
}

}  // namespace embody::interchange
