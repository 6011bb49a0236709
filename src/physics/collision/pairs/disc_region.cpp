// SPDX-License-Identifier: MIT
#include "physics/collision/pairs/disc_region.h"

#include <array>
#include <cmath>

namespace embody::physics::collision {

namespace {

// A disc tilted by more than 1.8 degrees is too narrow an ellipse in the other's plane to count as a disc.
constexpr double square_cosine = 0.9995;

// A unit vector square to `normal`, along `wanted` or, where that has no length, any.
Vec3 in_plane(Vec3 wanted, Vec3 normal) {
    return normalized(wanted - normal * dot(wanted, normal), any_perpendicular(normal));
}

// Four points of a rim, quarter by quarter from its first corner.
std::array<Vec3, 4> quarters(const ContactFeature& cap, Vec3 normal, Vec3 center) {
    const Vec3 u = in_plane(cap.points[0] - cap.center, normal), v = cross(normal, u);
    return {center + u * cap.radius, center + v * cap.radius, center - u * cap.radius, center - v * cap.radius};
}

/// A disc lying on a polygon while the common part is gathered: its corners one after another, in the polygon's plane.
struct DiscOnPolygon {
    const ContactFeature& polygon;
    const ContactFeature& disc;
    bool polygon_is_a;
    double margin;
    ContactRegion& region;

    // Adds a point with the height of the disc's plane over it.
    void add(Vec3 point, std::uint32_t part) const {
        const double separation = dot(disc.center - point, disc.normal) / dot(polygon.normal, disc.normal);
        if (separation > margin) return;
        const std::uint32_t name = feature_name({polygon_is_a ? 8u : 9u, polygon.id, disc.id, part});
        region.add(polygon_is_a ? point : point - region.normal * separation, separation, name);
    }
};

// Adds the polygon's corners inside the rim, the points where its sides cross the rim, and four points of the rim
// itself, quarter by quarter: from its first corner, or, where the centre is beyond a side, from the point farthest
// inside.
void add_disc_on_polygon(const DiscOnPolygon& d) {
    constexpr std::uint32_t crossings = 0x100, rim = 0x1000;
    const Vec3 n = d.polygon.normal, center = d.disc.center - n * dot(d.disc.center - d.polygon.points[0], n);
    const double r = d.disc.radius;
    const std::vector<Vec3>& corners = d.polygon.points;
    const auto count = static_cast<std::uint32_t>(corners.size());
    const auto side_at = [&](std::uint32_t i) { return corners[i + 1 == count ? 0 : i + 1] - corners[i]; };
    double max_beyond = 0;
    Vec3 start = d.disc.points[0] - d.disc.center;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 displacement = corners[i] - center, along = side_at(i), outwards = cross(along, n);
        const double side = length(along);
        if (!(side > 0)) continue;
        if (length_squared(displacement) <= r * r) d.add(corners[i], i);
        const double beyond = -dot(displacement, outwards) / side, nearest = -dot(displacement, along) / side;
        if (beyond > max_beyond) {
            max_beyond = beyond;
            start = -outwards;
        }
        if (std::fabs(beyond) >= r) continue;
        const double half = std::sqrt(r * r - beyond * beyond);
        if (nearest - half > 0 && nearest - half < side)
            d.add(corners[i] + along * ((nearest - half) / side), crossings + 2 * i);
        if (nearest + half > 0 && nearest + half < side)
            d.add(corners[i] + along * ((nearest + half) / side), crossings + 2 * i + 1);
    }
    const Vec3 u = in_plane(start, n) * r, v = cross(n, u);
    const std::array<Vec3, 4> points{center + u, center + v, center - u, center - v};
    for (std::uint32_t k = 0; k < 4; ++k) {
        bool is_over = true;
        for (std::uint32_t i = 0; i < count && is_over; ++i)
            is_over = dot(points[k] - corners[i], cross(side_at(i), n)) <= 0;
        if (is_over) d.add(points[k], rim + k);
    }
}

}  // namespace

bool add_disc_region(const ContactFeature& reference, const ContactFeature& incident, bool reference_is_a,
                     double margin, ContactRegion& region) {
    const Vec3 n = reference.normal;
    const double facing = dot(n, incident.normal);
    if (incident.radius <= 0 || facing > -square_cosine) return false;
    if (reference.radius <= 0) {
        add_disc_on_polygon({reference, incident, reference_is_a, margin, region});
        return true;
    }

    // In the reference's plane: one inside the other, or a lens with two corners and two bulges.
    const Vec3 other = incident.center - n * dot(incident.center - reference.center, n);
    const Vec3 displacement = other - reference.center;
    const double apart = length(displacement), r = reference.radius, q = incident.radius;
    if (apart >= r + q) return false;
    std::array<Vec3, 4> points;
    std::uint32_t part = 0;
    if (apart + q <= r) {
        points = quarters(incident, n, other);
    } else if (apart + r <= q) {
        points = quarters(reference, n, reference.center);
        part = 4;
    } else {
        const Vec3 u = displacement / apart, v = cross(n, u);
        const double along = (apart * apart + r * r - q * q) / (2 * apart);
        const double aside = std::sqrt(std::fmax(0.0, r * r - along * along));
        points = {reference.center + u * r, reference.center + u * along + v * aside, other - u * q,
                  reference.center + u * along - v * aside};
        part = 8;
    }

    // Each point gets the height of the incident's plane over it.
    for (const Vec3& p : points) {
        const double separation = dot(incident.center - p, incident.normal) / facing;
        const std::uint32_t name = feature_name({reference_is_a ? 6u : 7u, reference.id, incident.id, part++});
        if (separation > margin) continue;
        region.add(reference_is_a ? p : p - region.normal * separation, separation, name);
    }
    return true;
}

void thin_out_cap(const ContactFeature& reference, ContactFeature& cap) {
    if (cap.radius <= 0 || cap.points.size() % 4 != 0) return;
    const std::size_t sides = reference.points.size();
    for (std::size_t i = 0; i < sides; ++i) {
        const Vec3 p = reference.points[i], along = reference.points[i + 1 == sides ? 0 : i + 1] - p;
        const Vec3 outwards = cross(along, reference.normal);
        if (dot(outwards, cap.center - p) > -cap.radius * length(outwards)) return;
    }
    const std::size_t quarter = cap.points.size() / 4;
    for (std::size_t i = 1; i < 4; ++i) cap.points[i] = cap.points[i * quarter];
    cap.points.resize(4);
}

}  // namespace embody::physics::collision
