// SPDX-License-Identifier: MIT
//
// Separating axes, exact for polytopes: Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996. Written for clarity, not
// for speed, because it runs once per race.
#include "benches/race/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace embody::race {
namespace {

constexpr double huge = std::numeric_limits<double>::max();

/// A body with its polytope in world coordinates.
struct Placed {
    const RaceShape* shape = nullptr;
    BodyState state;
    std::vector<Vec3> corners;
    bool escaped = false;
};

/// Interval of the vertices' projections on an axis.
struct Extent {
    double low = huge, high = -huge;
};
Extent extent_along(Vec3 axis, const std::vector<Vec3>& corners) {
    Extent extent;
    for (const Vec3 corner : corners) {
        const double along = dot(axis, corner);
        extent.low = std::min(extent.low, along);
        extent.high = std::max(extent.high, along);
    }
    return extent;
}

/// The smallest overlap of two polytopes over all candidate axes; <= 0 where one separates them.
double overlap_of_polytopes(const Placed& a, const Placed& b) {
    double least = huge;
    const auto overlaps_along = [&](Vec3 axis) {
        const Extent on_a = extent_along(axis, a.corners), on_b = extent_along(axis, b.corners);
        least = std::min({least, on_a.high - on_b.low, on_b.high - on_a.low});
        return least > 0;
    };

    // The direction between the centres is no face normal, but it separates most separated pairs early.
    const Vec3 between = b.state.position - a.state.position;
    if (length(between) > 1e-9 && !overlaps_along(normalized(between))) return least;
    for (const Placed* side : {&a, &b})
        for (const Vec3 normal : side->shape->face_normals)
            if (!overlaps_along(rotate(side->state.rotation, normal))) return least;

    // Cross products of edge directions.
    for (const Vec3 edge_a : a.shape->edge_directions) {
        const Vec3 along_a = rotate(a.state.rotation, edge_a);
        for (const Vec3 edge_b : b.shape->edge_directions) {
            const Vec3 axis = cross(along_a, rotate(b.state.rotation, edge_b));
            if (length(axis) > 1e-4 && !overlaps_along(normalized(axis))) return least;
        }
    }
    return least;
}

/// Ericson, Real-Time Collision Detection, 5.1.5.
double distance_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    // Vertex regions.
    if (d1 <= 0 && d2 <= 0) return length(ap);
    if (d3 >= 0 && d4 <= d3) return length(bp);
    if (d6 >= 0 && d5 <= d6) return length(cp);
    // Edge regions.
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return length(ap - ab * (d1 / (d1 - d3)));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return length(ap - ac * (d2 / (d2 - d6)));
    if (va <= 0 && d4 >= d3 && d5 >= d6) return length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    // Face region.
    return length(ap - (ab * vb + ac * vc) / (va + vb + vc));
}

double overlap_with_sphere(const Placed& sphere, const Placed& polytope) {
    const Vec3 centre = sphere.state.position;
    double above_all_faces = -huge, nearest = huge;
    for (const auto& t : polytope.shape->triangles) {
        const auto corner = [&](std::size_t k) { return polytope.corners[static_cast<std::size_t>(t[k])]; };
        const Vec3 normal = normalized(cross(corner(1) - corner(0), corner(2) - corner(0)));
        above_all_faces = std::max(above_all_faces, dot(normal, centre - corner(0)));
        nearest = std::min(nearest, distance_to_triangle(centre, corner(0), corner(1), corner(2)));
    }
    return sphere.shape->radius - (above_all_faces <= 0 ? above_all_faces : nearest);
}

double overlap_of(const Placed& a, const Placed& b) {
    const bool a_round = a.shape->kind == ShapeKind::sphere, b_round = b.shape->kind == ShapeKind::sphere;
    if (a_round && b_round) return a.shape->radius + b.shape->radius - distance(a.state.position, b.state.position);
    if (a_round) return overlap_with_sphere(a, b);
    if (b_round) return overlap_with_sphere(b, a);
    return overlap_of_polytopes(a, b);
}

/// Depth of a point below the triangle that is above or below it, along the triangle's normal; 0 beside the terrain.
double depth_in_terrain(const Terrain& terrain, Vec3 p) {
    const double from_edge_x = p.x + 0.5 * terrain.cells, from_edge_z = p.z + 0.5 * terrain.cells;
    const int column = static_cast<int>(std::floor(from_edge_x)), row = static_cast<int>(std::floor(from_edge_z));
    if (column < 0 || row < 0 || column >= terrain.cells || row >= terrain.cells) return 0;
    const double u = from_edge_x - column, v = from_edge_z - row;
    const auto height = [&](int x, int z) {
        const auto across = static_cast<std::size_t>(terrain.cells) + 1;
        return terrain.vertices[static_cast<std::size_t>(row + z) * across + static_cast<std::size_t>(column + x)].y;
    };
    const double right = height(1, 0), front = height(0, 1);
    const bool near_half = u + v <= 1;
    const double corner = near_half ? height(0, 0) : height(1, 1);
    const double slope_x = near_half ? right - corner : corner - front;
    const double slope_z = near_half ? front - corner : corner - right;
    const double surface =
        near_half ? corner + slope_x * u + slope_z * v : corner - slope_x * (1 - u) - slope_z * (1 - v);
    return (surface - p.y) / std::sqrt(1 + slope_x * slope_x + slope_z * slope_z);
}

bool has_escaped(const RaceScene& scene, Vec3 centre) {
    if (!is_finite(centre)) return true;
    if (scene.terrain.cells > 0) return depth_in_terrain(scene.terrain, centre) > 0.5;
    const double aside = std::max(std::fabs(centre.x), std::fabs(centre.z));
    return centre.y < 0 || (scene.pen_half_width > 0 && aside > scene.pen_half_width);
}

/// Depth in the static bodies of the ball of this radius around a point.
double depth_in_statics(const RaceScene& scene, Vec3 point, double radius) {
    if (scene.terrain.cells > 0) return depth_in_terrain(scene.terrain, point) + radius;
    double depth = radius - point.y;
    if (scene.pen_half_width > 0 && point.y < scene.pen_height)
        depth = std::max(depth, std::max(std::fabs(point.x), std::fabs(point.z)) + radius - scene.pen_half_width);
    return depth;
}

double depth_in_statics(const RaceScene& scene, const Placed& body) {
    if (body.shape->kind == ShapeKind::sphere) return depth_in_statics(scene, body.state.position, body.shape->radius);
    double deepest = 0;
    for (const Vec3 corner : body.corners) deepest = std::max(deepest, depth_in_statics(scene, corner, 0));
    return deepest;
}

std::vector<Placed> place(const RaceScene& scene, std::span<const RaceBody> bodies, std::span<const BodyState> states) {
    std::vector<Placed> placed;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Placed body{.shape = &scene.shapes[bodies[i].shape], .state = states[i], .corners = {}};
        const Transform pose{states[i].position, states[i].rotation};
        for (const Vec3 v : body.shape->vertices) body.corners.push_back(transform_point(pose, v));
        body.escaped = has_escaped(scene, states[i].position);
        placed.push_back(std::move(body));
    }
    return placed;
}

}  // namespace

Overlap measure_overlap(const RaceScene& scene, std::span<const RaceBody> bodies, std::span<const BodyState> states) {
    Overlap overlap;
    std::vector<Placed> placed = place(scene, bodies, states);
    overlap.escaped = static_cast<int>(std::erase_if(placed, [](const Placed& body) { return body.escaped; }));
    for (const Placed& body : placed) overlap.statics = std::max(overlap.statics, depth_in_statics(scene, body));

    // Sweep along X, then bounding spheres, then the shapes.
    const auto low = [](const Placed& body) { return body.state.position.x - body.shape->bound; };
    std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) { return low(a) < low(b); });
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const Placed& a = placed[i];
        const double high = a.state.position.x + a.shape->bound;
        for (std::size_t j = i + 1; j < placed.size() && low(placed[j]) <= high; ++j) {
            const Placed& b = placed[j];
            if (distance(a.state.position, b.state.position) < a.shape->bound + b.shape->bound)
                overlap.bodies = std::max(overlap.bodies, overlap_of(a, b));
        }
    }
    return overlap;
}

}  // namespace embody::race
