// SPDX-License-Identifier: MIT
// Polygons are cut one by one (I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974); the face on the plane
// is sorted by angle about its middle.
#include "physics/fracture/convex_cell.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/convex_hull.h"
#include "geometry/mean_point.h"

namespace embody::physics::fracture {

namespace {

bool is_before(Vec3 a, Vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// Where the edge meets the plane: the same bits from both of its ends.
Vec3 meeting_point(Vec3 a, Vec3 b, double depth_a, double depth_b) {
    if (is_before(b, a)) {
        std::swap(a, b);
        std::swap(depth_a, depth_b);
    }
    return a + (b - a) * (depth_a / (depth_a - depth_b));
}

void add_once(std::vector<Vec3>& points, Vec3 point) {
    if (std::ranges::find(points, point) == points.end()) points.push_back(point);
}

// The face of the cut: its corners are known, but not their order.
std::vector<Vec3> in_order(std::vector<Vec3> corners, Vec3 normal) {
    const Vec3 middle = geometry::mean_point(corners);
    const Vec3 along = any_perpendicular(normal), across = cross(normal, along);
    const auto angle = [&](Vec3 corner) {
        return std::atan2(dot(corner - middle, across), dot(corner - middle, along));
    };
    std::ranges::sort(corners, [&](Vec3 a, Vec3 b) {
        const double angle_a = angle(a), angle_b = angle(b);
        return angle_a != angle_b ? angle_a < angle_b : is_before(a, b);
    });
    return corners;
}

}  // namespace

void ConvexCell::cut(const HalfSpace& half, double tolerance) {
    // Above the plane; 0 on it.
    const auto height = [&](Vec3 corner) {
        const double above = dot(half.normal, corner) - half.offset;
        return std::fabs(above) <= tolerance ? 0.0 : above;
    };
    bool any_above = false, any_below = false;
    for (const Face& face : faces_) {
        for (const Vec3 corner : face.corners) {
            any_above = any_above || height(corner) > 0;
            any_below = any_below || height(corner) < 0;
        }
    }
    if (!any_above) return;
    if (!any_below) {
        faces_.clear();
        return;
    }
    std::vector<Face> kept;
    std::vector<Vec3> rim;
    for (const Face& face : faces_) {
        Face inside{{}, face.is_cut};
        for (std::size_t i = 0; i < face.corners.size(); ++i) {
            const Vec3 from = face.corners[i], to = face.corners[(i + 1) % face.corners.size()];
            const double above_from = height(from), above_to = height(to);
            if (above_from <= 0) add_once(inside.corners, from);
            if (above_from == 0) add_once(rim, from);
            if ((above_from < 0 && above_to > 0) || (above_from > 0 && above_to < 0)) {
                const Vec3 point = meeting_point(from, to, above_from, above_to);
                add_once(inside.corners, point);
                add_once(rim, point);
            }
        }
        // A face whose corners all lie on the plane is the one of the cut itself.
        const bool is_below = std::ranges::any_of(face.corners, [&](Vec3 corner) { return height(corner) < 0; });
        if (is_below && inside.corners.size() >= 3) kept.push_back(std::move(inside));
    }
    if (rim.size() >= 3) kept.push_back({in_order(std::move(rim), half.normal), true});
    faces_ = std::move(kept);
}

std::vector<Vec3> ConvexCell::corners() const {
    std::vector<Vec3> points;
    for (const Face& face : faces_)
        for (const Vec3 corner : face.corners) add_once(points, corner);
    return points;
}

Bounds ConvexCell::bounds() const {
    Bounds box;
    for (const Face& face : faces_)
        for (const Vec3 corner : face.corners) box.add(corner);
    return box;
}

geometry::MassProperties ConvexCell::mass_properties() const {
    if (is_empty()) return {};
    geometry::PolyhedronIntegral integral(geometry::mean_point(corners()));
    for (const Face& face : faces_)
        for (std::size_t i = 2; i < face.corners.size(); ++i)
            integral.add_triangle(face.corners[0], face.corners[i - 1], face.corners[i]);
    return integral.mass_properties();
}

double ConvexCell::cut_area() const {
    double area = 0;
    for (const Face& face : faces_) {
        if (!face.is_cut) continue;
        Vec3 sum;
        for (std::size_t i = 2; i < face.corners.size(); ++i)
            sum += cross(face.corners[i - 1] - face.corners[0], face.corners[i] - face.corners[0]);
        area += length(sum) / 2;
    }
    return area;
}

}  // namespace embody::physics::fracture
