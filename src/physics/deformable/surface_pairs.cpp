// SPDX-License-Identifier: MIT
#include "physics/deformable/surface_pairs.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

/// The point of a triangle that is nearest to another, by its corners' weights.
struct NearestPoint {
    Vec3 at;
    std::array<double, 3> weight{};
};

// C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5: by the regions of corners, edges and face.
NearestPoint nearest_point(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    const auto made = [&](double v, double w) { return NearestPoint{a + v * ab + w * ac, {1 - v - w, v, w}}; };
    if (d1 <= 0 && d2 <= 0) return made(0, 0);
    if (d3 >= 0 && d4 <= d3) return made(1, 0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return made(d1 / (d1 - d3), 0);
    if (d6 >= 0 && d5 <= d6) return made(0, 1);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return made(0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return made(1 - w, w);
    }
    const double whole = va + vb + vc;
    return made(vb / whole, vc / whole);
}

}  // namespace

PlacedSurface::PlacedSurface(const SolidDeformable& solid) : solid_(solid), normal_(solid.nodes().size()) {
    std::vector<Bounds> boxes;
    double sides = 0;
    for (const auto& corners : solid.surface()) {
        Bounds box;
        for (const std::uint32_t node : corners) box.add(at(node));
        boxes.push_back(box);
        // Area-weighted.
        const Vec3 normal = cross(at(corners[1]) - at(corners[0]), at(corners[2]) - at(corners[0]));
        for (const std::uint32_t node : corners) normal_[node] += normal;
        sides += std::sqrt(length(normal));
    }
    tree_ = geometry::BoundingVolumeTree(boxes);
    deepest_ = sides / static_cast<double>(boxes.size());
}

std::optional<PlacedSurface::Place> PlacedSurface::find(Vec3 p, double reach) const {
    double nearest = reach * reach;
    const std::array<std::uint32_t, 3>* triangle = nullptr;
    NearestPoint point;
    tree_.query(enlarged(Bounds{p, p}, reach), [&](std::uint32_t t) {
        const auto& corners = solid_.surface()[t];
        const NearestPoint candidate = nearest_point(p, at(corners[0]), at(corners[1]), at(corners[2]));
        const double distance = length_squared(p - candidate.at);
        if (!(distance < nearest)) return;
        nearest = distance;
        triangle = &corners;
        point = candidate;
    });
    if (triangle == nullptr) return std::nullopt;
    // Which side: by the normals of the corners around the point (J. Baerentzen, H. Aanaes, "Signed distance
    // computation using the angle weighted pseudonormal", 2005).
    Vec3 outwards;
    for (std::size_t k = 0; k < 3; ++k) outwards += point.weight[k] * normal_[(*triangle)[k]];
    const Vec3 apart = p - point.at;
    const double distance = length(apart), side = dot(apart, outwards) < 0 ? -1 : 1;
    const Vec3 fallback = length(outwards) > 0 ? outwards / length(outwards) : Vec3{0, 1, 0};
    return Place{*triangle, point.weight, distance > 1e-9 ? (side / distance) * apart : fallback, side * distance};
}

void find_surface_contacts(const SolidDeformable& one, std::uint32_t one_number, const SolidDeformable& two,
                           std::uint32_t two_number, double reach, double radius, double friction,
                           std::vector<SolidContact>& contacts) {
    const Bounds near = enlarged(two.bounds(), reach + radius);
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t node : one.surface_nodes()) {
        if (contains(near, one.nodes().position[node])) nodes.push_back(node);
    }
    if (nodes.empty()) return;
    const PlacedSurface surface(two);
    for (const std::uint32_t node : nodes) {
        const auto place = surface.find(one.nodes().position[node], std::max(reach + radius, surface.deepest()));
        if (!place) continue;
        SolidContact contact;
        contact.normal = place->normal;
        contact.other = {two_number, 3, place->triangle, place->weight};
        contact.point = {one_number, 1, {node}, {1}};
        contact.radius = radius;
        contact.friction = friction;
        contacts.push_back(contact);
    }
}

}  // namespace embody::physics
