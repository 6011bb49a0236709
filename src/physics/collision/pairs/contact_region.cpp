// SPDX-License-Identifier: MIT
// Clipping: I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974. The edges' names are carried along so that
// the next step recognises a corner of the region.
#include "physics/collision/pairs/contact_region.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace embody::physics::collision {

namespace {

constexpr std::uint32_t reference_edge_tag = 0x8000u;
// Of polygons with more corners, high corners are removed first.
constexpr std::uint32_t few_corners = 8;

/// Two axes of the reference's plane, and its origin there.
struct ReferencePlane {
    Vec3 origin, normal, across, up;

    explicit ReferencePlane(const ContactFeature& reference)
        : origin(reference.points[0]), normal(reference.normal), across(any_perpendicular(normal)) {
        up = cross(normal, across);
    }
    [[nodiscard]] double height(Vec3 p) const { return dot(p - origin, normal); }
    [[nodiscard]] ClipCorner flatten(Vec3 p, std::uint32_t edge_in, std::uint32_t edge_out) const {
        const Vec3 d = p - origin;
        return {dot(d, across), dot(d, up), dot(d, normal), edge_in, edge_out};
    }
};

/// A side of the reference: points beyond it are cut off. Heights over it are in units of its length.
struct Side {
    double x, y, along_x, along_y, slack;

    Side(const ClipCorner& from, const ClipCorner& to)
        : x(from.x), y(from.y), along_x(to.x - from.x), along_y(to.y - from.y) {
        // A tiny slack keeps corners that lie on a side.
        slack = 1e-9 * (along_x * along_x + along_y * along_y);
    }
    [[nodiscard]] double beyond(const ClipCorner& c) const { return along_y * (c.x - x) - along_x * (c.y - y) - slack; }
};

// Keeps the part of a closed polygon (or an open segment) that lies on the inner side; false where all of it does.
bool clip_by_side(const std::vector<ClipCorner>& from, bool closed, const Side& side, std::uint32_t name,
                  std::vector<ClipCorner>& to) {
    double farthest_out = -1e300;
    for (const ClipCorner& c : from) farthest_out = std::max(farthest_out, side.beyond(c));
    if (farthest_out <= 0) return false;

    to.clear();
    const std::size_t n = from.size();
    double out_u = side.beyond(from[0]);
    for (std::size_t i = 0; i < n; ++i) {
        const ClipCorner& u = from[i];
        if (out_u <= 0) to.push_back(u);
        if (!closed && i + 1 == n) break;

        // Where the edge crosses the side, a new corner between this edge and the side.
        const ClipCorner& v = from[i + 1 == n ? 0 : i + 1];
        const double out_v = side.beyond(v);
        if ((out_u <= 0) != (out_v <= 0)) {
            const double t = out_u / (out_u - out_v);
            to.push_back({u.x + (v.x - u.x) * t, u.y + (v.y - u.y) * t, u.height + (v.height - u.height) * t,
                          out_u <= 0 ? u.edge_out : name, out_u <= 0 ? name : u.edge_out});
        }
        out_u = out_v;
    }
    return true;
}

/// Parameters of the nearest points of the lines p + s u and q + t v; false where they are parallel.
bool nearest_on_lines(Vec3 p, Vec3 u, Vec3 q, Vec3 v, double& s, double& t) {
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const double det = uu * vv - uv * uv;
    // sin² of the angle between them.
    if (!(det > 1e-4 * uu * vv)) return false;
    const Vec3 w = p - q;
    const double du = dot(u, w), dv = dot(v, w);
    s = (uv * dv - vv * du) / det;
    t = (uu * dv - uv * du) / det;
    return true;
}

// Whether a point lies at the place of one of the others, up to rounding.
bool is_known(const ManifoldPoint& point, std::span<const ManifoldPoint> others) {
    constexpr double same_place = 1e-9;  // m
    return std::any_of(others.begin(), others.end(), [&](const ManifoldPoint& other) {
        return length_squared(other.position - point.position) < same_place * same_place;
    });
}

}  // namespace

std::uint32_t feature_name(std::initializer_list<std::uint32_t> parts) {
    std::uint32_t name = 0x811C9DC5u;
    for (const std::uint32_t part : parts) {
        name = (name ^ part) * 0x9E3779B1u;
        name ^= name >> 15;
    }
    return name;
}

void clip_to_region(const ContactFeature& reference, const ContactFeature& incident, bool reference_is_a, double lift,
                    double margin, ContactRegion& region) {
    const ReferencePlane plane(reference);
    const bool closed = incident.points.size() > 2;

    // The incident's corners, named by the edges before and after them.
    auto &corners = region.corners, &sides = region.sides;
    corners.clear();
    sides.clear();
    const auto n = static_cast<std::uint32_t>(incident.points.size());
    const auto is_low = [&](std::uint32_t i) { return plane.height(incident.points[i]) <= lift + margin; };
    bool was_low = is_low(n - 1), now_low = is_low(0);
    for (std::uint32_t i = 0; i < n; ++i) {
        // Most of a tilted rim is too high to count: between two high corners next to high ones, all is high.
        const bool next_low = i + 1 < n ? is_low(i + 1) : is_low(0);
        if (n <= few_corners || was_low || now_low || next_low)
            corners.push_back(plane.flatten(incident.points[i], (i + n - 1) % n, i));
        was_low = now_low;
        now_low = next_low;
    }
    for (const Vec3& p : reference.points) sides.push_back(plane.flatten(p, 0, 0));

    // By each side of the reference in turn.
    for (std::size_t i = 0; i < sides.size() && !corners.empty(); ++i) {
        const Side side(sides[i], sides[i + 1 == sides.size() ? 0 : i + 1]);
        const auto name = static_cast<std::uint32_t>(i) | reference_edge_tag;
        if (clip_by_side(corners, closed, side, name, region.clipped)) std::swap(corners, region.clipped);
    }

    // Points within the margin, with their height over the reference's plane.
    const std::size_t known = region.points.size();
    for (const ClipCorner& corner : corners) {
        const double separation = corner.height - lift;
        if (separation > margin) continue;
        const std::uint32_t name =
            feature_name({reference_is_a ? 1u : 2u, reference.id, incident.id, corner.edge_in << 16 | corner.edge_out});
        const Vec3 on_reference = plane.origin + plane.across * corner.x + plane.up * corner.y;
        const Vec3 on_a = reference_is_a ? on_reference : on_reference - region.normal * separation;
        region.add(on_a, separation, name);
        if (is_known(region.points.back(), std::span(region.points).first(known))) region.points.pop_back();
    }
}

void add_near_corners(const ContactFeature& reference, const PlacedConvex& incident, bool reference_is_a, double margin,
                      ContactRegion& region) {
    constexpr std::size_t corners_of_a_box = 8;  // what has no more is no rounded thing
    const std::vector<Vec3>& vertices = incident.shape->polytope.vertices;
    if (vertices.size() <= corners_of_a_box) return;
    const std::size_t sides = reference.points.size();
    const Vec3 normal = incident.direction_to_local(reference.normal);
    const double low = dot(reference.points[0] - incident.position, reference.normal);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const double separation = dot(vertices[i], normal) - low;
        if (separation > margin) continue;

        // Over the reference: on the inner side of each of its sides.
        const Vec3 corner = incident.to_frame(vertices[i]);
        bool is_over = true;
        for (std::size_t k = 0; k < sides && is_over; ++k) {
            const Vec3 p = reference.points[k];
            const Vec3 along = reference.points[k + 1 == sides ? 0 : k + 1] - p;
            is_over = dot(cross(along, reference.normal), corner - p) <= 0;
        }
        if (!is_over) continue;
        const Vec3 on_a = reference_is_a ? corner - reference.normal * separation : corner;
        region.add(on_a, separation, feature_name({reference_is_a ? 4u : 5u, reference.id, i}));
    }
}

void keep_deepest(Vec3 on_a, double separation, double tolerance, ContactRegion& region) {
    for (const ManifoldPoint& point : region.points) {
        if (point.separation <= separation + tolerance) return;
    }
    region.add(on_a, separation, 2);
}

void cross_segments(const ContactFeature& a, const ContactFeature& b, double radius_a, double radius_b, double margin,
                    ContactRegion& region) {
    const Vec3 p = a.points[0], q = b.points[0];
    const Vec3 u = a.points[1] - p, v = b.points[1] - q;
    const auto add = [&](Vec3 on_a, Vec3 on_b, std::uint32_t part) {
        const double separation = dot(region.normal, on_b - on_a) - radius_a - radius_b;
        if (separation > margin) return;
        region.add(on_a + region.normal * radius_a, separation, feature_name({3u, a.id, b.id, part}));
    };

    // Crossing edges meet in one point.
    double s = 0, t = 0;
    if (nearest_on_lines(p, u, q, v, s, t)) {
        add(p + u * std::clamp(s, 0.0, 1.0), q + v * std::clamp(t, 0.0, 1.0), 0);
        return;
    }

    // Parallel ones along their common part: its two ends, seen from a.
    const double uu = dot(u, u);
    double s0 = dot(q - p, u) / uu, s1 = dot(q + v - p, u) / uu;
    const double span = s1 - s0;
    const double low = std::clamp(std::min(s0, s1), 0.0, 1.0), high = std::clamp(std::max(s0, s1), 0.0, 1.0);
    const auto on_b = [&](double at) {
        return q + v * (std::fabs(span) > 1e-12 ? std::clamp((at - s0) / span, 0.0, 1.0) : 0.5);
    };
    add(p + u * low, on_b(low), 1);
    if (high - low > 1e-6) add(p + u * high, on_b(high), 2);
}

namespace {

// Points that were not chosen may lie lower than the chosen ones predict by this, m: a body is not affected by less.
constexpr double unseen = 2e-5;

// Moves the four chosen points to a manifold.
void append_chosen(ContactRegion& region, const Mat3& turn, Vec3 origin, std::uint32_t part, const ChosenPoints& chosen,
                   std::vector<Manifold>& manifolds) {
    Manifold& manifold = manifolds.emplace_back();
    manifold.normal = turn * region.normal;
    manifold.part = part;
    manifold.count = chosen.count;
    for (std::size_t k = 0; k < static_cast<std::size_t>(chosen.count); ++k) {
        manifold.points[k] = region.points[static_cast<std::size_t>(chosen.index[k])];
        manifold.points[k].position = origin + turn * manifold.points[k].position;
    }
}

void flatten(ContactRegion& region) {
    const Vec3 across = any_perpendicular(region.normal), up = cross(region.normal, across);
    region.flat.clear();
    for (const ManifoldPoint& p : region.points) {
        region.flat.push_back({dot(p.position, across), dot(p.position, up), p.separation});
    }
}

// The points that were not chosen, in their order.
void drop_chosen(ContactRegion& region, const ChosenPoints& chosen) {
    int next = 0;
    for (int i = 0; i < static_cast<int>(region.points.size()); ++i) {
        if (!chosen.holds(i))
            region.points[static_cast<std::size_t>(next++)] = region.points[static_cast<std::size_t>(i)];
    }
    region.points.resize(static_cast<std::size_t>(next));
}

}  // namespace

void append_manifolds(ContactRegion& region, const Mat3& turn, Vec3 origin, std::vector<Manifold>& manifolds) {
    constexpr std::uint32_t max_parts = 2;  // manifolds of one region, four points each
    const std::size_t first = manifolds.size();
    if (region.is_proper) {
        const auto count = static_cast<int>(region.points.size());
        append_chosen(region, turn, origin, 0, {count, {0, 1, 2, 3}}, manifolds);
        manifolds.back().is_whole = true;
        region.is_proper = false;
        return;
    }
    for (std::uint32_t part = 0; part < max_parts && !region.points.empty(); ++part) {
        flatten(region);
        const auto count = static_cast<int>(region.flat.size());
        const ChosenPoints chosen = choose_four(region.flat.data(), count);
        append_chosen(region, turn, origin, part, chosen, manifolds);
        if (!leaves_unseen(region.flat.data(), count, chosen, unseen)) {
            // All points, or all that matter.
            const bool is_whole = chosen.count == count;
            for (std::size_t i = first; i < manifolds.size(); ++i) manifolds[i].is_whole = is_whole;
            return;
        }
        drop_chosen(region, chosen);
    }
}

}  // namespace embody::physics::collision
