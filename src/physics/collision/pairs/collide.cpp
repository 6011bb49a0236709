// SPDX-License-Identifier: MIT
// From a pair of shapes to pairs of convexes. Everything below works in a frame of world axes whose origin is shape a's
// position, so that a scene far from the world's origin loses no digits.
#include <cmath>

#include "foundation/assert.h"
#include "physics/collision/pairs/box_pair.h"
#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/surface_pair.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::collision {

namespace {

void flip(Manifold& manifold) {
    manifold.normal = -manifold.normal;
    std::swap(manifold.piece_a, manifold.piece_b);
    std::swap(manifold.a_is_round, manifold.b_is_round);
}

void collide_with_plane(const CollisionShape::Data& a, const Transform& pose_a, const CollisionShape::Data& plane,
                        const Transform& pose_b, double margin, std::vector<Manifold>& manifolds) {
    thread_local ContactRegion region;
    const Vec3 normal = rotate(pose_b.rotation, plane.plane_normal);
    const PlacedPlane placed{normal, plane.plane_offset + dot(normal, pose_b.position - pose_a.position)};
    for (std::uint32_t i = 0; i < a.pieces.size(); ++i) {
        region.points.clear();
        collide_plane(place(a.pieces[i], pose_a, pose_a.position), placed, margin, region);
        if (region.points.empty()) continue;
        const std::size_t before = manifolds.size();
        append_manifolds(region, {}, pose_a.position, manifolds);
        for (std::size_t k = before; k < manifolds.size(); ++k) manifolds[k].piece_a = i;
    }
}

Bounds bounds_in_frame(const PlacedConvex& convex) {
    const Mat3& r = convex.rotation;
    const Vec3 h = convex.shape->bounds.half_extents();
    const Vec3 c = convex.to_frame(convex.shape->bounds.center());
    const Vec3 e = abs(r.x) * h.x + abs(r.y) * h.y + abs(r.z) * h.z;
    return {c - e, c + e};
}

// Transforms bounds in world axes with that origin to the frame of the pose; somewhat wider, for rounding.
Bounds in_frame_of(const Transform& pose, Vec3 origin, const Bounds& box) {
    const Mat3 r = to_matrix(pose.rotation);
    const Vec3 h = box.half_extents(), c = box.center() - (pose.position - origin);
    const auto extent = [&](Vec3 axis) { return dot(abs(axis), h) * (1 + 1e-9) + 1e-9; };
    const Vec3 center{dot(r.x, c), dot(r.y, c), dot(r.z, c)};
    const Vec3 half = Vec3{extent(r.x), extent(r.y), extent(r.z)} + (1e-12 * length(c)) * Vec3{1, 1, 1};
    return {center - half, center + half};
}

void append(Manifold& manifold, Vec3 origin, std::vector<Manifold>& manifolds) {
    for (int i = 0; i < manifold.count; ++i) manifold.points[static_cast<std::size_t>(i)].position += origin;
    manifolds.push_back(manifold);
}

// The family of the pair; a's kind is not after b's.
void find_region(const ConvexPair& pair, double margin, PairMemory& memory, ContactRegion& region) {
    if (pair.a->kind == ConvexKind::sphere) {
        collide_sphere(pair.placed_a(), pair.placed_b(), margin, memory, region);
        return;
    }
    const bool has_corners = pair.a->kind == ConvexKind::polytope && pair.b->kind == ConvexKind::polytope;
    if (has_corners && collide_polytopes(pair, margin, memory, region)) return;
    collide_round(pair.placed_a(), pair.placed_b(), margin, memory, region);
}

// Whether the balls around two pieces' inner points are farther apart than the margin: true of most pairs whose boxes
// overlap.
bool balls_are_apart(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory) {
    const double reach = a.shape->reach + b.shape->reach;
    const Vec3 displacement = interior_point(b) - interior_point(a);
    const double squared = length_squared(displacement);
    if (squared <= (reach + margin) * (reach + margin)) return false;
    const double distance = std::sqrt(squared);
    memory.part_along(a.direction_to_local(displacement / distance), distance - reach);
    return true;
}

// Two convex pieces in world axes with the origin at `origin`; at most two manifolds.
void collide_two(const PlacedConvex& first, const PlacedConvex& second, double margin, Vec3 origin, PairMemory& memory,
                 std::vector<Manifold>& manifolds) {
    // Each pair of kinds in one order, so that swapped arguments give the mirrored answer.
    const bool is_swapped = first.shape->kind > second.shape->kind;
    const PlacedConvex &a = is_swapped ? second : first, &b = is_swapped ? first : second;
    if (balls_are_apart(a, b, margin, memory)) return;
    const ConvexPair pair(*a.shape, a.rotation, *b.shape, b.rotation, b.position - a.position);
    if (a.shape->is_box && b.shape->is_box) {
        Manifold manifold;
        const BoxMeeting meeting = collide_boxes(pair, margin, memory, manifold);
        if (meeting == BoxMeeting::region) append(manifold, origin + a.position, manifolds);
        if (meeting != BoxMeeting::undecided) return;
    }
    thread_local ContactRegion region;
    region.points.clear();
    region.has_all_corners = region.is_on_edge = false;
    find_region(pair, margin, memory, region);
    if (region.points.empty()) return;
    const std::size_t before = manifolds.size();
    append_manifolds(region, pair.turn_a, origin + a.position, manifolds);
    for (std::size_t k = before; k < manifolds.size(); ++k) {
        manifolds[k].is_whole = region.has_all_corners && manifolds[k].is_whole;
        manifolds[k].is_on_edge = region.is_on_edge;
        if (is_swapped) manifolds[k].normal = -manifolds[k].normal;
    }
}

void collide_compounds(const CollisionShape::Data& a, const Transform& pose_a, const CollisionShape::Data& b,
                       const Transform& pose_b, double margin, PairMemory& memory, std::vector<Manifold>& manifolds) {
    struct Placed {
        PlacedConvex convex;
        Bounds bounds;
        bool is_known = false;
    };
    thread_local std::vector<Placed> placed_b;
    placed_b.assign(b.pieces.size(), {});
    for (std::uint32_t i = 0; i < a.pieces.size(); ++i) {
        const PlacedConvex placed_a = place(a.pieces[i], pose_a, pose_a.position);
        const Bounds bounds_a = enlarged(bounds_in_frame(placed_a), margin);
        const Bounds seen_from_b = in_frame_of(pose_b, pose_a.position, bounds_a);
        for (std::uint32_t j = 0; j < placed_b.size(); ++j) {
            // Most pieces are ruled out by boxes that need no placing.
            if (!overlaps(seen_from_b, b.piece_bounds[j])) continue;
            Placed& other = placed_b[j];
            if (!other.is_known) {
                other.convex = place(b.pieces[j], pose_b, pose_a.position);
                other.bounds = bounds_in_frame(other.convex);
                other.is_known = true;
            }
            if (!overlaps(bounds_a, other.bounds)) continue;
            PairMemory forgotten;
            const std::size_t before = manifolds.size();
            collide_two(placed_a, other.convex, margin, pose_a.position, i + j == 0 ? memory : forgotten, manifolds);
            for (std::size_t k = before; k < manifolds.size(); ++k) {
                manifolds[k].piece_a = i;
                manifolds[k].piece_b = j;
            }
        }
    }
    memory.gap = 0;  // a gap is known for two single pieces only
}

void collide_pieces(const CollisionShape::Data& a, const Transform& pose_a, const CollisionShape::Data& b,
                    const Transform& pose_b, double margin, PairMemory& memory, std::vector<Manifold>& manifolds) {
    if (a.pieces.size() > 1 || b.pieces.size() > 1) {
        collide_compounds(a, pose_a, b, pose_b, margin, memory, manifolds);
        return;
    }
    collide_two(place(a.pieces[0], pose_a, pose_a.position), place(b.pieces[0], pose_b, pose_a.position), margin,
                pose_a.position, memory, manifolds);
}

// a is a convex or a compound.
void collide_data(const CollisionShape::Data& a, const Transform& pose_a, const CollisionShape::Data& b,
                  const Transform& pose_b, double margin, PairMemory& memory, std::vector<Manifold>& manifolds) {
    const std::size_t before = manifolds.size();
    if (b.is_plane) {
        collide_with_plane(a, pose_a, b, pose_b, margin, manifolds);
    } else if (b.surface) {
        for (std::uint32_t i = 0; i < a.pieces.size(); ++i)
            collide_surface(a.pieces[i], i, pose_a, {*b.surface, pose_b}, margin, manifolds);
    } else {
        collide_pieces(a, pose_a, b, pose_b, margin, memory, manifolds);
    }
    for (std::size_t i = before; i < manifolds.size(); ++i) {
        Manifold& manifold = manifolds[i];
        manifold.a_is_round = a.pieces[manifold.piece_a].convex.is_round();
        manifold.b_is_round = !b.pieces.empty() && b.pieces[manifold.piece_b].convex.is_round();
    }
}

}  // namespace

void collide(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
             double margin, std::vector<Manifold>& manifolds) {
    PairMemory nothing;
    collide(a, pose_a, b, pose_b, margin, nothing, manifolds);
}

void collide(const CollisionShape& a, const Transform& pose_a, const CollisionShape& b, const Transform& pose_b,
             double margin, PairMemory& memory, std::vector<Manifold>& manifolds) {
    const CollisionShape::Data &data_a = a.data(), &data_b = b.data();
    EMBODY_ASSERT(!(data_a.pieces.empty() && data_b.pieces.empty()));
    // A convex or compound comes first, a shape for static bodies only second.
    if (data_a.pieces.empty()) {
        const std::size_t before = manifolds.size();
        collide(b, pose_b, a, pose_a, margin, memory, manifolds);
        for (std::size_t i = before; i < manifolds.size(); ++i) flip(manifolds[i]);
        return;
    }
    collide_data(data_a, pose_a, data_b, pose_b, margin, memory, manifolds);
}

void collide_capsule(Vec3 from, Vec3 to, double radius, const CollisionShape& b, const Transform& pose_b, double margin,
                     std::vector<Manifold>& manifolds) {
    thread_local CollisionShape::Data capsule;
    const double half = length(to - from) / 2, reach = half + radius;
    capsule.pieces.resize(1);
    Convex& convex = capsule.pieces[0].convex;
    convex.kind = ConvexKind::capsule;
    convex.radius = convex.inner = radius;
    convex.half_height = half;
    convex.bounds = {{-radius, -reach, -radius}, {radius, reach, radius}};
    convex.reach = reach;
    const Vec3 displacement = normalized(to - from, {0, 1, 0});
    PairMemory nothing;
    collide_data(capsule, {(from + to) / 2, from_two_vectors({0, 1, 0}, displacement)}, b.data(), pose_b, margin,
                 nothing, manifolds);
}

}  // namespace embody::physics::collision
