// SPDX-License-Identifier: MIT
#include "physics/stages/touch/reachable_points.h"

#include <algorithm>

#include "physics/collision/shapes/collision_shape_data.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

// Velocity of the surface's place (not of its matter) at a point of the piece: turning about the axis of a rolling body
// moves none.
Vec3 surface_velocity(const TouchAccess& world, std::uint32_t body, std::uint32_t piece, bool is_round, Vec3 point) {
    const BodyState& state = world.rigid.motion[body];
    const Vec3 velocity = velocity_at(state, point - state.center);
    if (!is_round) return velocity;
    const ConvexPiece& part = world.rigid.record(body).shape->data().pieces[piece];
    const Transform pose = world.rigid.pose(body) * part.local;
    const Vec3 axis = rotate(pose.rotation, {0, 1, 0});
    const Vec3 rolling =
        part.convex.kind == ConvexKind::sphere ? state.angular_velocity : axis * dot(state.angular_velocity, axis);
    return velocity - cross(rolling, point - pose.position);
}

}  // namespace

double leave_out_unreachable(const TouchAccess& world, const BroadPhase::Pair& pair, std::vector<Manifold>& manifolds) {
    const CollisionSettings& settings = world.settings.solver.collision;
    double least = 1e300;
    for (Manifold& manifold : manifolds) {
        if (manifold.count < 2 || !(manifold.a_is_round || manifold.b_is_round)) continue;
        double limit = settings.contact_margin;
        if (manifold.a_is_round)
            limit = std::min(limit, settings.rim_reach_fraction * world.rigid.record(pair.a).reach);
        if (manifold.b_is_round)
            limit = std::min(limit, settings.rim_reach_fraction * world.rigid.record(pair.b).reach);
        const auto first = manifold.points.begin(), end = first + manifold.count;
        const auto deepest = std::min_element(
            first, end, [](const ManifoldPoint& p, const ManifoldPoint& q) { return p.separation < q.separation; });
        std::iter_swap(first, deepest);
        const auto is_out_of_reach = [&](const ManifoldPoint& point) {
            const Vec3 a = surface_velocity(world, pair.a, manifold.piece_a, manifold.a_is_round, point.position);
            const Vec3 b = surface_velocity(world, pair.b, manifold.piece_b, manifold.b_is_round, point.position);
            const double approach = std::max(0.0, dot(manifold.normal, a - b));
            if (point.separation - approach * world.settings.time_step <= limit) return false;
            least = std::min(least, point.separation);
            return true;
        };
        manifold.count = static_cast<int>(std::remove_if(first + 1, end, is_out_of_reach) - first);
    }
    return least;
}

}  // namespace embody::physics::stages
