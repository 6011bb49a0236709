// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/surface_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace embody::physics::deformable {

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
    constexpr double same_place = 1e-9;  // m: points that are closer have no direction
    // Which side: by the normals of the corners around the point (J. Baerentzen, H. Aanaes, "Signed distance
    // computation using the angle weighted pseudonormal", 2005).
    Vec3 outwards;
    for (std::size_t k = 0; k < 3; ++k) outwards += point.weight[k] * normal_[(*triangle)[k]];
    const Vec3 apart = p - point.at;
    const double distance = length(apart), side = dot(apart, outwards) < 0 ? -1 : 1;
    const Vec3 fallback = length(outwards) > 0 ? outwards / length(outwards) : Vec3{0, 1, 0};
    return Place{*triangle, point.weight, distance > same_place ? (side / distance) * apart : fallback,
                 side * distance};
}

template <class Visit>
void PlacedSurface::visit_crossings(Vec3 p, int axis, Visit&& visit) const {
    const int across = (axis + 1) % 3, up = (axis + 2) % 3;
    // A line through a node or along an edge would be counted twice or not at all: so lines pass p at a tiny distance.
    constexpr double beside = 1e-6;  // of a mean side: rounding leaves 1e-13
    const double aside = beside * deepest_, x = p[across] + 0.755 * aside, y = p[up] + 0.570 * aside;
    const auto side = [&](Vec3 a, Vec3 b) {
        return (b[across] - a[across]) * (y - a[up]) - (b[up] - a[up]) * (x - a[across]);
    };
    Bounds line{p, p};
    for (Vec3* end : {&line.lower, &line.upper}) {
        (*end)[across] = x;
        (*end)[up] = y;
    }
    line.lower[axis] = tree_.bounds().lower[axis];
    line.upper[axis] = tree_.bounds().upper[axis];
    tree_.query(line, [&](std::uint32_t t) {
        const auto& corners = solid_.surface()[t];
        const Vec3 a = at(corners[0]), b = at(corners[1]), c = at(corners[2]);
        const std::array<double, 3> area{side(b, c), side(c, a), side(a, b)};
        const bool is_left = area[0] > 0 && area[1] > 0 && area[2] > 0;
        const bool is_right = area[0] < 0 && area[1] < 0 && area[2] < 0;
        if (!is_left && !is_right) return;
        const double sum = area[0] + area[1] + area[2];
        const std::array<double, 3> weight{area[0] / sum, area[1] / sum, area[2] / sum};
        visit(t, weight, (weight[0] * a + weight[1] * b + weight[2] * c)[axis]);
    });
}

std::optional<PlacedSurface::Place> PlacedSurface::find_exit(Vec3 p, int axis, double sign) const {
    std::optional<Place> last;
    visit_crossings(p, axis, [&](std::uint32_t t, const std::array<double, 3>& weight, double at_axis) {
        const double travel = sign * (at_axis - p[axis]);
        if (!(travel > 0) || (last && -last->distance >= travel)) return;
        last = Place{solid_.surface()[t], weight, {}, -travel};
    });
    if (last) last->normal[axis] = sign;
    return last;
}

// By the number of crossings on both sides of p; where these disagree the surface is torn or turned there.
bool PlacedSurface::encloses(Vec3 p) const {
    std::size_t before = 0, after = 0;
    visit_crossings(
        p, 1, [&](std::uint32_t, const std::array<double, 3>&, double at_axis) { ++(at_axis < p.y ? before : after); });
    return before % 2 == 1 && after % 2 == 1;
}

double PlacedSurface::fraction_within(const PlacedSurface& other, double depth, std::size_t samples) const {
    const std::vector<std::uint32_t>& nodes = solid_.surface_nodes();
    const std::size_t step = (nodes.size() + samples - 1) / samples;
    std::size_t inside = 0, asked = 0;
    for (std::size_t k = 0; k < nodes.size(); k += step) {
        const Vec3 normal = normal_[nodes[k]];
        if (!(length(normal) > 0)) continue;
        ++asked;
        inside += other.encloses(at(nodes[k]) - (depth * deepest_ / length(normal)) * normal) ? 1 : 0;
    }
    return asked > 0 ? static_cast<double>(inside) / static_cast<double>(asked) : 0;
}

ExitDirection min_travel(const Bounds& one, const Bounds& two, bool is_later) {
    ExitDirection best;
    double least = std::numeric_limits<double>::infinity();
    for (const int axis : {1, 0, 2}) {
        const double forth = two.upper[axis] - one.lower[axis];
        const double back = one.upper[axis] - two.lower[axis];
        if (!(std::min(forth, back) < least)) continue;
        least = std::min(forth, back);
        best = {axis, forth < back || (forth == back && is_later) ? 1.0 : -1.0};
    }
    return best;
}

namespace {

double volume(const Bounds& box) {
    const Vec3 size = box.size();
    return box.is_empty() ? 0 : size.x * size.y * size.z;
}

// Where much of one of the two lies within the other, as a scene may begin; or where any does and they are already
// being separated.
std::optional<ExitDirection> find_exit_direction(const NumberedSolid& one, const NumberedSolid& two,
                                                 const PlacedSurface& surface_two, const SurfaceSearch& search) {
    const SolidContactSettings& settings = search.settings;
    const PlacedSurface surface_one(one.solid);
    const double depth = search.is_parting ? settings.parted_depth : settings.parting_depth;
    const double most = std::max(surface_one.fraction_within(surface_two, depth, settings.parting_samples),
                                 surface_two.fraction_within(surface_one, depth, settings.parting_samples));
    if (!(search.is_parting ? most > 0 : most >= settings.parting_fraction)) return std::nullopt;
    return min_travel(one.solid.bounds(), two.solid.bounds(), one.number > two.number);
}

bool may_be_within(const Bounds& one, const Bounds& two, double fraction) {
    const Bounds common{max(one.lower, two.lower), min(one.upper, two.upper)};
    return volume(common) >= fraction * std::min(volume(one), volume(two));
}

}  // namespace

void find_surface_contacts(const NumberedSolid& one, const NumberedSolid& two, const SurfaceSearch& search,
                           std::vector<SolidContact>& contacts) {
    const Bounds near = enlarged(two.solid.bounds(), search.reach + search.radius);
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t node : one.solid.surface_nodes()) {
        if (contains(near, one.solid.nodes().position[node])) nodes.push_back(node);
    }
    if (nodes.empty()) return;
    const PlacedSurface surface(two.solid);
    std::optional<ExitDirection> travel;
    if (search.is_parting || may_be_within(one.solid.bounds(), two.solid.bounds(), search.settings.parting_fraction))
        travel = find_exit_direction(one, two, surface, search);
    for (const std::uint32_t node : nodes) {
        const Vec3 p = one.solid.nodes().position[node];
        auto place = surface.find(p, std::max(search.reach + search.radius, surface.deepest()));
        // Points that are too deep to find where they came from, or that would be pushed deeper.
        if (travel && (!place || travel->sign * place->normal[travel->axis] < 0))
            place = surface.find_exit(p, travel->axis, travel->sign);
        if (!place) continue;
        SolidContact contact;
        contact.normal = place->normal;
        contact.other = {two.number, 3, place->triangle, place->weight};
        contact.point = {one.number, 1, {node}, {1}};
        contact.parts = travel.has_value();
        contact.radius = search.radius;
        contact.friction = search.friction;
        contacts.push_back(contact);
    }
}

}  // namespace embody::physics::deformable
