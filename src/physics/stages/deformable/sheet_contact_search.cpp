// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/sheet_contact_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/definitions/world_settings.h"
#include "physics/deformable/contact/box_grid.h"
#include "physics/deformable/contact/nearest_points.h"

namespace embody::physics::stages {

namespace {

/// One body beside one sheet.
class SheetSearch {
public:
    SheetSearch(const TouchedBody& body, std::uint32_t index, const WorldSettings& settings, ThinDeformable& thin,
                TaskPool& workers)
        : body_(body),
          index_(index),
          settings_(settings.solver.deformable.thin_search),
          time_step_(settings.time_step),
          fall_(length(settings.gravity) * time_step_),
          displacement_(displacement_of(body, time_step_)),
          bounds_(body.shape->bounds(body.start)),
          thin_(thin),
          workers_(workers),
          nodes_(thin.record->nodes()),
          radius_(thin.record->definition.contact_radius) {
        const auto of_body = std::ranges::equal_range(thin.contacts, index, {}, &NodeContact::body);
        planes_ = {of_body.begin(), of_body.end()};
        first_plane_.assign(nodes_.size() + 1, 0);
        for (const NodeContact& plane : planes_) ++first_plane_[plane.node + 1];
        std::partial_sum(first_plane_.begin(), first_plane_.end(), first_plane_.begin());
    }
    void find_edges();
    void find_corners();

private:
    struct NearTriangle {
        std::array<std::uint32_t, 3> node{};
        Bounds box;  // as far as corners are looked for
    };
    [[nodiscard]] std::span<const NodeContact> planes_of(std::uint32_t node) const {
        return std::span(planes_).subspan(first_plane_[node], first_plane_[node + 1] - first_plane_[node]);
    }
    [[nodiscard]] double reach(double speed) const {
        return 2 * radius_ + displacement_ + (speed + fall_) * time_step_;
    }
    [[nodiscard]] double speed(std::uint32_t node) const { return length(nodes_.mean_velocity[node]); }
    [[nodiscard]] bool is_over_same(std::uint32_t a, std::uint32_t b) const;
    void find_edge(std::uint32_t a, std::uint32_t b, double reach, std::vector<Manifold>& manifolds,
                   std::vector<SheetContact>& found) const;
    template <class Found, class Find>
    [[nodiscard]] std::vector<Found> gather(std::size_t count, Find find) const;
    void gather_triangles();
    void find_corner(Vec3 point, Vec3 inside, double radius, std::uint32_t number, const auto& pokes);

    const TouchedBody& body_;
    std::uint32_t index_;
    const ThinSearchSettings& settings_;
    double time_step_, fall_, displacement_;
    Bounds bounds_;
    ThinDeformable& thin_;
    TaskPool& workers_;
    const Nodes& nodes_;
    double radius_;
    std::vector<NodeContact> planes_;         // of nodes with the body, by node
    std::vector<std::uint32_t> first_plane_;  // of each node, one more than nodes
    std::vector<NearTriangle> triangles_;     // that do not lie over one plane
    BoxGrid grid_;
};

// Whether the body cannot poke between two nodes, as each plane of one of them is nearly a plane of the other, too: the
// body lies below both, so it stands out by at most a quarter of the distance between the nodes times the angle between
// the planes.
bool SheetSearch::is_over_same(std::uint32_t a, std::uint32_t b) const {
    const auto of_a = planes_of(a), of_b = planes_of(b);
    if (of_a.empty() || of_b.empty()) return false;
    const double displacement = length(nodes_.position[b] - nodes_.position[a]);
    const double angle =
        std::min(settings_.max_plane_angle, 4 * settings_.max_bulge_radii * radius_ / std::max(displacement, radius_));
    const double cosine = 1 - angle * angle / 2;
    const auto has_twin = [&](const NodeContact& plane, std::span<const NodeContact> others) {
        return std::ranges::any_of(others,
                                   [&](const NodeContact& other) { return dot(plane.normal, other.normal) > cosine; });
    };
    return std::ranges::all_of(of_a, [&](const NodeContact& plane) { return has_twin(plane, of_b); }) &&
           std::ranges::all_of(of_b, [&](const NodeContact& plane) { return has_twin(plane, of_a); });
}

// All that find(range, found) finds, in the order of the ranges.
template <class Found, class Find>
std::vector<Found> SheetSearch::gather(std::size_t count, Find find) const {
    constexpr std::size_t min_parallel_count = 1000;  // edges or triangles
    std::vector<std::vector<Found>> parts(static_cast<std::size_t>(workers_.workers()));
    parallel_for(workers_, count, count >= min_parallel_count,
                 [&](int worker, IndexRange range) { find(range, parts[static_cast<std::size_t>(worker)]); });
    std::vector<Found> all = std::move(parts.front());
    for (std::size_t w = 1; w < parts.size(); ++w) all.insert(all.end(), parts[w].begin(), parts[w].end());
    return all;
}

void SheetSearch::find_edge(std::uint32_t a, std::uint32_t b, double reach, std::vector<Manifold>& manifolds,
                            std::vector<SheetContact>& found) const {
    const Vec3 from = nodes_.position[a], edge = nodes_.position[b] - from;
    const double size = length(edge);
    if (!(size > 0)) return;
    const double end_fraction = settings_.sheet_end_fraction;
    manifolds.clear();
    collide_capsule(from, from + edge, radius_, *body_.shape, body_.start, reach, manifolds);
    for (const Manifold& manifold : manifolds) {
        for (int k = 0; k < manifold.count; ++k) {
            const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(k)];
            const double along = dot(point.position - from, edge) / (size * size);
            if (along < end_fraction || along > 1 - end_fraction) continue;
            const Vec3 normal = -manifold.normal;  // from the body to the sheet
            const Vec3 anchor = from + along * edge - (point.separation + radius_) * normal - body_.start_center;
            found.push_back({{a, b}, {1 - along, along}, 2, {a, b}, {a, index_, anchor, normal, {}}});
        }
    }
}

void SheetSearch::find_edges() {
    const auto edges = thin_.record->cloth()->edges();
    const auto found = gather<SheetContact>(edges.size(), [&](IndexRange range, std::vector<SheetContact>& contacts) {
        std::vector<Manifold> manifolds;
        for (const auto& [a, b] : edges.subspan(range.first, range.last - range.first)) {
            const double far = reach(std::max(speed(a), speed(b)));
            Bounds box;
            box.add(nodes_.position[a]);
            box.add(nodes_.position[b]);
            if (overlaps(enlarged(bounds_, far), box) && !is_over_same(a, b)) find_edge(a, b, far, manifolds, contacts);
        }
    });
    thin_.sheet_contacts.insert(thin_.sheet_contacts.end(), found.begin(), found.end());
}

void SheetSearch::gather_triangles() {
    const auto& triangles = std::get<Cloth>(thin_.record->definition.matter).triangles;
    triangles_ = gather<NearTriangle>(triangles.size(), [&](IndexRange range, std::vector<NearTriangle>& near) {
        for (std::size_t t = range.first; t < range.last; ++t) {
            const auto [a, b, c] = triangles[t];
            Bounds box;
            for (const std::uint32_t node : triangles[t]) box.add(nodes_.position[node]);
            box = enlarged(box, reach(std::max({speed(a), speed(b), speed(c)})));
            if (overlaps(bounds_, box) && !(is_over_same(a, b) && is_over_same(b, c)))
                near.push_back({triangles[t], box});
        }
    });
}

// `inside`: a point of the body well below its surface; `pokes(n, p)`: whether the body stands out at the point as seen
// along the unit vector n and, where the point is beyond the triangle, is there at p on the triangle below it.
void SheetSearch::find_corner(Vec3 point, Vec3 inside, double radius, std::uint32_t number, const auto& pokes) {
    std::vector<std::uint32_t> near;
    grid_.visit(enlarged(Bounds{point, point}, radius), [&](std::uint32_t t) { near.push_back(t); });
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t t : near) {
        const auto& triangle = triangles_[t].node;
        const std::vector<Vec3>& x = nodes_.position;
        const Vec3 a = x[triangle[0]], b = x[triangle[1]], c = x[triangle[2]];
        const auto weight = nearest_weights(point, a, b, c);
        if (std::ranges::min(weight) < settings_.sheet_end_fraction) continue;
        const Vec3 place = weight[0] * a + weight[1] * b + weight[2] * c;
        Vec3 normal = normalized(cross(b - a, c - a));
        if (dot(normal, (radius > 0 ? place : point) - inside) < 0) normal = -normal;
        if (!pokes(normal, place)) continue;
        const Vec3 anchor = point + radius * normal - body_.start_center;
        thin_.sheet_contacts.push_back({triangle, weight, 3, {no_node, number}, {0, index_, anchor, normal, {}}});
    }
}

// Whether the piece, at its corner v, pokes into a sheet of that normal in its own frame: all that is around the corner
// lies below it, and where the sheet is below the corner, the piece is in it at `place`: else the sheet is on the
// piece's other side, or beside it.
bool pokes_at(const Polytope& polytope, std::uint32_t v, Vec3 normal, Vec3 place, double corner_cosine) {
    const Vec3 corner = polytope.vertices[v];
    return std::ranges::all_of(polytope.neighbours(v),
                               [&](std::uint32_t other) {
                                   const Vec3 edge = polytope.vertices[other] - corner;
                                   return dot(edge, normal) <= corner_cosine * length(edge);
                               }) &&
           (dot(normal, corner - place) <= 0 || std::ranges::all_of(polytope.faces, [&](const Polytope::Face& face) {
                return dot(face.normal, place) <= face.offset;
            }));
}

void SheetSearch::find_corners() {
    constexpr std::uint32_t max_corners = 1u << 16;  // of a piece
    gather_triangles();
    if (triangles_.empty()) return;
    std::vector<Bounds> boxes;
    for (const NearTriangle& triangle : triangles_) boxes.push_back(triangle.box);
    grid_.fill(boxes, thin_.record->cloth()->edge_length());
    const std::vector<ConvexPiece>& pieces = body_.shape->data().pieces;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const PlacedConvex piece = place(pieces[p], body_.start, {});
        const Convex& convex = *piece.shape;
        if (convex.kind == ConvexKind::sphere) {
            // Larger balls touch edges first.
            if (convex.radius < thin_.record->cloth()->edge_length())
                find_corner(piece.position, piece.position, convex.radius, p * max_corners,
                            [](Vec3, Vec3) { return true; });
            continue;
        }
        const Polytope& polytope = convex.polytope;
        for (std::uint32_t v = 0; v < polytope.vertices.size(); ++v) {
            find_corner(piece.to_frame(polytope.vertices[v]), interior_point(piece), 0, p * max_corners + v,
                        [&](Vec3 normal, Vec3 at) {
                            return pokes_at(polytope, v, piece.direction_to_local(normal), piece.to_local(at),
                                            settings_.corner_cosine);
                        });
        }
    }
}

}  // namespace

void find_sheet_contacts(std::span<const TouchedBody> bodies, const std::vector<bool>& may_collide,
                         const WorldSettings& settings, ThinDeformable& thin, TaskPool& workers) {
    const double time_step = settings.time_step;
    const Nodes& nodes = thin.record->nodes();
    Bounds sheet;
    double fastest = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        sheet.add(nodes.position[i]);
        fastest = std::max(fastest, length(nodes.mean_velocity[i]));
    }
    const double own_reach =
        2 * thin.record->definition.contact_radius + (fastest + length(settings.gravity) * time_step) * time_step;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        // The contacts of nodes suffice for a plane.
        if (!may_collide[b] || std::holds_alternative<PlaneShape>(bodies[b].shape->definition())) continue;
        const double reach = own_reach + displacement_of(bodies[b], time_step);
        if (!overlaps(enlarged(bodies[b].shape->bounds(bodies[b].start), reach), sheet)) continue;
        SheetSearch search(bodies[b], b, settings, thin, workers);
        search.find_edges();
        search.find_corners();
    }
}

}  // namespace embody::physics::stages
