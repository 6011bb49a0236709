// SPDX-License-Identifier: MIT
// Clipping: I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974, with the edges' names carried along so that
// a corner of the region is known again in the next step.
#include "physics/collision/contact_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace embody::physics {

namespace {

/// A corner of the clipped polygon: the edges that meet there name it.
struct ClipCorner {
    Vec3 position;
    std::uint32_t edge_in = 0, edge_out = 0;
};

constexpr std::uint32_t reference_edge_tag = 0x8000u;

// Keeps the part of a closed polygon (or an open segment) that lies below the plane.
void clip_by_plane(const std::vector<ClipCorner>& from, bool closed, Vec3 normal, double offset, std::uint32_t name,
                   std::vector<ClipCorner>& to) {
    to.clear();
    const std::size_t n = from.size();
    for (std::size_t i = 0; i < n; ++i) {
        const ClipCorner& u = from[i];
        const double height_u = dot(normal, u.position) - offset;
        if (height_u <= 0) to.push_back(u);
        if (!closed && i + 1 == n) break;

        // Where the edge crosses the plane, a new corner between this edge and the plane.
        const ClipCorner& v = from[(i + 1) % n];
        const double height_v = dot(normal, v.position) - offset;
        if ((height_u <= 0) == (height_v <= 0)) continue;
        const Vec3 p = u.position + (v.position - u.position) * (height_u / (height_u - height_v));
        if (height_u <= 0) {
            to.push_back({p, u.edge_out, name});
        } else {
            to.push_back({p, name, u.edge_out});
        }
    }
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

}  // namespace

std::uint32_t feature_name(std::initializer_list<std::uint32_t> parts) {
    std::uint32_t name = 0x811C9DC5u;
    for (const std::uint32_t part : parts) {
        for (int shift = 0; shift < 32; shift += 8) {
            name ^= (part >> shift) & 0xFFu;
            name *= 0x01000193u;
        }
    }
    return name;
}

void clip_to_region(const ContactFeature& reference, const ContactFeature& incident, bool reference_is_a, double lift,
                    double margin, ContactRegion& region) {
    thread_local std::vector<ClipCorner> corners, clipped;
    const std::size_t sides = reference.points.size();
    const bool closed = incident.points.size() > 2;

    // The incident's corners, named by the edges before and after them.
    corners.clear();
    const auto n = static_cast<std::uint32_t>(incident.points.size());
    for (std::uint32_t i = 0; i < n; ++i) corners.push_back({incident.points[i], (i + n - 1) % n, i});

    // By each side of the reference in turn; a tiny slack keeps corners that lie on a side.
    for (std::size_t i = 0; i < sides && !corners.empty(); ++i) {
        const Vec3 p = reference.points[i];
        const Vec3 along = reference.points[(i + 1) % sides] - p;
        const Vec3 outwards = normalized(cross(along, reference.normal));
        const double slack = 1e-9 * (std::fabs(along.x) + std::fabs(along.y) + std::fabs(along.z));
        const auto name = static_cast<std::uint32_t>(i) | reference_edge_tag;
        clip_by_plane(corners, closed, outwards, dot(outwards, p) + slack, name, clipped);
        std::swap(corners, clipped);
    }

    // What is near enough, with its height over the reference's plane.
    for (const ClipCorner& corner : corners) {
        const double separation = dot(corner.position - reference.points[0], reference.normal) - lift;
        if (separation > margin) continue;
        const std::uint32_t name =
            feature_name({reference_is_a ? 1u : 2u, reference.id, incident.id, corner.edge_in << 16 | corner.edge_out});
        const Vec3 on_reference = corner.position - reference.normal * (separation + lift);
        const Vec3 on_a = reference_is_a ? on_reference : on_reference - region.normal * separation;
        region.add(on_a, separation, name);
    }
}

void add_near_corners(const ContactFeature& reference, const PlacedConvex& incident, bool reference_is_a, double margin,
                      ContactRegion& region) {
    constexpr std::size_t corners_of_a_box = 8;
    const std::vector<Vec3>& vertices = incident.shape->polytope.vertices;
    if (vertices.size() <= corners_of_a_box) return;
    const std::size_t sides = reference.points.size();
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        const Vec3 corner = incident.to_frame(vertices[i]);
        const double separation = dot(corner - reference.points[0], reference.normal);
        if (separation > margin) continue;

        // Over the reference: on the inner side of each of its sides.
        bool is_over = true;
        for (std::size_t k = 0; k < sides && is_over; ++k) {
            const Vec3 p = reference.points[k];
            const Vec3 along = reference.points[(k + 1) % sides] - p;
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

void reduce_to_four(ContactRegion& region) {
    auto& points = region.points;
    if (points.size() < 2) return;
    const Vec3 normal = region.normal;
    std::size_t kept = 0;
    // Moves the best of the points not yet kept behind those kept, unless its score is below `least`.
    const auto keep_best = [&](double least, auto&& score) {
        std::size_t best = points.size();
        double highest = least;
        for (std::size_t i = kept; i < points.size(); ++i) {
            const double value = score(points[i]);
            // Ties by a hair go to the earlier point, so that rounding does not choose.
            if (!(value > highest + (best == points.size() ? 0 : 1e-9 * std::fabs(highest)))) continue;
            highest = value;
            best = i;
        }
        if (best == points.size()) return false;
        const auto at = [&points](std::size_t i) { return points.begin() + static_cast<std::ptrdiff_t>(i); };
        std::rotate(at(kept), at(best), at(best + 1));
        ++kept;
        return true;
    };

    // The outermost of the deepest (within a small part of the size).
    Vec3 middle;
    double lowest = std::numeric_limits<double>::infinity(), size = 0;
    for (const ManifoldPoint& p : points) {
        middle += p.position / static_cast<double>(points.size());
        lowest = std::min(lowest, p.separation);
    }
    for (const ManifoldPoint& p : points) size = std::max(size, distance(p.position, middle));
    keep_best(-1, [&](const ManifoldPoint& p) {
        return p.separation <= lowest + 1e-4 * size ? distance(p.position, middle) : -2.0;
    });

    // The farthest from it, the farthest from their line, the farthest beyond the triangle; what adds no area is
    // dropped. Depth counts before area: of two points side by side the lower one carries, and a hull of many vertices
    // has higher ones a little farther out everywhere. `slope`: metres of extent given up for a metre of depth.
    constexpr double slope = 10;
    constexpr double unfit = -std::numeric_limits<double>::infinity();
    const auto lift = [&](const ManifoldPoint& p) { return slope * (p.separation - lowest); };
    const double no_length = std::max(1e-6 * size, 1e-9);
    const auto reach = [&](double length, const ManifoldPoint& p) {
        return length > no_length ? length - lift(p) : unfit;
    };
    // Distance of p from the line, positive on the left seen against the normal.
    const auto beside = [&](Vec3 from, Vec3 to, Vec3 p) {
        return dot(normal, cross(to - from, p - from)) / distance(from, to);
    };
    const Vec3 first = points[0].position;
    if (keep_best(unfit, [&](const ManifoldPoint& p) { return reach(distance(p.position, first), p); })) {
        const Vec3 second = points[1].position;
        const auto from_line = [&](const ManifoldPoint& p) { return std::fabs(beside(first, second, p.position)); };
        if (keep_best(unfit, [&](const ManifoldPoint& p) { return reach(from_line(p), p); })) {
            const Vec3 third = points[2].position;
            const double turn = beside(first, second, third) < 0 ? -1.0 : 1.0;
            keep_best(unfit, [&](const ManifoldPoint& p) {
                const double outside =
                    std::max({-turn * beside(first, second, p.position), -turn * beside(second, third, p.position),
                              -turn * beside(third, first, p.position)});
                return reach(outside, p);
            });
        }
    }
    points.resize(kept);
}

void append_manifold(ContactRegion& region, Vec3 origin, std::vector<Manifold>& manifolds) {
    if (region.points.empty()) return;
    reduce_to_four(region);
    Manifold manifold;
    manifold.normal = region.normal;
    for (const ManifoldPoint& point : region.points) {
        manifold.points[static_cast<std::size_t>(manifold.count)] = point;
        manifold.points[static_cast<std::size_t>(manifold.count)].position += origin;
        ++manifold.count;
    }
    manifolds.push_back(manifold);
}

}  // namespace embody::physics
