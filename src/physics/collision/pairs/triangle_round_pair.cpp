// SPDX-License-Identifier: MIT
// Convexes with round sides against one triangle of a surface, in the convex's frame: a sphere by the nearest point;
// others along the triangle's own normal, where that is the best one, else by GJK and EPA as any pair of convexes.
#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/round_features.h"
#include "physics/collision/pairs/triangle_pairs.h"
#include "physics/collision/queries/ball_touch.h"

namespace embody::physics::collision {

namespace {

void collide_sphere_triangle(double radius, const PlacedTriangle& t, double margin, ContactRegion& region) {
    const Vec3 nearest = t.nearest_to({});
    const double gap = length(nearest);
    if (gap - radius > margin) return;
    Vec3 outwards = normalized(-nearest, t.normal);
    if (!t.is_flat_to(outwards) && t.leans_too_far(outwards, nearest)) return;
    if (t.is_flat_to(outwards)) outwards = t.normal;
    region.normal = -outwards;
    region.add(outwards * -radius, gap - radius, 0);
    static const double smooth_cosine = std::cos(smooth_edge_angle);
    region.is_on_edge = dot(outwards, t.normal) < smooth_cosine;
}

// Tests against the plane of the triangle, clipped to the triangle.
void collide_along_normal(const PlacedConvex& convex, const PlacedTriangle& t, double margin, ContactRegion& region) {
    thread_local ContactFeature face, facing;
    region.normal = -t.normal;
    face.clear();
    face.normal = t.normal;
    face.points.assign(t.corners.begin(), t.corners.end());
    get_facing(convex, -t.normal, facing);
    clip_to_region(face, facing, false, rounding(*convex.shape), margin, region);

    // The lowest point is lost where a rim's polygon falls short of it, or in the wedge between two prisms.
    for (std::size_t i = 0; i < 3; ++i) {
        if (PrismSide(t, i).beyond(t.lowest) > 0) return;
    }
    keep_deepest(t.lowest, t.height, 1e-6 * convex.shape->reach, region);
}

}  // namespace

void collide_round_triangle(const Convex& convex, const PlacedTriangle& t, double margin, ContactRegion& region) {
    if (convex.kind == ConvexKind::sphere) {
        collide_sphere_triangle(convex.radius, t, margin, region);
        return;
    }
    const PlacedConvex placed{&convex, {}, {}};
    if (t.normal_is_best()) {
        collide_along_normal(placed, t, margin, region);
        return;
    }
    // An edge where the surface bends away: the best normal of all, if it belongs to this triangle.
    thread_local Convex flat{ConvexKind::polytope, 0, 0, triangle_polytope({}, {1, 0, 0}, {0, 0, 1}), {}};
    set_triangle(flat.polytope, t.corners[0], t.corners[1], t.corners[2]);
    flat.bounds = {};
    for (const Vec3& p : t.corners) flat.bounds.add(p);
    PairMemory nothing;
    collide_round(placed, {&flat, {}, {}}, margin, nothing, region);
    if (region.points.empty()) return;
    const auto deepest = std::min_element(region.points.begin(), region.points.end(),
                                          [](const auto& p, const auto& q) { return p.separation < q.separation; });
    const Vec3 on_triangle = t.nearest_to(deepest->position);
    if (!t.is_flat_to(-region.normal) && !t.leans_too_far(-region.normal, on_triangle)) return;
    region.points.clear();
    collide_along_normal(placed, t, margin, region);
}

}  // namespace embody::physics::collision
