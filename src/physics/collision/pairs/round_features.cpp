// SPDX-License-Identifier: MIT
#include "physics/collision/pairs/round_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/collision/shapes/polytope_query.h"
#include "physics/collision/shapes/rim.h"

namespace embody::physics::collision {

namespace {

// Names of the features of round shapes; those of polytopes are their indices.
constexpr std::uint32_t top_cap = 0x10000, bottom_cap = 0x10001, side_line = 0x10002;
constexpr double aligned_cosine = 1 - 1e-9;
constexpr double square = 3e-5;

struct UnitCircle {
    std::array<double, rim_corners> cosine{}, sine{};
    // Built by successive rotations, not by the library's sin and cos, whose last digits differ by system.
    UnitCircle() {
        constexpr double c = 0.96592582628906828675, s = 0.25881904510252076235;  // 15 degrees
        static_assert(rim_corners == 24);
        double x = 1, y = 0;
        for (std::size_t i = 0; i < rim_corners; ++i) {
            cosine[i] = x;
            sine[i] = y;
            const double next = x * c - y * s;
            y = x * s + y * c;
            x = next;
        }
    }
};

void get_cap(const PlacedConvex& convex, bool top, Vec3 local_direction, ContactFeature& feature) {
    static const UnitCircle circle;
    const double r = convex.shape->radius;
    const double y = top ? convex.shape->half_height : -convex.shape->half_height;
    const Vec3 normal{0, top ? 1.0 : -1.0, 0};
    const RimStart start = rim_start(local_direction);
    const Vec3 second = cross(normal, start.along);
    feature.clear();
    feature.id = top ? top_cap : bottom_cap;
    feature.normal = convex.direction_to_frame(normal);
    feature.radius = r;
    feature.center = convex.to_frame({0, y, 0});
    const Vec3 along = convex.direction_to_frame(start.along * r), across = convex.direction_to_frame(second * r);
    for (std::size_t i = 0; i < rim_corners; ++i) {
        feature.points.push_back(feature.center + along * circle.cosine[i] + across * circle.sine[i]);
    }
}

// The line of the side that lies farthest along the direction: rim to rim, or rim to apex.
void get_side(const PlacedConvex& convex, Vec3 local_direction, ContactFeature& feature) {
    const Convex& shape = *convex.shape;
    const Vec3 outward = rim_start(local_direction).along * shape.radius;
    const Vec3 top = shape.kind == ConvexKind::cone ? Vec3{} : outward;
    feature.clear();
    feature.id = side_line;
    feature.points.push_back(convex.to_frame(outward - Vec3{0, shape.half_height, 0}));
    feature.points.push_back(convex.to_frame(top + Vec3{0, shape.half_height, 0}));
}

void get_axis(const PlacedConvex& capsule, ContactFeature& feature) {
    feature.clear();
    feature.id = side_line;
    feature.points.push_back(capsule.to_frame({0, -capsule.shape->half_height, 0}));
    feature.points.push_back(capsule.to_frame({0, capsule.shape->half_height, 0}));
}

// Normal of the side of a cylinder or cone nearest to the direction (local).
Vec3 side_normal(const Convex& shape, Vec3 local_direction) {
    const Vec3 outward = rim_start(local_direction).along;
    if (shape.kind == ConvexKind::cylinder) return outward;
    const ConeSlope slope = cone_slope(shape);
    return outward * slope.radial + Vec3{0, slope.axial, 0};
}

bool get_polytope_edge(const PlacedConvex& convex, Vec3 d, ContactFeature& feature) {
    // Of the edges at the farthest vertex, the one most across the direction.
    const Polytope& polytope = convex.shape->polytope;
    const std::uint32_t vertex = support_vertex(polytope, d);
    double least = square;
    std::uint32_t best = Polytope::no_face;
    for (std::uint32_t i = 0; i < polytope.edges.size(); ++i) {
        const Polytope::Edge& edge = polytope.edges[i];
        if (edge.from != vertex && edge.to != vertex) continue;
        const double slope = std::fabs(dot(normalized(polytope.vertices[edge.to] - polytope.vertices[edge.from]), d));
        if (slope >= least) continue;
        least = slope;
        best = i;
    }
    if (best == Polytope::no_face) return false;
    feature.clear();
    feature.id = best;
    feature.points.push_back(convex.to_frame(polytope.vertices[polytope.edges[best].from]));
    feature.points.push_back(convex.to_frame(polytope.vertices[polytope.edges[best].to]));
    return true;
}

}  // namespace

void get_polytope_face(const PlacedConvex& convex, std::uint32_t face, ContactFeature& feature) {
    const Polytope& polytope = convex.shape->polytope;
    const Polytope::Face& f = polytope.faces[face];
    feature.clear();
    feature.id = face;
    feature.normal = convex.direction_to_frame(f.normal);
    for (std::uint32_t i = 0; i < f.count; ++i) {
        feature.points.push_back(convex.to_frame(polytope.vertices[polytope.loops[f.first + i]]));
    }
}

bool has_aligned_face(const PlacedConvex& convex, Vec3 direction, double cosine) {
    const Vec3 d = convex.direction_to_local(direction);
    const Convex& shape = *convex.shape;
    if (shape.kind == ConvexKind::polytope) {
        return dot(shape.polytope.faces[support_face(shape, d)].normal, d) >= cosine;
    }
    const bool has_top = shape.kind == ConvexKind::cylinder;
    return (has_top && d.y >= cosine) || ((has_top || shape.kind == ConvexKind::cone) && d.y <= -cosine);
}

bool get_aligned_face(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature) {
    if (!has_aligned_face(convex, direction, aligned_cosine)) return false;
    const Vec3 d = convex.direction_to_local(direction);
    if (convex.shape->kind == ConvexKind::polytope) {
        get_polytope_face(convex, support_face(*convex.shape, d), feature);
    } else {
        get_cap(convex, d.y > 0, d, feature);
    }
    return true;
}

bool get_aligned_line(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature) {
    const Vec3 d = convex.direction_to_local(direction);
    const Convex& shape = *convex.shape;
    switch (shape.kind) {
        case ConvexKind::sphere:
            return false;
        case ConvexKind::capsule:
            // The round ends of the capsule make the far end right: at any slope the separations of both ends are
            // correct.
            if (std::fabs(d.y) > 0.1) return false;
            get_axis(convex, feature);
            return true;
        case ConvexKind::polytope:
            return get_polytope_edge(convex, d, feature);
        case ConvexKind::cylinder:
        case ConvexKind::cone:
            break;
    }
    const Vec3 normal = side_normal(shape, d);
    if (length(normal - d) > square) return false;
    get_side(convex, d, feature);
    return true;
}

void get_facing(const PlacedConvex& convex, Vec3 direction, ContactFeature& feature) {
    const Vec3 d = convex.direction_to_local(direction);
    const Convex& shape = *convex.shape;
    switch (shape.kind) {
        case ConvexKind::sphere:
            feature.clear();
            feature.points.push_back(convex.position);
            return;
        case ConvexKind::capsule:
            get_axis(convex, feature);
            return;
        case ConvexKind::polytope:
            get_polytope_face(convex, support_face(shape, d), feature);
            return;
        case ConvexKind::cylinder:
        case ConvexKind::cone:
            break;
    }
    const bool cap_exists = shape.kind == ConvexKind::cylinder || d.y < 0;
    if (cap_exists && std::fabs(d.y) >= dot(side_normal(shape, d), d)) {
        get_cap(convex, d.y > 0, d, feature);
    } else {
        get_side(convex, d, feature);
    }
}

Vec3 facing_point(const PlacedConvex& convex, Vec3 direction, Vec3 point) {
    constexpr double across = 0.05;  // cosine to the axis: 3 degrees off a right angle
    const Convex& shape = *convex.shape;
    const Vec3 d = convex.direction_to_local(direction), p = convex.to_local(point);
    // Chooses one end, or, where both are equally far along the direction, the point between them that is nearest.
    const auto settle = [](double along, double half, double at) {
        if (std::fabs(along) > across) return along < 0 ? -half : half;
        return std::fmax(-half, std::fmin(half, at));
    };
    if (shape.is_box) {
        const Vec3 h = shape.bounds.upper;
        return convex.to_frame({settle(d.x, h.x, p.x), settle(d.y, h.y, p.y), settle(d.z, h.z, p.z)});
    }
    if (shape.kind == ConvexKind::capsule) return convex.to_frame({0, settle(d.y, shape.half_height, p.y), 0});
    if (shape.kind == ConvexKind::cylinder || (shape.kind == ConvexKind::cone && d.y < across - 1)) {
        const double radial = std::sqrt(d.x * d.x + d.z * d.z), aside = std::sqrt(p.x * p.x + p.z * p.z);
        const double y = settle(d.y, shape.half_height, p.y);
        if (radial > across) return convex.to_frame({d.x / radial * shape.radius, y, d.z / radial * shape.radius});
        const double fraction = aside > shape.radius ? shape.radius / aside : 1;
        return convex.to_frame({p.x * fraction, y, p.z * fraction});
    }
    return core_support(convex, direction);
}

void add_own_normals(const PlacedConvex& convex, Vec3 direction, bool all_faces, std::vector<Vec3>& normals) {
    const Vec3 d = convex.direction_to_local(direction);
    const Convex& shape = *convex.shape;
    if (shape.kind == ConvexKind::polytope) {
        if (!all_faces) {
            const std::uint32_t face = support_face(shape, d);
            normals.push_back(convex.direction_to_frame(shape.polytope.faces[face].normal));
            return;
        }
        for (const Polytope::Face& face : shape.polytope.faces)
            normals.push_back(convex.direction_to_frame(face.normal));
        return;
    }
    if (shape.kind != ConvexKind::cylinder && shape.kind != ConvexKind::cone) return;
    const bool cap_exists = shape.kind == ConvexKind::cylinder || d.y < 0;
    if (cap_exists) normals.push_back(convex.direction_to_frame({0, d.y < 0 ? -1.0 : 1.0, 0}));
    normals.push_back(convex.direction_to_frame(side_normal(shape, d)));
}

void add_sloped_lines(const PlacedConvex& convex, Vec3 direction, std::vector<SlopedLine>& lines) {
    constexpr std::size_t few = 6;  // directions of edges that are all tried; of more, those across the direction
    const Convex& shape = *convex.shape;
    const Vec3 d = convex.direction_to_local(direction);
    switch (shape.kind) {
        case ConvexKind::sphere:
            return;
        case ConvexKind::capsule:
        case ConvexKind::cylinder:
            lines.push_back({convex.rotation.y, 0});
            return;
        case ConvexKind::cone:
            lines.push_back({convex.rotation.y, cone_slope(shape).axial});
            return;
        case ConvexKind::polytope:
            break;
    }
    // All edges of a simple polytope; of a rich one those at the farthest vertex.
    const Polytope& polytope = shape.polytope;
    if (polytope.edge_directions.size() <= few) {
        for (const Vec3& e : polytope.edge_directions) lines.push_back({convex.direction_to_frame(e), 0});
        return;
    }
    const std::uint32_t vertex = support_vertex(polytope, d);
    for (const Polytope::Edge& edge : polytope.edges) {
        if (edge.from != vertex && edge.to != vertex) continue;
        const Vec3 e = normalized(polytope.vertices[edge.to] - polytope.vertices[edge.from]);
        lines.push_back({convex.direction_to_frame(e), 0});
    }
}

bool is_span(double deepest, double separation) {
    return std::fabs(deepest - separation) <= 1e-4 * std::fabs(separation) + 1e-6;
}

bool span_face(const PlacedConvex& owner, bool is_owner_a, const ContactFeature& line, double lift, double separation,
               double margin, ContactFeature& face, ContactRegion& region) {
    if (owner.shape->kind != ConvexKind::polytope) return false;
    const Vec3 crossing_normal = region.normal, outwards = is_owner_a ? crossing_normal : -crossing_normal;
    const auto nearest = farthest(owner.shape->polytope.normal_lanes, owner.direction_to_local(outwards));
    if (nearest.along < min_span_cosine) return false;
    get_polytope_face(owner, nearest.index, face);
    region.normal = is_owner_a ? face.normal : -face.normal;
    clip_to_region(face, line, is_owner_a, lift, margin, region);

    // Seen along the crossing's normal, to which both edge and line are perpendicular.
    region.normal = crossing_normal;
    double deepest = margin;
    for (ManifoldPoint& point : region.points) {
        point.separation = (point.separation + lift) * nearest.along - lift;
        deepest = std::min(deepest, point.separation);
    }
    if (region.points.size() > 1 && is_span(deepest, separation)) return true;
    region.points.clear();
    return false;
}

}  // namespace embody::physics::collision
