// SPDX-License-Identifier: MIT
#include "scene/matter/deformable_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/tetrahedra/tetrahedral_mesh.h"

namespace embody::scene {

using physics::DeformableDefinition;

namespace {

std::vector<std::array<std::uint32_t, 3>> outer_faces(const DeformableDefinition& definition) {
    if (const auto* cloth = std::get_if<physics::Cloth>(&definition.matter)) return cloth->triangles;
    std::vector<std::array<std::uint32_t, 3>> faces;
    if (const auto* solid = std::get_if<physics::SoftSolid>(&definition.matter)) {
        for (const auto& face : geometry::find_tetrahedral_topology(solid->tetrahedra).outer_faces)
            faces.push_back(face.corners);
    }
    return faces;
}

// Nodes of the faces, ascending; all nodes for a rope.
std::vector<std::uint32_t> nodes_of(const std::vector<std::array<std::uint32_t, 3>>& faces, std::size_t count) {
    std::vector<std::uint32_t> nodes;
    if (faces.empty()) {
        nodes.resize(count);
        std::iota(nodes.begin(), nodes.end(), 0u);
    }
    for (const auto& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

}  // namespace

DeformableSurface::DeformableSurface(const DeformableDefinition& definition)
    : faces_(outer_faces(definition)),
      nodes_(nodes_of(faces_, definition.nodes.size())),
      has_two_sides_(std::holds_alternative<physics::Cloth>(definition.matter)) {}

// Intersects the ray with one ball on each segment, where the ray is closest to it.
std::optional<SurfaceHit> meet_rope(std::span<const Vec3> positions, double radius,
                                    std::span<const std::uint32_t> broken, const Ray& ray) {
    const auto& [origin, direction, max_distance] = ray;
    std::optional<SurfaceHit> nearest;
    for (std::uint32_t s = 0; s + 1 < positions.size(); ++s) {
        if (std::ranges::binary_search(broken, s)) continue;
        const Vec3 from = positions[s], edge = positions[s + 1] - from, to = origin - from;
        const double along = dot(edge, direction), square = length_squared(edge);
        const double across = square - along * along;
        double part = across > 0 ? (dot(to, edge) - along * dot(to, direction)) / across : 0;
        part = std::clamp(part, 0.0, 1.0);
        const Vec3 center = from + part * edge;
        const double ahead = dot(center - origin, direction);
        const double beside = length_squared(center - origin) - ahead * ahead;
        if (beside > radius * radius) continue;
        const double distance = ahead - std::sqrt(radius * radius - beside);
        if (distance < 0 || distance > max_distance || (nearest && distance >= nearest->distance)) continue;
        nearest = SurfaceHit{distance, normalized(origin + distance * direction - center, -direction)};
    }
    return nearest;
}

// T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, for each face: a solid's only from
// outside, those of cloth from both sides.
std::optional<SurfaceHit> DeformableSurface::meet(std::span<const Vec3> positions, const Ray& ray) const {
    const auto& [origin, direction, max_distance] = ray;
    std::optional<SurfaceHit> nearest;
    for (const auto& face : faces_) {
        const Vec3 a = positions[face[0]];
        Vec3 along = positions[face[1]] - a, across = positions[face[2]] - a;
        if (has_two_sides_ && dot(direction, cross(along, across)) > 0) std::swap(along, across);
        const Vec3 p = cross(direction, across);
        const double facing = dot(along, p);
        if (!(facing > 0)) continue;
        const Vec3 from = origin - a, q = cross(from, along);
        const double u = dot(from, p), v = dot(direction, q);
        if (u < 0 || v < 0 || u + v > facing) continue;
        const double distance = dot(across, q) / facing;
        if (distance < 0 || distance > max_distance || (nearest && distance >= nearest->distance)) continue;
        nearest = SurfaceHit{distance, normalized(cross(along, across))};
    }
    return nearest;
}

}  // namespace embody::scene
