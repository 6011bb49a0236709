// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "geometry/mass_properties.h"
#include "geometry/triangle_mesh.h"

namespace embody::geometry {

/// Convex polyhedron as contact clipping wants it: polygons instead of triangles, edges that know both faces.
struct ConvexHull {
    /// `count` corners from face_vertices[first], counter-clockwise from outside, in the plane normal · p = offset.
    /// No vertex of the hull lies outside the plane; corners lie at most `planarity` below it.
    struct Face {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        Vec3 normal;        ///< unit, outwards
        double offset = 0;  ///< m
    };
    /// Runs from `start` to `end` counter-clockwise around the face `left`, and in the opposite direction around
    /// `right`.
    struct Edge {
        std::uint32_t start = 0, end = 0;
        std::uint32_t left = 0, right = 0;
    };

    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<std::uint32_t> face_vertices;
    /// Parallel to face_vertices: the edge from that corner to the face's next one.
    std::vector<std::uint32_t> face_edges;
    std::vector<Edge> edges;

    double planarity = 0;     ///< m, largest distance of a corner below its face's plane
    double left_outside = 0;  ///< m, how far the farthest given point lies outside (0 unless vertices were left out)

    [[nodiscard]] std::span<const std::uint32_t> corners(const Face& face) const {
        return std::span(face_vertices).subspan(face.first, face.count);
    }
};

/// Limits of `max_vertices`; the upper one bounds the time of the final check (every vertex against every face).
inline constexpr int min_hull_vertices = 4;
inline constexpr int max_hull_vertices = 4096;

/// The convex hull of `points`, with at most `max_vertices` of them as vertices. Where the full hull needs more, those
/// farthest outside are taken greedily, so extremes stay; the result then lies inside the full hull and says by how
/// much. Faces that are coplanar within 1e-6 of the size are merged. Same points in the same order give the same hull.
/// Errors: fewer than 4 points, a point that is not finite, points all in one place, line or plane (within 1e-5 of the
/// size), `max_vertices` out of its limits. Safe to call from several threads.
Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, int max_vertices = 256);
/// The convex hull of the vertices that triangles of `mesh` use.
Result<ConvexHull> build_convex_hull(const TriangleMesh& mesh, int max_vertices = 256);

/// The faces as triangle fans (single precision, as meshes are).
TriangleMesh to_mesh(const ConvexHull& hull);
/// Volume, centre and inertia of the solid hull at density 1, in double precision.
MassProperties integrate_hull(const ConvexHull& hull);
Bounds bounds(const ConvexHull& hull);

}  // namespace embody::geometry
