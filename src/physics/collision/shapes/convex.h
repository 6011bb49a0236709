// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"
#include "math/mat3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Vectors by components, in lanes: filled up to a multiple of the widest register with copies of the first, so that
/// loops over them need no rest and a maximum stays one of the originals.
struct Lanes {
    static constexpr std::size_t multiple = 8;  // doubles of 512 bits
    std::vector<double> x, y, z;

    void assign(const std::vector<Vec3>& vectors);
    [[nodiscard]] std::size_t size() const { return x.size(); }
};

/// As Lanes, in single precision.
struct RoughLanes {
    static constexpr std::size_t multiple = 16;  // floats of 512 bits
    std::vector<float> x, y, z;

    void assign(const std::vector<Vec3>& vectors);
};

/// Convex polyhedron with merged planar faces. Loops run counter-clockwise seen from outside.
struct Polytope {
    static constexpr std::uint32_t no_face = 0xFFFFFFFFu;

    struct Face {
        Vec3 normal;                         ///< unit, outwards
        double offset = 0;                   ///< dot(normal, p) on the face
        std::uint32_t first = 0, count = 0;  ///< its corners in `loops`
    };
    struct Edge {
        std::uint32_t from = 0, to = 0;  ///< vertices, as `left` runs along it
        std::uint32_t left = 0, right = no_face;
    };
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<std::uint32_t> loops;  ///< vertex indices, face after face
    std::vector<Edge> edges;
    std::vector<Vec3> edge_directions;  ///< unit, each direction once (without its sign)
    Vec3 center;                        ///< mean of the vertices, inside
    // For the separating axes, filled with the edges. `reach`: largest dot(normal, vertex) of each face, its plane's
    // offset up to merging; `unevenness`: maximum depth of corners below their faces.
    Lanes vertex_lanes, normal_lanes;
    RoughLanes rough_vertex_lanes;
    std::vector<double> reach;
    double unevenness = 0;
    // The vertices joined to each one by an edge: those of vertex v from spoke_first[v] to spoke_first[v + 1].
    std::vector<std::uint32_t> spoke_first, spokes;

    [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t vertex) const {
        return {spokes.data() + spoke_first[vertex], spokes.data() + spoke_first[vertex + 1]};
    }
};

Polytope box_polytope(Vec3 half_extents);
/// One flat face with open edges, counter-clockwise seen from the front.
Polytope triangle_polytope(Vec3 a, Vec3 b, Vec3 c);
/// Sets the corners of an existing triangle without allocating.
void set_triangle(Polytope& triangle, Vec3 a, Vec3 b, Vec3 c);
/// Fills edges, edge_directions, center, lanes, reach and spokes from vertices, faces and loops.
void link_edges(Polytope& polytope);

enum class ConvexKind : std::uint8_t { sphere, capsule, polytope, cylinder, cone };

/// A convex solid in its own frame: a core and, for sphere and capsule, a radius around it.
struct Convex {
    ConvexKind kind = ConvexKind::sphere;
    double radius = 0;
    double half_height = 0;
    Polytope polytope;
    Bounds bounds;
    bool is_box = false;  ///< a polytope whose corners are those of `bounds`, centred
    double reach = 0;     ///< farthest surface point from the inner point, for whole pieces of shapes
    double inner = 0;     ///< radius of a ball around the inner point that lies inside, likewise

    /// Whether it is of the kinds that roll.
    [[nodiscard]] bool is_round() const { return kind != ConvexKind::polytope; }
};

/// A convex seen from the frame in which a pair is compared (world axes, origin near the pair: far from the world's
/// origin no digit is lost).
struct PlacedConvex {
    const Convex* shape = nullptr;
    Mat3 rotation;
    Vec3 position;

    [[nodiscard]] Vec3 to_frame(Vec3 local) const { return position + rotation * local; }
    [[nodiscard]] Vec3 direction_to_frame(Vec3 local) const { return rotation * local; }
    [[nodiscard]] Vec3 to_local(Vec3 p) const { return direction_to_local(p - position); }
    [[nodiscard]] Vec3 direction_to_local(Vec3 d) const {
        return {dot(rotation.x, d), dot(rotation.y, d), dot(rotation.z, d)};
    }
};

/// False for a single triangle.
inline bool has_volume(const Convex& convex) {
    return convex.kind != ConvexKind::polytope || convex.polytope.faces.size() > 1;
}
/// A point well inside the solid.
Vec3 interior_point(const PlacedConvex& convex);
/// Radius around the core.
inline double rounding(const Convex& convex) {
    return convex.kind == ConvexKind::sphere || convex.kind == ConvexKind::capsule ? convex.radius : 0.0;
}

/// The part of a placed convex at least a depth inside: the solid without the radius around it (sphere, capsule) and,
/// if `shrink` is not zero, every face and side moved inwards by it. Its support points are quick to find.
struct Core {
    const Convex* shape = nullptr;
    Mat3 rotation;
    Vec3 position;
    bool is_turned = true;       ///< false: rotation and position change nothing
    double radius = 0;           ///< of cylinder and cone
    double top = 0, bottom = 0;  ///< heights of caps, base, apex, or ends of a capsule's axis
    Vec3 half;                   ///< of a box
    double depth = 0;            ///< how deep inside the solid's faces and smooth sides it lies

    explicit Core(const PlacedConvex& placed, double shrink = 0);
    [[nodiscard]] Vec3 support(Vec3 direction) const;
    /// A point well inside.
    [[nodiscard]] Vec3 interior() const { return interior_point({shape, rotation, position}); }

private:
    [[nodiscard]] Vec3 local_support(Vec3 direction) const;
};
/// The depth by which a core is shrunk to lie inside the solid: a small part of its thickness, deeper than resting
/// contacts are; 0 for polytopes other than boxes.
double shrinkable(const Convex& convex);

/// Index of the vertex farthest along `direction` (local).
std::uint32_t support_vertex(const Polytope& polytope, Vec3 direction);
/// Index of the face whose normal is nearest to `direction` (local).
std::uint32_t support_face(const Polytope& polytope, Vec3 direction);
/// As above for a box or any other polytope.
std::uint32_t support_face(const Convex& convex, Vec3 direction);
/// Farthest point of the core along `direction` (frame, any length).
Vec3 core_support(const PlacedConvex& convex, Vec3 direction);
/// Gap between the two solids along the unit direction `normal` from a to b: never more than their true distance, and
/// equal to it (or to minus the penetration depth) along the best normal.
double separation_along(const PlacedConvex& a, const PlacedConvex& b, Vec3 normal);
/// As above for two cores, less their depths.
double separation_along(const Core& a, const Core& b, Vec3 normal);

/// Cone: slope of the side's normal: unit (radial, axial) components.
struct ConeSlope {
    double radial = 0, axial = 0;
};
ConeSlope cone_slope(const Convex& cone);

}  // namespace embody::physics::collision
