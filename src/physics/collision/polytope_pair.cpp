// SPDX-License-Identifier: MIT
// Separating axes of two polytopes (boxes and hulls): face normals of both, and the cross products of those edge pairs
// that build a face of the Minkowski difference (D. Gregorius, "The separating axis test between convex polyhedra",
// GDC 2013: arcs on the Gauss map). Then the region: incident face clipped by the reference face's sides.
#include <cmath>

#include "physics/collision/convex_pairs.h"
#include "physics/collision/gjk.h"

namespace embody::physics {

namespace {

/// Vertices and face normals turned into the frame of the pair, once a pair.
struct TurnedPolytope {
    const Polytope* source = nullptr;
    std::vector<Vec3> vertices, normals;
    Vec3 center;

    void turn(const PlacedConvex& placed) {
        source = &placed.shape->polytope;
        vertices.clear();
        normals.clear();
        for (const Vec3& v : source->vertices) vertices.push_back(placed.to_frame(v));
        for (const Polytope::Face& f : source->faces) normals.push_back(placed.direction_to_frame(f.normal));
        center = placed.to_frame(source->center);
    }
    [[nodiscard]] Vec3 face_point(std::uint32_t face) const {
        return vertices[source->loops[source->faces[face].first]];
    }
    [[nodiscard]] double lowest_along(Vec3 direction) const {
        double lowest = dot(vertices[0], direction);
        for (const Vec3& v : vertices) lowest = std::fmin(lowest, dot(v, direction));
        return lowest;
    }
    [[nodiscard]] std::uint32_t face_along(Vec3 direction) const {
        std::uint32_t best = 0;
        for (std::uint32_t i = 1; i < normals.size(); ++i) {
            if (dot(normals[i], direction) > dot(normals[best], direction)) best = i;
        }
        return best;
    }
    void get_face(std::uint32_t face, ContactFeature& feature) const {
        feature.clear();
        feature.id = face;
        feature.normal = normals[face];
        const Polytope::Face& f = source->faces[face];
        for (std::uint32_t i = 0; i < f.count; ++i) feature.points.push_back(vertices[source->loops[f.first + i]]);
    }
    void get_edge(std::uint32_t edge, ContactFeature& feature) const {
        feature.clear();
        feature.id = edge;
        feature.points.push_back(vertices[source->edges[edge].from]);
        feature.points.push_back(vertices[source->edges[edge].to]);
    }
};

struct FaceAxis {
    double separation = -1e300;
    std::uint32_t face = 0;
};
struct EdgeAxis {
    double separation = -1e300;
    std::uint32_t edge_a = 0, edge_b = 0;
    Vec3 normal;
};

FaceAxis best_face_axis(const TurnedPolytope& faces_of, const TurnedPolytope& other, double margin) {
    FaceAxis best;
    for (std::uint32_t f = 0; f < faces_of.normals.size(); ++f) {
        const Vec3 n = faces_of.normals[f];
        const double separation = other.lowest_along(n) - dot(n, faces_of.face_point(f));
        if (separation > best.separation) best = {separation, f};
        if (separation > margin) break;
    }
    return best;
}

// Whether the arcs of two edges cross on the unit sphere, i.e. the edge pair is a face of the Minkowski difference.
bool arcs_cross(Vec3 a, Vec3 b, Vec3 b_cross_a, Vec3 c, Vec3 d, Vec3 d_cross_c) {
    const double cba = dot(c, b_cross_a), dba = dot(d, b_cross_a);
    const double adc = dot(a, d_cross_c), bdc = dot(b, d_cross_c);
    return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

EdgeAxis best_edge_axis(const TurnedPolytope& a, const TurnedPolytope& b, double margin) {
    EdgeAxis best;
    for (std::uint32_t i = 0; i < a.source->edges.size(); ++i) {
        const Polytope::Edge& edge_a = a.source->edges[i];
        const Vec3 left_a = a.normals[edge_a.left], right_a = a.normals[edge_a.right];
        const Vec3 turn_a = cross(right_a, left_a);
        const Vec3 along_a = a.vertices[edge_a.to] - a.vertices[edge_a.from];
        for (std::uint32_t j = 0; j < b.source->edges.size(); ++j) {
            const Polytope::Edge& edge_b = b.source->edges[j];
            const Vec3 left_b = -b.normals[edge_b.left], right_b = -b.normals[edge_b.right];
            if (!arcs_cross(left_a, right_a, turn_a, left_b, right_b, cross(right_b, left_b))) continue;

            // Nearly parallel edges have no axis of their own: a face tells as much.
            const Vec3 along_b = b.vertices[edge_b.to] - b.vertices[edge_b.from];
            Vec3 n = cross(along_a, along_b);
            const double size = length(n);
            if (size < 1e-6 * length(along_a) * length(along_b)) continue;
            n = n / size;
            if (dot(n, a.vertices[edge_a.from] - a.center) < 0) n = -n;
            if (dot(n, b.vertices[edge_b.from] - a.vertices[edge_a.from]) <= best.separation) continue;

            // Edges of merged faces lie a little beside the faces' planes; where they are short, n may not touch the
            // shapes at these edges at all. The shapes' own extent along n is what separates them.
            const double separation = b.lowest_along(n) + a.lowest_along(-n);
            if (separation > best.separation) best = {separation, i, j, n};
            if (separation > margin) return best;
        }
    }
    return best;
}

// Where the faces' sides cut everything off though the shapes are within the margin, the nearest points alone.
void add_nearest_points(const PlacedConvex& a, const PlacedConvex& b, double margin, ContactRegion& region) {
    const CoreDistance gap = core_distance(a, b, margin);
    if (gap.overlap) {
        const double separation = separation_along(a, b, region.normal);
        region.add(core_support(b, -region.normal) - region.normal * separation, separation, 1);
    } else if (gap.distance <= margin && gap.distance > 0) {
        region.normal = (gap.on_b - gap.on_a) / gap.distance;
        region.add(gap.on_a, gap.distance, 1);
    }
}

struct PairScratch {
    TurnedPolytope a, b;
    ContactFeature reference, incident;
};

}  // namespace

void collide_polytopes(const PlacedConvex& a, const PlacedConvex& b, double margin, ContactRegion& region) {
    thread_local PairScratch scratch;
    scratch.a.turn(a);
    scratch.b.turn(b);

    // The axis of largest separation among faces of a, faces of b, edge pairs.
    const FaceAxis face_a = best_face_axis(scratch.a, scratch.b, margin);
    if (face_a.separation > margin) return;
    const FaceAxis face_b = best_face_axis(scratch.b, scratch.a, margin);
    if (face_b.separation > margin) return;
    const EdgeAxis edge = best_edge_axis(scratch.a, scratch.b, margin);
    if (edge.separation > margin) return;

    // Faces are preferred by a little: they give a region, and the choice does not flicker by rounding.
    const Vec3 extents_a = a.shape->bounds.size(), extents_b = b.shape->bounds.size();
    const double size = std::fmin(std::fmin(extents_a.x, std::fmin(extents_a.y, extents_a.z)),
                                  std::fmin(extents_b.x, std::fmin(extents_b.y, extents_b.z)));
    const double bias = 1e-4 * size;
    const double face_separation = std::fmax(face_a.separation, face_b.separation);
    if (edge.separation > face_separation + bias + 0.02 * std::fabs(face_separation)) {
        region.normal = edge.normal;
        scratch.a.get_edge(edge.edge_a, scratch.reference);
        scratch.b.get_edge(edge.edge_b, scratch.incident);
        cross_segments(scratch.reference, scratch.incident, 0, 0, margin, region);
    } else {
        const bool reference_is_a = face_b.separation <= face_a.separation + bias;
        const TurnedPolytope& reference = reference_is_a ? scratch.a : scratch.b;
        const TurnedPolytope& incident = reference_is_a ? scratch.b : scratch.a;
        reference.get_face(reference_is_a ? face_a.face : face_b.face, scratch.reference);
        incident.get_face(incident.face_along(-scratch.reference.normal), scratch.incident);
        region.normal = reference_is_a ? scratch.reference.normal : -scratch.reference.normal;
        add_near_corners(scratch.reference, reference_is_a ? b : a, reference_is_a, margin, region);
        clip_to_region(scratch.reference, scratch.incident, reference_is_a, 0, margin, region);

        // Where they overlap the deepest corner is over the reference face; a little apart it may be beside it.
        const double separation = reference_is_a ? face_a.separation : face_b.separation;
        if (separation < 0) {
            const Vec3 corner = core_support(reference_is_a ? b : a, -scratch.reference.normal);
            const Vec3 on_a = reference_is_a ? corner - region.normal * separation : corner;
            keep_deepest(on_a, separation, bias, region);
        }
    }
    if (region.points.empty()) add_nearest_points(a, b, margin, region);
}

}  // namespace embody::physics
