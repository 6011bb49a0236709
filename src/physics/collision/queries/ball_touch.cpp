// SPDX-License-Identifier: MIT
#include "physics/collision/queries/ball_touch.h"

#include <cmath>

#include "physics/collision/pairs/round_features.h"
#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/collision/shapes/near_triangles.h"
#include "physics/collision/shapes/placed_triangle.h"

namespace embody::physics::collision {

namespace {

constexpr double same_normal = 1 - 1e-9;  // cosine

// The triangle as seen from the ball's centre.
PlacedTriangle place_triangle(const std::array<Vec3, 3>& corners, Vec3 normal, Vec3 center) {
    PlacedTriangle t;
    t.normal = normal;
    for (std::size_t i = 0; i < 3; ++i) t.corners[i] = corners[i] - center;
    for (std::size_t i = 0; i < 3; ++i) t.outward[i] = normalized(cross(t.along(i), normal));
    return t;
}

// The shape operator of a triangle by the normals midway over its edges, each the mean of the two faces': linear over
// the triangle, with the gradient  Σ 2 tan(angle/2) / height · o oᵀ,  o across the edge. Source: E. Grinspun et al.,
// "Computing discrete shape operators on general meshes", 2006. Real edges and the surface's end have none.
void add_curvature(const PlacedTriangle& t, const std::array<float, 3>& half_dihedrals, BallTouch& touch) {
    static const double most = std::tan(smooth_edge_angle / 2);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto half = static_cast<double>(half_dihedrals[i]);
        const double height = -t.beyond(i, t.corners[i == 0 ? 2 : i - 1]);
        if (!(std::fabs(half) <= most) || !(height > 0)) continue;
        touch.shape_operator += outer(t.outward[i], t.outward[i]) * (2 * half / height);
    }
}

// Whether the place lies on an edge where the surface is not smooth.
bool is_on_real_edge(const PlacedTriangle& t, const std::array<float, 3>& half_dihedrals, Vec3 nearest) {
    static const double most = std::tan(smooth_edge_angle / 2);
    constexpr double on_edge = 1e-6;  // in shares of the edge's length
    for (std::size_t i = 0; i < 3; ++i) {
        const bool is_real = !(static_cast<double>(half_dihedrals[i]) <= most);
        if (is_real && t.beyond(i, nearest) > -on_edge * length(t.along(i))) return true;
    }
    return false;
}

// Like the sphere's contact with a triangle (triangle_round_pair.cpp).
void touch_triangle(const TriangleSurface& surface, const NearTriangle& near, Vec3 center, double radius, double margin,
                    std::vector<BallTouch>& touches) {
    const Vec3 across = cross(near.corners[1] - near.corners[0], near.corners[2] - near.corners[0]);
    if (!(dot(center - near.corners[0], across) > 0)) return;
    PlacedTriangle t = place_triangle(near.corners, normalized(across), center);
    const Vec3 nearest = t.nearest_to({});
    const double gap = length(nearest) - radius;
    if (gap > margin) return;
    t.half_dihedrals = surface.half_dihedrals(near.index);
    BallTouch touch{.normal = normalized(-nearest, t.normal), .gap = gap};
    const bool is_flat = t.is_flat_to(touch.normal);
    if (!is_flat && t.leans_too_far(touch.normal, nearest)) return;
    if (is_flat) touch.normal = t.normal;
    touch.is_flat = is_flat;
    const auto& dihedrals = surface.signed_half_dihedrals(near.index);
    touch.knows_curvature = is_flat || !is_on_real_edge(t, dihedrals, nearest);
    if (touch.knows_curvature) add_curvature(t, dihedrals, touch);
    touches.push_back(touch);
}

void touch_surface(const TriangleSurface& surface, const Transform& pose, double radius, Vec3 center, double margin,
                   std::vector<BallTouch>& touches) {
    thread_local std::vector<std::uint32_t> found;
    thread_local std::vector<NearTriangle> near;
    const Vec3 own = inverse_transform_point(pose, center);
    const double reach = radius + margin;
    found.clear();
    near.clear();
    surface.find(Bounds{own - Vec3{reach, reach, reach}, own + Vec3{reach, reach, reach}}, found);
    find_near_triangles(surface, found, own, reach, near);
    const Mat3 turn = to_matrix(pose.rotation), back = transpose(turn);
    for (const NearTriangle& triangle : near) {
        const std::size_t before = touches.size();
        touch_triangle(surface, triangle, own, radius, margin, touches);
        if (touches.size() == before) continue;
        BallTouch& touch = touches.back();
        touch.normal = turn * touch.normal;
        touch.shape_operator = turn * touch.shape_operator * back;
    }
}

}  // namespace

void find_ball_touches(const CollisionShape& ball, double radius, Vec3 center, const CollisionShape& ground,
                       const Transform& pose, double margin, std::vector<BallTouch>& touches) {
    const CollisionShape::Data& data = ground.data();
    if (data.surface) return touch_surface(*data.surface, pose, radius, center, margin, touches);
    thread_local std::vector<Manifold> manifolds;
    manifolds.clear();
    collide(ball, {center, {}}, ground, pose, margin, manifolds);
    for (const Manifold& manifold : manifolds) {
        const Vec3 up = -manifold.normal;
        const bool is_flat =
            data.is_plane ||
            has_aligned_face(place(data.pieces[manifold.piece_b], pose, pose.position), up, same_normal);
        touches.push_back({.normal = up, .gap = manifold.points[0].separation, .is_flat = is_flat});
    }
}

}  // namespace embody::physics::collision
