// SPDX-License-Identifier: MIT
// Separating axes of two polytopes: face normals of both, and the cross products of those edge pairs that build a face
// of the Minkowski difference (D. Gregorius, "The separating axis test between convex polyhedra", GDC 2013: arcs on the
// Gauss map). Almost all are ruled out by a witness: the gap along a face normal is at most the height of any point of
// the other polytope over that face, and the gap along an edge's normal is bounded by a witness's heights over its two
// faces. So no axis is left out that could be the best; the order of measuring changes only the time.
// Then the region: the incident face clipped by the reference face's sides.
#include <algorithm>
#include <cmath>
#include <span>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/round_features.h"
#include "physics/collision/queries/gjk.h"
#include "physics/collision/shapes/polytope_query.h"

namespace embody::physics::collision {

namespace {

constexpr std::uint32_t none = Polytope::no_face;

struct FaceAxis {
    double separation = -1e300;
    std::uint32_t face = none;
    Vec3 witness;  ///< the other polytope's point nearest to the face, in the frame of the face's polytope
};

struct EdgeAxis {
    double separation = -1e300;
    std::uint32_t edge_a = 0, edge_b = 0;
    Vec3 normal;  ///< unit, in a's frame, from a to b
};

/// An edge that may separate the pair, turned into a's frame: the normals beside it (b's reversed) and its line.
struct EdgeArc {
    Vec3 left, right, turn;  ///< turn: right x left
    Vec3 from, along;
    std::uint32_t edge = 0;
};

/// Two polytopes, each in the frame of the other, and memory for the search.
struct PolytopeSearch {
    const Polytope* a = nullptr;
    const Polytope* b = nullptr;
    PlacedConvex b_in_a, a_in_b;
    double margin = 0;
    std::vector<double> heights, bounds;
    std::vector<std::uint32_t> edges;
    std::vector<EdgeArc> arcs_a, arcs_b;
};

/// Best face of `faces`, `other` placed in its frame. Only faces with a gap above `least` count. `start` is any
/// point of the other, `first` a face to measure first (or none).
FaceAxis best_face_axis(const Polytope& faces, const PlacedConvex& other, double least, Vec3 start, std::uint32_t first,
                        PolytopeSearch& s) {
    FaceAxis best;
    best.separation = least;
    const std::size_t count = faces.faces.size();
    const Polytope& points = other.shape->polytope;
    s.bounds.assign(faces.normal_lanes.size(), 1e300);
    Extreme next{1e300, first};
    if (first >= count) next = lower_bounds(faces, start, s.bounds.data());
    for (std::size_t iterations = 0; iterations <= count; ++iterations) {
        // The face with the highest bound; of equal ones the first, whatever was measured before.
        if (next.along < best.separation) break;
        if (next.along == best.separation && (best.face == none || next.index > best.face)) break;

        const Vec3 normal = faces.faces[next.index].normal;
        const Extreme lowest = farthest(points.vertex_lanes, -other.direction_to_local(normal));
        const Vec3 witness = other.to_frame(points.vertices[lowest.index]);
        const double separation = dot(normal, witness) - faces.reach[next.index];
        const bool is_tie = separation == best.separation && best.face != none && next.index < best.face;
        if (separation > best.separation || is_tie) best = {separation, next.index, witness};
        if (separation > s.margin) break;
        // Measured: its bound is not used again.
        s.bounds[next.index] = -1e300;
        next = lower_bounds(faces, witness, s.bounds.data());
    }
    return best;
}

// Edges beside a face below which the witness lies by at most `depth`.
void gather_edges(const Polytope& polytope, Vec3 witness, double depth, PolytopeSearch& s) {
    s.heights.resize(polytope.normal_lanes.size());
    heights_over_faces(polytope, witness, s.heights.data());
    s.edges.resize(polytope.edges.size());
    const double limit = -depth - polytope.unevenness;
    std::size_t count = 0;
    for (std::uint32_t e = 0; e < polytope.edges.size(); ++e) {
        const Polytope::Edge& edge = polytope.edges[e];
        s.edges[count] = e;
        count += std::max(s.heights[edge.left], s.heights[edge.right]) >= limit ? 1 : 0;
    }
    s.edges.resize(count);
}

void place_arcs_of_a(PolytopeSearch& s) {
    s.arcs_a.clear();
    for (const std::uint32_t e : s.edges) {
        const Polytope::Edge& edge = s.a->edges[e];
        const Vec3 left = s.a->faces[edge.left].normal, right = s.a->faces[edge.right].normal;
        const Vec3 from = s.a->vertices[edge.from];
        s.arcs_a.push_back({left, right, cross(right, left), from, s.a->vertices[edge.to] - from, e});
    }
}

void place_arcs_of_b(PolytopeSearch& s) {
    s.arcs_b.clear();
    for (const std::uint32_t e : s.edges) {
        const Polytope::Edge& edge = s.b->edges[e];
        const Vec3 left = -s.b_in_a.direction_to_frame(s.b->faces[edge.left].normal);
        const Vec3 right = -s.b_in_a.direction_to_frame(s.b->faces[edge.right].normal);
        const Vec3 from = s.b_in_a.to_frame(s.b->vertices[edge.from]);
        const Vec3 along = s.b_in_a.direction_to_frame(s.b->vertices[edge.to] - s.b->vertices[edge.from]);
        s.arcs_b.push_back({left, right, cross(right, left), from, along, e});
    }
}

// Whether the arcs of two edges cross on the unit sphere, i.e. the edge pair is a face of the Minkowski difference.
bool arcs_cross(const EdgeArc& a, const EdgeArc& b) {
    const double cba = dot(b.left, a.turn), dba = dot(b.right, a.turn);
    const double adc = dot(a.left, b.turn), bdc = dot(a.right, b.turn);
    return (cba * dba < 0) & (adc * bdc < 0) & (cba * bdc > 0);
}

// The gap between the two polytopes along a direction from a to b, in a's frame.
double gap_along(const PolytopeSearch& s, Vec3 n) {
    const double reach_a = farthest(s.a->vertex_lanes, n).along;
    const double reach_b = farthest(s.b->vertex_lanes, -s.b_in_a.direction_to_local(n)).along;
    return dot(n, s.b_in_a.position) - reach_b - reach_a;
}

// Gap along an edge pair's own normal. Edges of merged faces lie a little beside the faces' planes; where they are
// short, the shapes may not touch along the normal at these edges at all. The gap is that of the shapes' extents along
// it.
void measure_edge_pair(const EdgeArc& a, const EdgeArc& b, PolytopeSearch& s, EdgeAxis& best) {
    // Nearly parallel edges have no axis of their own: a face has nearly the same.
    Vec3 n = cross(a.along, b.along);
    const double squared = length_squared(n);
    if (squared < 1e-12 * length_squared(a.along) * length_squared(b.along)) return;
    n = n / std::sqrt(squared);
    if (dot(n, a.left + a.right) < 0) n = -n;
    if (dot(n, b.from - a.from) <= best.separation) return;
    const double separation = gap_along(s, n);
    if (separation > best.separation) best = {separation, a.edge, b.edge, n};
}

// False where far too many edges are left to pair them all: deep inside each other.
bool best_edge_axis(double least, Vec3 witness_of_b, Vec3 witness_of_a, PolytopeSearch& s, EdgeAxis& best) {
    constexpr std::size_t max_pairs = 40000;  // of edges
    best.separation = least;
    const double depth = std::max(0.0, -least);
    gather_edges(*s.a, witness_of_b, depth, s);
    place_arcs_of_a(s);
    gather_edges(*s.b, witness_of_a, depth, s);
    if (s.arcs_a.size() * s.edges.size() > max_pairs) return false;
    place_arcs_of_b(s);
    for (const EdgeArc& a : s.arcs_a) {
        for (const EdgeArc& b : s.arcs_b) {
            if (!arcs_cross(a, b)) continue;
            measure_edge_pair(a, b, s, best);
            if (best.separation > s.margin) return true;
        }
    }
    return true;
}

void get_edge(const PlacedConvex& placed, std::uint32_t edge, ContactFeature& feature) {
    const Polytope& polytope = placed.shape->polytope;
    feature.clear();
    feature.id = edge;
    feature.points.push_back(placed.to_frame(polytope.vertices[polytope.edges[edge].from]));
    feature.points.push_back(placed.to_frame(polytope.vertices[polytope.edges[edge].to]));
}

// Pairs that are searched farther than this move too fast for their contacts to be followed: other features within the
// margin need not be known. m
constexpr double widest_followed = 8 * Manifold::whole_travel;

// Whether corners other than the given ones lie up to `level` along a direction of the polytope's own frame.
bool has_other_corners(const Polytope& polytope, Vec3 direction, double level, std::span<const std::uint32_t> known,
                       std::vector<std::uint32_t>& low) {
    low.resize(polytope.vertex_lanes.size());
    const std::uint32_t count = find_low(polytope.vertex_lanes, direction, level, low.data());
    return std::any_of(low.begin(), low.begin() + count, [&](std::uint32_t v) {
        return v < polytope.vertices.size() && std::find(known.begin(), known.end(), v) == known.end();
    });
}

// Whether a rich polytope has corners beside one of its faces that are close to the feature that meets the face: a
// rounded side comes to lie on the next one of its many small faces before it has moved far.
bool has_corners_beside(const PlacedConvex& owner, std::uint32_t face, const ContactFeature& facing, double margin,
                        std::vector<std::uint32_t>& low) {
    constexpr std::size_t corners_of_a_box = 8;  // what has no more is no rounded thing
    const Polytope& polytope = owner.shape->polytope;
    if (polytope.vertices.size() <= corners_of_a_box) return false;
    const double level = dot(facing.normal, facing.points[0] - owner.position) + margin;
    const std::span loop(polytope.loops.data() + polytope.faces[face].first, polytope.faces[face].count);
    return has_other_corners(polytope, owner.direction_to_local(facing.normal), level, loop, low);
}

// Whether no corner but those of two crossing edges is within the margin.
bool has_edges_alone(const PolytopeSearch& s, const EdgeAxis& axis, std::vector<std::uint32_t>& low) {
    const Polytope::Edge &a = s.a->edges[axis.edge_a], &b = s.b->edges[axis.edge_b];
    const double reach_a = dot(axis.normal, s.a->vertices[a.from]);
    const double level_b = reach_a - dot(axis.normal, s.b_in_a.position) + s.margin;
    const std::uint32_t ends_a[] = {a.from, a.to}, ends_b[] = {b.from, b.to};
    return !has_other_corners(*s.a, -axis.normal, s.margin - (reach_a + axis.separation), ends_a, low) &&
           !has_other_corners(*s.b, s.b_in_a.direction_to_local(axis.normal), level_b, ends_b, low);
}

// A face of `owner` against the facing feature of the other. `deepest` is the other's point nearest to the face.
void add_face_region(const PlacedConvex& owner, const PlacedConvex& other, const FaceAxis& axis, Vec3 deepest,
                     bool is_face_of_a, double margin, double bias, ContactRegion& region) {
    get_polytope_face(owner, axis.face, region.reference);
    const Vec3 normal = region.reference.normal;
    get_polytope_face(other, farthest(other.shape->polytope.normal_lanes, -other.direction_to_local(normal)).index,
                      region.incident);
    region.normal = is_face_of_a ? normal : -normal;
    add_near_corners(region.reference, other, is_face_of_a, margin, region);
    clip_to_region(region.reference, region.incident, is_face_of_a, 0, margin, region);
    region.has_all_corners = margin <= widest_followed && region.points.size() <= Manifold::max_points &&
                             !has_corners_beside(owner, axis.face, region.incident, margin, region.low);

    // Where they overlap the deepest corner is over the reference face; if they are apart it may be beside it.
    if (axis.separation >= 0) return;
    const Vec3 on_a = is_face_of_a ? deepest - region.normal * axis.separation : deepest;
    keep_deepest(on_a, axis.separation, bias, region);
}

// Where the faces' sides cut everything off though the shapes are within the margin, the nearest points alone.
void add_nearest_points(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory,
                        ContactRegion& region) {
    memory.kind = PairMemory::Kind::nothing;
    const CoreDistance gap = core_distance(Core(a), Core(b), margin);
    if (gap.overlap) {
        const double separation = separation_along(a, b, region.normal);
        region.add(core_support(b, -region.normal) - region.normal * separation, separation, 1);
    } else if (gap.distance > 0) {
        const Vec3 normal = (gap.on_b - gap.on_a) / gap.distance;
        if (gap.distance <= margin) {
            region.normal = normal;
            region.add(gap.on_a, gap.distance, 1);
        } else {
            memory.part_along(normalized(gap.direction), margin);
        }
    }
}

double min_extent(const Convex& convex) {
    const Vec3 size = convex.bounds.size();
    return std::min(size.x, std::min(size.y, size.z));
}

// The vertex of a face that is nearest to a point.
Vec3 nearest_corner(const Polytope& polytope, std::uint32_t face, Vec3 point) {
    const Polytope::Face& f = polytope.faces[face];
    Vec3 best = polytope.vertices[polytope.loops[f.first]];
    for (std::uint32_t i = 1; i < f.count; ++i) {
        const Vec3 corner = polytope.vertices[polytope.loops[f.first + i]];
        if (length_squared(corner - point) < length_squared(best - point)) best = corner;
    }
    return best;
}

}  // namespace

bool collide_polytopes(const ConvexPair& pair, double margin, PairMemory& memory, ContactRegion& region) {
    thread_local PolytopeSearch s;
    s.a = &pair.a->polytope;
    s.b = &pair.b->polytope;
    s.b_in_a = pair.placed_b();
    s.a_in_b = {pair.a, transpose(pair.turn), s.b_in_a.direction_to_local(-pair.place)};
    s.margin = margin;
    using Kind = PairMemory::Kind;
    if (memory.kind == Kind::apart) {
        memory.gap = gap_along(s, memory.axis);
        if (memory.gap > margin) return true;
    }

    // The face of a with the largest gap, beginning with the remembered one.
    const FaceAxis face_a = best_face_axis(*s.a, s.b_in_a, -1e300, s.b_in_a.to_frame(s.b->center),
                                           memory.kind == Kind::face_of_a ? memory.feature_a : none, s);
    if (face_a.separation > margin) {
        memory.part_along(s.a->faces[face_a.face].normal, face_a.separation);
        return true;
    }
    // Faces are preferred by a small bias: they give a region, and the choice does not flicker by rounding.
    const double bias = 1e-4 * std::min(min_extent(*pair.a), min_extent(*pair.b));
    s.heights.resize(s.a->normal_lanes.size());
    const bool is_inside_a = heights_over_faces(*s.a, face_a.witness, s.heights.data()) <= 0;
    Vec3 witness_of_a = is_inside_a ? face_a.witness : nearest_corner(*s.a, face_a.face, face_a.witness);
    witness_of_a = s.a_in_b.to_frame(witness_of_a);
    const FaceAxis face_b = best_face_axis(*s.b, s.a_in_b, face_a.separation + bias, witness_of_a,
                                           memory.kind == Kind::face_of_b ? memory.feature_b : none, s);
    if (face_b.separation > margin && face_b.face != none) {
        memory.part_along(-s.b_in_a.direction_to_frame(s.b->faces[face_b.face].normal), face_b.separation);
        return true;
    }
    const bool is_face_of_a = face_b.face == none;
    const double face_separation = is_face_of_a ? face_a.separation : face_b.separation;
    if (!is_face_of_a) witness_of_a = face_b.witness;

    // An edge pair has to be better by more than the bias.
    EdgeAxis edge;
    const double least = std::min(face_separation + bias + 0.02 * std::fabs(face_separation), margin);
    if (!best_edge_axis(least, face_a.witness, witness_of_a, s, edge)) return false;
    if (edge.separation > margin) {
        memory.part_along(edge.normal, edge.separation);
        return true;
    }
    if (edge.separation > least) {
        memory.kind = Kind::edges;
        region.normal = edge.normal;
        get_edge(pair.placed_a(), edge.edge_a, region.reference);
        get_edge(s.b_in_a, edge.edge_b, region.incident);
        // An edge that lies nearly flat on a face crosses two of its sides.
        thread_local ContactFeature face;
        const bool is_flat =
            span_face(pair.placed_a(), true, region.incident, 0, edge.separation, margin, face, region) ||
            span_face(s.b_in_a, false, region.reference, 0, edge.separation, margin, face, region);
        if (!is_flat) cross_segments(region.reference, region.incident, 0, 0, margin, region);
        region.has_all_corners = !is_flat && margin <= widest_followed && has_edges_alone(s, edge, region.low);
    } else if (is_face_of_a) {
        memory.kind = Kind::face_of_a;
        memory.feature_a = static_cast<std::uint16_t>(face_a.face);
        add_face_region(pair.placed_a(), s.b_in_a, face_a, face_a.witness, true, margin, bias, region);
    } else {
        memory.kind = Kind::face_of_b;
        memory.feature_b = static_cast<std::uint16_t>(face_b.face);
        add_face_region(s.b_in_a, pair.placed_a(), face_b, s.b_in_a.to_frame(face_b.witness), false, margin, bias,
                        region);
    }
    if (region.points.empty()) add_nearest_points(pair.placed_a(), s.b_in_a, margin, memory, region);
    return true;
}

}  // namespace embody::physics::collision
