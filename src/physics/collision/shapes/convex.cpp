// SPDX-License-Identifier: MIT
#include "physics/collision/shapes/convex.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/mean_point.h"
#include "physics/collision/shapes/polytope_query.h"
#include "physics/definitions/box_faces.h"

namespace embody::physics::collision {

namespace {

Vec3 rim_support(double radius, Vec3 local_direction, double height) {
    const double squared = local_direction.x * local_direction.x + local_direction.z * local_direction.z;
    if (!(squared > 1e-300)) return {radius, height, 0};
    const double s = radius / std::sqrt(squared);
    return {local_direction.x * s, height, local_direction.z * s};
}

// The maximum over all vertices along each face's normal, and lanes of vertices and normals.
void fill_lanes(Polytope& polytope) {
    std::vector<Vec3> normals;
    for (const Polytope::Face& face : polytope.faces) {
        double reach = -1e300;
        for (const Vec3& v : polytope.vertices) reach = std::fmax(reach, dot(face.normal, v));
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const Vec3 corner = polytope.vertices[polytope.loops[face.first + i]];
            polytope.unevenness = std::fmax(polytope.unevenness, reach - dot(face.normal, corner));
        }
        normals.push_back(face.normal);
        polytope.reach.push_back(reach);
    }
    polytope.normal_lanes.assign(normals);
    polytope.vertex_lanes.assign(polytope.vertices);
    polytope.rough_vertex_lanes.assign(polytope.vertices);
    polytope.reach.resize(polytope.normal_lanes.size(), polytope.reach[0]);
}

// The vertices around each vertex, in the order of the edges.
void fill_spokes(Polytope& polytope) {
    polytope.spoke_first.assign(polytope.vertices.size() + 1, 0);
    for (const Polytope::Edge& edge : polytope.edges) {
        ++polytope.spoke_first[edge.from + 1];
        ++polytope.spoke_first[edge.to + 1];
    }
    for (std::size_t v = 1; v < polytope.spoke_first.size(); ++v)
        polytope.spoke_first[v] += polytope.spoke_first[v - 1];
    std::vector<std::uint32_t> next(polytope.spoke_first.begin(), polytope.spoke_first.end() - 1);
    polytope.spokes.resize(2 * polytope.edges.size());
    for (const Polytope::Edge& edge : polytope.edges) {
        polytope.spokes[next[edge.from]++] = edge.to;
        polytope.spokes[next[edge.to]++] = edge.from;
    }
}

}  // namespace

void Lanes::assign(const std::vector<Vec3>& vectors) {
    const std::size_t filled = (vectors.size() + multiple - 1) / multiple * multiple;
    for (std::size_t i = 0; i < filled; ++i) {
        const Vec3 v = vectors[i < vectors.size() ? i : 0];
        x.push_back(v.x);
        y.push_back(v.y);
        z.push_back(v.z);
    }
}

void RoughLanes::assign(const std::vector<Vec3>& vectors) {
    const std::size_t filled = (vectors.size() + multiple - 1) / multiple * multiple;
    for (std::size_t i = 0; i < filled; ++i) {
        const Vec3f v = to_vec3f(vectors[i < vectors.size() ? i : 0]);
        x.push_back(v.x);
        y.push_back(v.y);
        z.push_back(v.z);
    }
}

Polytope box_polytope(Vec3 h) {
    Polytope box;
    const std::array<Vec3, 8> corners = box_corners(h);
    box.vertices.assign(corners.begin(), corners.end());
    const Vec3 normals[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    const double offsets[6] = {h.x, h.x, h.y, h.y, h.z, h.z};
    for (std::uint32_t f = 0; f < 6; ++f) {
        box.faces.push_back({normals[f], offsets[f], 4 * f, 4});
        box.loops.insert(box.loops.end(), box_faces[f].begin(), box_faces[f].end());
    }
    link_edges(box);
    return box;
}

Polytope triangle_polytope(Vec3 a, Vec3 b, Vec3 c) {
    Polytope triangle;
    triangle.vertices = {a, b, c};
    triangle.faces.push_back({{}, 0, 0, 3});
    triangle.loops = {0, 1, 2};
    triangle.edges = {{0, 1, 0, Polytope::no_face}, {1, 2, 0, Polytope::no_face}, {2, 0, 0, Polytope::no_face}};
    triangle.edge_directions.resize(3);
    set_triangle(triangle, a, b, c);
    return triangle;
}

void set_triangle(Polytope& triangle, Vec3 a, Vec3 b, Vec3 c) {
    triangle.vertices[0] = a;
    triangle.vertices[1] = b;
    triangle.vertices[2] = c;
    triangle.faces[0].normal = normalized(cross(b - a, c - a));
    triangle.faces[0].offset = dot(triangle.faces[0].normal, a);
    triangle.edge_directions[0] = normalized(b - a);
    triangle.edge_directions[1] = normalized(c - b);
    triangle.edge_directions[2] = normalized(a - c);
    triangle.center = (a + b + c) / 3;
}

void link_edges(Polytope& polytope) {
    // Each undirected edge is met twice: first by the face on its left, then by the one on its right.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> seen;
    for (std::uint32_t f = 0; f < polytope.faces.size(); ++f) {
        const Polytope::Face& face = polytope.faces[f];
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const std::uint32_t from = polytope.loops[face.first + i];
            const std::uint32_t to = polytope.loops[face.first + (i + 1) % face.count];
            const auto found = seen.find({to, from});
            if (found != seen.end()) {
                polytope.edges[found->second].right = f;
            } else {
                seen[{from, to}] = polytope.edges.size();
                polytope.edges.push_back({from, to, f, Polytope::no_face});
            }
        }
    }

    // Each direction once, so that parallel edges cost one axis.
    for (const Polytope::Edge& edge : polytope.edges) {
        const Vec3 d = normalized(polytope.vertices[edge.to] - polytope.vertices[edge.from]);
        bool known = false;
        for (const Vec3& other : polytope.edge_directions) known = known || std::fabs(dot(d, other)) > 1 - 1e-12;
        if (!known) polytope.edge_directions.push_back(d);
    }
    polytope.center = geometry::mean_point(polytope.vertices);
    fill_lanes(polytope);
    fill_spokes(polytope);
}

std::uint32_t support_vertex(const Polytope& polytope, Vec3 direction) {
    if (polytope.vertex_lanes.size() > 0) return farthest(polytope.vertex_lanes, direction).index;
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < polytope.vertices.size(); ++i) {
        if (dot(polytope.vertices[i], direction) > dot(polytope.vertices[best], direction)) best = i;
    }
    return best;
}

std::uint32_t support_face(const Polytope& polytope, Vec3 direction) {
    if (polytope.faces.size() == 1) return 0;
    return farthest(polytope.normal_lanes, direction).index;
}

std::uint32_t support_face(const Convex& convex, Vec3 d) {
    if (!convex.is_box) return support_face(convex.polytope, d);
    // In the order of box_polytope.
    const Vec3 size = abs(d);
    if (size.x >= size.y && size.x >= size.z) return d.x < 0 ? 0 : 1;
    if (size.y >= size.z) return d.y < 0 ? 2 : 3;
    return d.z < 0 ? 4 : 5;
}

Core::Core(const PlacedConvex& placed, double shrink)
    : shape(placed.shape),
      rotation(placed.rotation),
      position(placed.position),
      is_turned(placed.rotation != Mat3{} || placed.position != Vec3{}),
      depth(shrink + rounding(*placed.shape)) {
    const Convex& convex = *placed.shape;
    const double h = convex.half_height;
    radius = convex.radius - shrink;
    top = h - shrink;
    bottom = -top;
    if (convex.kind == ConvexKind::capsule) {
        top = h;
        bottom = -h;
    } else if (convex.kind == ConvexKind::cone && shrink > 0) {
        const ConeSlope slope = cone_slope(convex);
        radius = convex.radius - shrink * (1 + slope.axial) / slope.radial;
        top = h - shrink / slope.axial;
    } else if (convex.is_box) {
        half = convex.bounds.upper - Vec3{shrink, shrink, shrink};
    }
}

Vec3 Core::local_support(Vec3 d) const {
    switch (shape->kind) {
        case ConvexKind::sphere:
            return {};
        case ConvexKind::capsule:
            return {0, d.y < 0 ? bottom : top, 0};
        case ConvexKind::polytope:
            if (!shape->is_box) return shape->polytope.vertices[support_vertex(shape->polytope, d)];
            return {d.x < 0 ? -half.x : half.x, d.y < 0 ? -half.y : half.y, d.z < 0 ? -half.z : half.z};
        case ConvexKind::cylinder:
            return rim_support(radius, d, d.y < 0 ? bottom : top);
        case ConvexKind::cone:
            break;
    }
    // Cone: the apex or the rim of the base.
    const Vec3 rim = rim_support(radius, d, bottom);
    const Vec3 apex{0, top, 0};
    return dot(d, apex) > dot(d, rim) ? apex : rim;
}

Vec3 Core::support(Vec3 d) const {
    if (!is_turned) return local_support(d);
    return position + rotation * local_support({dot(rotation.x, d), dot(rotation.y, d), dot(rotation.z, d)});
}

double shrinkable(const Convex& convex) {
    constexpr double fraction = 0.1;  // of the inner radius
    switch (convex.kind) {
        case ConvexKind::sphere:
        case ConvexKind::capsule:
            return 0;
        case ConvexKind::polytope: {
            const Vec3 h = convex.bounds.upper;
            return convex.is_box ? fraction * std::fmin(h.x, std::fmin(h.y, h.z)) : 0;
        }
        case ConvexKind::cylinder:
            return fraction * std::fmin(convex.radius, convex.half_height);
        case ConvexKind::cone:
            break;
    }
    // As a fraction of the radius of the largest ball inside.
    const ConeSlope slope = cone_slope(convex);
    return fraction * convex.radius * slope.radial / (1 + slope.axial);
}

Vec3 core_support(const PlacedConvex& convex, Vec3 direction) { return Core(convex).support(direction); }

Vec3 interior_point(const PlacedConvex& convex) {
    if (convex.shape->kind == ConvexKind::polytope) return convex.to_frame(convex.shape->polytope.center);
    if (convex.shape->kind == ConvexKind::cone) return convex.to_frame({0, -0.5 * convex.shape->half_height, 0});
    return convex.position;
}

double separation_along(const PlacedConvex& a, const PlacedConvex& b, Vec3 normal) {
    return separation_along(Core(a), Core(b), normal);
}

double separation_along(const Core& a, const Core& b, Vec3 normal) {
    return dot(normal, b.support(-normal) - a.support(normal)) - a.depth - b.depth;
}

ConeSlope cone_slope(const Convex& cone) {
    const double slant = std::sqrt(4 * cone.half_height * cone.half_height + cone.radius * cone.radius);
    return {2 * cone.half_height / slant, cone.radius / slant};
}

}  // namespace embody::physics::collision
