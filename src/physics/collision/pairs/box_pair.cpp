// SPDX-License-Identifier: MIT
// Two boxes: the fifteen separating axes in the frame of the first (S. Gottschalk, M. Lin, D. Manocha, "OBBTree",
// 1996), then the incident face clipped by the reference face's rectangle, in two dimensions.
#include "physics/collision/pairs/box_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "physics/collision/pairs/choose_four.h"
#include "physics/collision/pairs/round_features.h"

namespace embody::physics::collision {

namespace {

using Triple = std::array<double, 3>;
using Rows = std::array<Triple, 3>;

Triple triple(Vec3 v) { return {v.x, v.y, v.z}; }

/// The second box as the first one sees it, by components.
struct BoxView {
    Triple half_a, half_b;
    Rows turn, steep;  ///< turn[i][j]: component i (in a's frame) of b's axis j; steep: without signs
    Triple place;      ///< b's centre
};

BoxView view_of(const ConvexPair& pair) {
    BoxView v;
    v.half_a = triple(pair.a->bounds.upper);
    v.half_b = triple(pair.b->bounds.upper);
    const Triple columns[3] = {triple(pair.turn.x), triple(pair.turn.y), triple(pair.turn.z)};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            v.turn[i][j] = columns[j][i];
            v.steep[i][j] = std::fabs(columns[j][i]);
        }
    }
    v.place = triple(pair.place);
    return v;
}

/// The same two boxes as seen by the second.
BoxView seen_from_b(const BoxView& v) {
    BoxView w;
    w.half_a = v.half_b;
    w.half_b = v.half_a;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            w.turn[i][j] = v.turn[j][i];
            w.steep[i][j] = v.steep[j][i];
        }
        w.place[i] = -(v.turn[0][i] * v.place[0] + v.turn[1][i] * v.place[1] + v.turn[2][i] * v.place[2]);
    }
    return w;
}

/// The best of the face normals of one box: which axis, on which side the other box is, and the gap along it.
struct FaceAxis {
    double separation = -1e300;
    std::size_t axis = 0;
    double side = 1;
};

FaceAxis best_face(const BoxView& v) {
    FaceAxis best;
    for (std::size_t i = 0; i < 3; ++i) {
        const double reach_b = v.steep[i][0] * v.half_b[0] + v.steep[i][1] * v.half_b[1] + v.steep[i][2] * v.half_b[2];
        const double separation = std::fabs(v.place[i]) - v.half_a[i] - reach_b;
        if (separation > best.separation) best = {separation, i, v.place[i] < 0 ? -1.0 : 1.0};
    }
    return best;
}

struct EdgeAxis {
    double separation = -1e300;
    std::size_t axis_a = 0, axis_b = 0;
    Vec3 normal;  ///< unit, from a to b, in a's frame
};

// Cross products of axis i of a (a unit vector) and axis j of b. Nearly parallel edges have no axis of their own: a
// face has nearly the same.
EdgeAxis best_edge(const BoxView& v, double least) {
    EdgeAxis best;
    best.separation = least;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t j1 = j == 2 ? 0 : j + 1, j2 = j == 0 ? 2 : j - 1;
            const double along = v.place[i2] * v.turn[i1][j] - v.place[i1] * v.turn[i2][j];
            const double reach = v.half_a[i1] * v.steep[i2][j] + v.half_a[i2] * v.steep[i1][j] +
                                 v.half_b[j1] * v.steep[i][j2] + v.half_b[j2] * v.steep[i][j1];
            // Not yet divided by the sine, which only makes an overlap larger.
            const double gap = std::fabs(along) - reach;
            if (gap <= 0 && gap <= best.separation) continue;
            const double sine_squared = v.turn[i1][j] * v.turn[i1][j] + v.turn[i2][j] * v.turn[i2][j];
            if (sine_squared < 1e-12) continue;
            const double scale = 1 / std::sqrt(sine_squared);
            if (gap * scale <= best.separation) continue;
            const double sign = along < 0 ? -scale : scale;
            Triple n{};
            n[i1] = -v.turn[i2][j] * sign;
            n[i2] = v.turn[i1][j] * sign;
            best = {gap * scale, i, j, {n[0], n[1], n[2]}};
        }
    }
    return best;
}

/// A corner of the incident face while it is clipped: in the reference face's plane, its height over it, and the edges
/// that meet there (0-3 the incident's, 4-7 the reference's).
struct FaceCorner {
    double x, y, height;
    std::uint32_t edge_in, edge_out;
};
constexpr std::size_t max_corners = 8;  // of a rectangle cut by a rectangle
struct ClipPolygon {
    std::array<FaceCorner, max_corners + 1> corners;
    int count = 0;

    void add(const FaceCorner& c) {
        if (static_cast<std::size_t>(count) < corners.size()) corners[static_cast<std::size_t>(count++)] = c;
    }
};

// Keeps what lies on the inner side of one of the four lines x or y = +-limit.
template <bool along_x>
void clip_side(const ClipPolygon& from, double sign, double limit, std::uint32_t name, ClipPolygon& to) {
    const auto beyond = [&](const FaceCorner& c) { return sign * (along_x ? c.x : c.y) - limit; };
    to.count = 0;
    const FaceCorner* u = &from.corners[static_cast<std::size_t>(from.count - 1)];
    double out_u = beyond(*u);
    for (int i = 0; i < from.count; ++i) {
        const FaceCorner* v = &from.corners[static_cast<std::size_t>(i)];
        const double out_v = beyond(*v);
        if ((out_u <= 0) != (out_v <= 0)) {
            const double t = out_u / (out_u - out_v);
            const FaceCorner c{u->x + (v->x - u->x) * t, u->y + (v->y - u->y) * t,
                               u->height + (v->height - u->height) * t, out_u <= 0 ? u->edge_out : name,
                               out_u <= 0 ? name : u->edge_out};
            to.add(c);
        }
        if (out_v <= 0) to.add(*v);
        u = v;
        out_u = out_v;
    }
}

/// A reference face and the face of the other box that faces it.
struct FaceContact {
    std::size_t axis = 0, across = 0, up = 0;  ///< of the reference box: normal, x and y of the plane
    double side = 1;
    std::uint32_t name = 0;  ///< of reference and incident face
    ClipPolygon polygon;
};

// The four corners of the other box's face that faces the reference most, in the reference's plane.
void place_incident(const BoxView& v, FaceContact& f) {
    const Triple& normal_row = v.steep[f.axis];
    const std::size_t m = normal_row[0] >= normal_row[1] ? (normal_row[0] >= normal_row[2] ? 0u : 2u)
                                                         : (normal_row[1] >= normal_row[2] ? 1u : 2u);
    const std::size_t p = m == 2 ? 0 : m + 1, q = m == 0 ? 2 : m - 1;
    const bool is_upper = f.side * v.turn[f.axis][m] < 0;
    const double to_face = is_upper ? v.half_b[m] : -v.half_b[m];
    f.name |= static_cast<std::uint32_t>(2 * m + (is_upper ? 1u : 0u)) << 6;

    // Centre of the face and the two half edges from there, by components across, up, and outwards.
    const auto component = [&](std::size_t row, double sign, double& centre, double& along_p, double& along_q) {
        centre = sign * (v.place[row] + v.turn[row][m] * to_face);
        along_p = sign * v.turn[row][p] * v.half_b[p];
        along_q = sign * v.turn[row][q] * v.half_b[q];
    };
    double cx = 0, px = 0, qx = 0, cy = 0, py = 0, qy = 0, ch = 0, ph = 0, qh = 0;
    component(f.across, 1, cx, px, qx);
    component(f.up, 1, cy, py, qy);
    component(f.axis, f.side, ch, ph, qh);
    ch -= v.half_a[f.axis];
    f.polygon.corners[0] = {cx + px + qx, cy + py + qy, ch + ph + qh, 3, 0};
    f.polygon.corners[1] = {cx - px + qx, cy - py + qy, ch - ph + qh, 0, 1};
    f.polygon.corners[2] = {cx - px - qx, cy - py - qy, ch - ph - qh, 1, 2};
    f.polygon.corners[3] = {cx + px - qx, cy + py - qy, ch + ph - qh, 2, 3};
    f.polygon.count = 4;
}

// Clips by those of the four sides that a corner lies beyond; a tiny slack keeps corners that lie on a side.
void clip_incident(const BoxView& v, FaceContact& f) {
    const double half_x = v.half_a[f.across], half_y = v.half_a[f.up];
    const double slack = 2e-9 * (half_x + half_y);
    double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
    for (std::size_t i = 0; i < 4; ++i) {
        low_x = std::min(low_x, f.polygon.corners[i].x);
        high_x = std::max(high_x, f.polygon.corners[i].x);
        low_y = std::min(low_y, f.polygon.corners[i].y);
        high_y = std::max(high_y, f.polygon.corners[i].y);
    }
    ClipPolygon other;
    ClipPolygon *from = &f.polygon, *to = &other;
    const auto keep = [&] { std::swap(from, to); };
    if (high_x > half_x + slack) clip_side<true>(*from, 1, half_x + slack, 4, *to), keep();
    if (low_x < -half_x - slack && from->count > 0) clip_side<true>(*from, -1, half_x + slack, 5, *to), keep();
    if (high_y > half_y + slack && from->count > 0) clip_side<false>(*from, 1, half_y + slack, 6, *to), keep();
    if (low_y < -half_y - slack && from->count > 0) clip_side<false>(*from, -1, half_y + slack, 7, *to), keep();
    if (from != &f.polygon) f.polygon = other;
}

constexpr std::uint32_t box_tag = 1u << 16, of_b_tag = 1u << 15;

// Where the boxes overlap the deepest corner belongs to the region even where it lies beside the reference face.
FaceCorner deepest_corner(const BoxView& v, const FaceContact& f, double separation) {
    FaceCorner c{v.place[f.across], v.place[f.up], separation, 0, 0};
    for (std::size_t j = 0; j < 3; ++j) {
        const double s = f.side * v.turn[f.axis][j] < 0 ? v.half_b[j] : -v.half_b[j];
        c.x += v.turn[f.across][j] * s;
        c.y += v.turn[f.up][j] * s;
    }
    return c;
}

/// Points of a region on the reference face, and their names.
struct FaceRegion {
    std::array<FlatPoint, max_corners + 2> points;
    std::array<std::uint32_t, max_corners + 2> names{};
    int count = 0;

    void add(const FaceCorner& c, std::uint32_t name) {
        points[static_cast<std::size_t>(count)] = {c.x, c.y, c.height};
        names[static_cast<std::size_t>(count++)] = name;
    }
    // Four corners, none of them close to the line of its neighbours: the whole region is kept as it is.
    [[nodiscard]] bool is_proper_quad(double size) const {
        if (count != 4) return false;
        for (std::size_t i = 0; i < 4; ++i) {
            const FlatPoint &p = points[i], &q = points[(i + 1) % 4], &r = points[(i + 2) % 4];
            const double turn = (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x);
            if (std::fabs(turn) < 1e-3 * size * size) return false;
        }
        return true;
    }
};

// `reference` places the reference box in the manifold's axes.
void fill_face_manifold(const BoxView& v, const FaceAxis& face, bool is_face_of_a, double bias, double margin,
                        const PlacedConvex& reference, Manifold& manifold) {
    FaceContact f;
    f.axis = face.axis;
    f.across = f.axis == 2 ? 0 : f.axis + 1;
    f.up = f.axis == 0 ? 2 : f.axis - 1;
    f.side = face.side;
    f.name =
        box_tag | (is_face_of_a ? 0u : of_b_tag) | static_cast<std::uint32_t>(2 * f.axis + (f.side > 0 ? 1u : 0u)) << 9;
    place_incident(v, f);
    clip_incident(v, f);

    // Corners within the margin, and the deepest corner.
    FaceRegion region;
    bool has_deepest = face.separation >= 0;
    for (int i = 0; i < f.polygon.count; ++i) {
        const FaceCorner& c = f.polygon.corners[static_cast<std::size_t>(i)];
        if (c.height > margin) continue;
        has_deepest = has_deepest || c.height <= face.separation + bias;
        region.add(c, f.name | c.edge_in << 3 | c.edge_out);
    }
    if (!has_deepest) region.add(deepest_corner(v, f, face.separation), box_tag);

    // Adds at most four points, midway between the two surfaces.
    const auto put = [&](int i) {
        const FlatPoint& p = region.points[static_cast<std::size_t>(i)];
        Triple at{};
        at[f.across] = p.x;
        at[f.up] = p.y;
        at[f.axis] = f.side * (v.half_a[f.axis] + 0.5 * p.separation);
        manifold.points[static_cast<std::size_t>(manifold.count++)] = {
            reference.to_frame({at[0], at[1], at[2]}), p.separation, region.names[static_cast<std::size_t>(i)]};
    };
    manifold.normal = reference.rotation.column(static_cast<int>(f.axis)) * (is_face_of_a ? f.side : -f.side);
    if (region.is_proper_quad(std::min(v.half_b[0], std::min(v.half_b[1], v.half_b[2])))) {
        for (int i = 0; i < 4; ++i) put(i);
        manifold.is_whole = true;
    } else {
        const ChosenPoints chosen = choose_four(region.points.data(), region.count);
        for (int k = 0; k < chosen.count; ++k) put(chosen.index[static_cast<std::size_t>(k)]);
    }
}

// The point where two edges cross; false where they are parallel, or pass each other beyond an end and another feature
// is nearer.
bool fill_edge_manifold(const BoxView& v, const EdgeAxis& edge, const ConvexPair& pair, Manifold& manifold) {
    // The edge of each box that lies farthest along the normal, through these middles.
    const Triple n = triple(edge.normal);
    Triple middle_a{}, middle_b = v.place, along_b{};
    std::uint32_t name = box_tag | of_b_tag << 2 | static_cast<std::uint32_t>(3 * edge.axis_a + edge.axis_b) << 6;
    for (std::size_t k = 0; k < 3; ++k) {
        const double towards_b = v.turn[0][k] * n[0] + v.turn[1][k] * n[1] + v.turn[2][k] * n[2];
        if (k != edge.axis_a) middle_a[k] = n[k] > 0 ? v.half_a[k] : -v.half_a[k];
        if (k != edge.axis_a && n[k] > 0) name |= 1u << k;
        const double s = k == edge.axis_b ? 0 : towards_b > 0 ? -v.half_b[k] : v.half_b[k];
        if (k != edge.axis_b && towards_b > 0) name |= 8u << k;
        for (std::size_t i = 0; i < 3; ++i) middle_b[i] += v.turn[i][k] * s;
        along_b[k] = v.turn[k][edge.axis_b];
    }

    // Nearest points of the two lines: from each middle along its edge, in metres.
    const Triple w{middle_a[0] - middle_b[0], middle_a[1] - middle_b[1], middle_a[2] - middle_b[2]};
    const double cosine = along_b[edge.axis_a], du = w[edge.axis_a];
    const double dv = w[0] * along_b[0] + w[1] * along_b[1] + w[2] * along_b[2];
    const double whole = 1 - cosine * cosine;
    const double s = (cosine * dv - du) / whole, t = (dv - cosine * du) / whole;
    const double half_s = v.half_a[edge.axis_a], half_t = v.half_b[edge.axis_b];
    if (whole < 1e-4) return false;
    if (edge.separation > 0 && (std::fabs(s) > half_s || std::fabs(t) > half_t)) return false;

    middle_a[edge.axis_a] += std::clamp(s, -half_s, half_s);
    const double t_kept = std::clamp(t, -half_t, half_t);
    Vec3 halfway;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        halfway[i] = 0.5 * (middle_a[k] + middle_b[k] + along_b[k] * t_kept);
    }
    manifold.normal = pair.turn_a * edge.normal;
    manifold.points[0] = {pair.turn_a * halfway, edge.separation, name};
    manifold.count = 1;
    return true;
}

// The face of the view's own box whose normal an edge's normal (own axes, towards the other) is close to, if that
// edge lies nearly flat on it: then it crosses two of the face's sides (round_features.h: span_face).
std::optional<FaceAxis> flat_face(Vec3 normal) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double along = normal[static_cast<int>(k)];
        if (std::fabs(along) > min_span_cosine)
            return FaceAxis{.separation = 0, .axis = k, .side = along > 0 ? 1.0 : -1.0};
    }
    return std::nullopt;
}

// Builds the face's region along the edges' normal; true if it has the depth of the edges, at more than one point.
bool spans(const EdgeAxis& edge, Vec3 normal, Manifold& manifold) {
    const double cosine = std::fabs(dot(manifold.normal, normal));
    double deepest = 1e300;
    for (int i = 0; i < manifold.count; ++i) {
        double& separation = manifold.points[static_cast<std::size_t>(i)].separation;
        separation *= cosine;
        deepest = std::min(deepest, separation);
    }
    manifold.normal = normal;
    return manifold.count > 1 && is_span(deepest, edge.separation);
}

// The gap between the boxes along a direction.
double gap_along(const BoxView& v, Vec3 direction) {
    const Triple n = triple(direction);
    double gap = n[0] * v.place[0] + n[1] * v.place[1] + n[2] * v.place[2];
    for (std::size_t j = 0; j < 3; ++j) {
        const double along_b = n[0] * v.turn[0][j] + n[1] * v.turn[1][j] + n[2] * v.turn[2][j];
        gap -= std::fabs(n[j]) * v.half_a[j] + std::fabs(along_b) * v.half_b[j];
    }
    return gap;
}

Vec3 axis_of(const FaceAxis& face) {
    Triple n{};
    n[face.axis] = face.side;
    return {n[0], n[1], n[2]};
}

}  // namespace

BoxMeeting collide_boxes(const ConvexPair& pair, double margin, PairMemory& memory, Manifold& manifold) {
    const BoxView v = view_of(pair);
    if (memory.kind == PairMemory::Kind::apart) {
        memory.gap = gap_along(v, memory.axis);
        if (memory.gap > margin) return BoxMeeting::none;
    }

    // Faces of a, faces of b, then edges with a larger gap than these.
    const FaceAxis face_a = best_face(v);
    if (face_a.separation > margin) {
        memory.part_along(axis_of(face_a), face_a.separation);
        return BoxMeeting::none;
    }
    const BoxView w = seen_from_b(v);
    const FaceAxis face_b = best_face(w);
    if (face_b.separation > margin) {
        memory.part_along(pair.turn * -axis_of(face_b), face_b.separation);
        return BoxMeeting::none;
    }
    // Faces are preferred by a small bias: they give a region, and the choice does not flicker by rounding.
    const double bias = 1e-4 *
                        std::min(std::min(v.half_a[0], std::min(v.half_a[1], v.half_a[2])),
                                 std::min(v.half_b[0], std::min(v.half_b[1], v.half_b[2]))) *
                        2;
    const double face_separation = std::max(face_a.separation, face_b.separation);
    const double least = face_separation + bias + 0.02 * std::fabs(face_separation);
    const EdgeAxis edge = best_edge(v, std::min(least, margin));
    if (edge.separation > margin) {
        memory.part_along(edge.normal, edge.separation);
        return BoxMeeting::none;
    }
    memory.kind = PairMemory::Kind::nothing;
    if (edge.separation > least) {
        if (const auto face = flat_face(edge.normal)) {
            fill_face_manifold(v, *face, true, bias, margin, {nullptr, pair.turn_a, {}}, manifold);
            if (spans(edge, pair.turn_a * edge.normal, manifold)) return BoxMeeting::region;
            manifold = {};
        }
        if (const auto face = flat_face(transpose(pair.turn) * -edge.normal)) {
            fill_face_manifold(w, *face, false, bias, margin, {nullptr, pair.turn_b, pair.apart}, manifold);
            if (spans(edge, pair.turn_a * edge.normal, manifold)) return BoxMeeting::region;
            manifold = {};
        }
        return fill_edge_manifold(v, edge, pair, manifold) ? BoxMeeting::region : BoxMeeting::undecided;
    }
    if (face_b.separation <= face_a.separation + bias) {
        fill_face_manifold(v, face_a, true, bias, margin, {nullptr, pair.turn_a, {}}, manifold);
    } else {
        fill_face_manifold(w, face_b, false, bias, margin, {nullptr, pair.turn_b, pair.apart}, manifold);
    }
    return manifold.count > 0 ? BoxMeeting::region : BoxMeeting::undecided;
}

}  // namespace embody::physics::collision
