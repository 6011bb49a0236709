// SPDX-License-Identifier: MIT
#include "scene/embody/wall_joints.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/shape_bounds.h"

namespace embody::scene {

namespace {

// A wall as seen from the point where it meets others, in the plane of x and z.
struct Spoke {
    const WallEnd* end = nullptr;
    double x = 0, z = 0;  // unit, into the wall
    double half = 0;      // thickness
    double angle = 0;
};

Spoke spoke_of(const WallEnd& end) {
    Vec3 into = rotate(end.pose.rotation, {1, 0, 0});
    if (end.is_end) into = -into;
    return {&end, into.x, into.z, end.wall->thickness / 2, std::atan2(into.z, into.x)};
}

// The face toward growing angles is the one at +Z of a wall that starts here, and the one at -Z of one that ends here.
void put_cut(const Spoke& spoke, bool is_toward_next, double cut) {
    auto& cuts = spoke.end->is_end ? spoke.end->wall->end_cut : spoke.end->wall->start_cut;
    cuts[is_toward_next != spoke.end->is_end ? 1 : 0] = cut;
}

// Where the face of `a` toward `b` meets the face of `b` toward `a`.
void join(const Spoke& a, const Spoke& b) {
    // Sines: walls nearer to one line have no corner, those of different thickness from 8° on.
    constexpr double straightest = 1e-9, straightest_step = 0.14;
    constexpr double longest = 3;  // of both thicknesses
    constexpr double most = 0.45;  // of a wall
    const double across = a.x * b.z - a.z * b.x;
    double cut_a = 0, cut_b = 0;
    if (std::fabs(across) > (std::fabs(a.half - b.half) < joint_reach ? straightest : straightest_step)) {
        const double vx = b.half * b.z + a.half * a.z, vz = -b.half * b.x - a.half * a.x;
        cut_a = (vx * b.z - vz * b.x) / across;
        cut_b = (vx * a.z - vz * a.x) / across;
        const double limit = longest * 2 * (a.half + b.half);
        cut_a = std::clamp(cut_a, -limit, std::min(limit, most * a.end->wall->length));
        cut_b = std::clamp(cut_b, -limit, std::min(limit, most * b.end->wall->length));
    }
    put_cut(a, true, cut_a);
    put_cut(b, false, cut_b);
}

}  // namespace

bool is_upright(const Transform& pose) { return rotate(pose.rotation, {0, 1, 0}).y > 1 - 1e-9; }

Vec3 point_of(const WallEnd& end) { return transform_point(end.pose, {end.is_end ? end.wall->length : 0, 0, 0}); }

void mitre(const std::vector<WallEnd>& ends) {
    std::vector<Spoke> spokes;
    for (const WallEnd& end : ends) {
        spokes.push_back(spoke_of(end));
        (end.is_end ? end.wall->end_cut : end.wall->start_cut) = {0, 0};
    }
    if (spokes.size() < 2) return;
    std::stable_sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) { return a.angle < b.angle; });
    for (std::size_t i = 0; i < spokes.size(); ++i) join(spokes[i], spokes[(i + 1) % spokes.size()]);
}

Bounds box_around(const physics::ShapeDefinition& shape) { return physics::bounds_of(shape); }

std::optional<physics::WallOpening> opening_of(const physics::WallShape& wall, const Transform& local, Vec3 size) {
    constexpr double straight = 0.99;  // cosine: it stands along the wall
    constexpr double sunk = 0.05;      // m, below the wall's foot
    const Vec3 at = local.position;
    const bool is_in = std::fabs(rotate(local.rotation, {1, 0, 0}).x) > straight &&
                       rotate(local.rotation, {0, 1, 0}).y > straight && std::fabs(at.z) <= wall.thickness / 2 &&
                       at.x > 0 && at.x < wall.length && at.y > -sunk && at.y < wall.height_at(at.x);
    if (!is_in || !(size.x > 0) || !(size.y > 0)) return std::nullopt;
    return physics::WallOpening{at.x - size.x / 2, size.x, size.y, std::max(0.0, at.y), physics::OpeningKind::hole};
}

}  // namespace embody::scene
