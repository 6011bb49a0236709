// SPDX-License-Identifier: MIT
// A convex against the triangles near it. One-sided, and without bumps at the edges inside a surface: a normal that
// leans over an edge farther than the surface itself bends there belongs to the neighbour (the Voronoi region test, cf.
// P. Terdiman and others on "internal edges"); it is replaced by the triangle's own normal.
#include "physics/collision/surface_pair.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/convex_pairs.h"
#include "physics/collision/round_features.h"

namespace embody::physics {

namespace {

/// A triangle in the frame of the pair.
struct PlacedTriangle {
    std::array<Vec3, 3> corners;
    Vec3 normal;
    std::array<Vec3, 3> outward;  ///< unit, in the plane, across each edge
    // How far a contact normal may lean over each edge: sine and cosine of the bend to the neighbour there; (0, 1)
    // where the surface is flat or concave, (0, -1) where it ends.
    std::array<double, 3> bend_sine{}, bend_cosine{};
    bool open = false;  ///< some edge lets the normal lean
};

/// All contacts of triangles whose normals nearly agree.
struct NormalGroup {
    ContactRegion region;
    std::uint32_t lowest_triangle = 0;
};

constexpr double flat_sine = 1e-3;

/// The convex that is held against triangles: its core and a point inside, turned once.
struct Probe {
    Core core;
    Vec3 inside;
    double margin;

    // Whether all of the convex lies beyond the plane through `point` by more than the margin.
    [[nodiscard]] bool is_beyond(Vec3 point, Vec3 outwards) const {
        return dot(core.support(-outwards) - point, outwards) - core.depth > margin;
    }
};

// The corners and normal; false where the convex is behind the triangle, or higher above it than the margin. Most
// triangles go here, before their neighbours are looked at.
bool place_corners(const PlacedSurface& placed, const Mat3& rotation, Vec3 origin, std::uint32_t index,
                   const Probe& probe, PlacedTriangle& t) {
    const auto corners = placed.surface.corners(index);
    for (std::size_t i = 0; i < 3; ++i) t.corners[i] = origin + rotation * corners[i];
    t.normal = rotation * placed.surface.normal(index);
    if (length_squared(t.normal) == 0 || dot(probe.inside - t.corners[0], t.normal) <= 0) return false;
    return !probe.is_beyond(t.corners[0], t.normal);
}

// The sides and what lies beyond them; false where the convex is farther beyond one of them than the margin.
bool place_sides(const PlacedSurface& placed, const Mat3& rotation, std::uint32_t index, const Probe& probe,
                 PlacedTriangle& t) {
    for (std::size_t i = 0; i < 3; ++i) {
        t.outward[i] = normalized(cross(t.corners[(i + 1) % 3] - t.corners[i], t.normal));
        if (probe.is_beyond(t.corners[i], t.outward[i])) return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t neighbour = placed.surface.neighbour(index, static_cast<int>(i));
        if (neighbour == TriangleSurface::no_neighbour) {
            t.bend_sine[i] = 0;
            t.bend_cosine[i] = -1;
            t.open = true;
            continue;
        }
        // Towards the outside the neighbour's normal leans away over a convex edge, back over a concave one.
        const Vec3 other = rotation * placed.surface.normal(neighbour);
        const double sine = dot(other, t.outward[i]);
        const bool convex = sine > flat_sine || (dot(other, t.normal) < 0 && sine > 0);
        t.bend_sine[i] = convex ? sine : 0;
        t.bend_cosine[i] = convex ? dot(other, t.normal) : 1;
        t.open = t.open || convex;
    }
    return true;
}

// Whether a normal (from the triangle outwards) leans over an edge beyond the bend there.
bool leans_too_far(const PlacedTriangle& t, Vec3 outwards) {
    const double up = dot(outwards, t.normal);
    for (std::size_t i = 0; i < 3; ++i) {
        const double over = dot(outwards, t.outward[i]);
        if (over <= flat_sine) continue;
        // Angle of lean against angle of bend: positive sine of their difference is too far.
        const double beyond = over * t.bend_cosine[i] - up * t.bend_sine[i];
        if (t.bend_cosine[i] <= -1 ? up < 0 : beyond > flat_sine) return true;
    }
    return up <= 0;
}

// Whether the normal is the triangle's own but for a lean too small to mean an edge.
bool is_flat_to(const PlacedTriangle& t, Vec3 outwards) { return dot(outwards, t.normal) > 1 - flat_sine * flat_sine; }

// The convex against the plane of the triangle, clipped to the triangle.
void collide_along_normal(const PlacedConvex& convex, const PlacedTriangle& t, double margin, ContactRegion& region) {
    thread_local ContactFeature face, facing;
    region.normal = -t.normal;
    face.clear();
    face.normal = t.normal;
    face.points.assign(t.corners.begin(), t.corners.end());
    get_facing(convex, -t.normal, facing);
    clip_to_region(face, facing, false, rounding(*convex.shape), margin, region);
}

void collide_sphere_triangle(const PlacedConvex& sphere, const PlacedTriangle& t, double margin,
                             ContactRegion& region) {
    // Nearest point of the triangle, by the edge regions.
    const Vec3 center = sphere.position;
    const double height = dot(center - t.corners[0], t.normal);
    Vec3 nearest = center - t.normal * height;
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) inside = inside && dot(center - t.corners[i], t.outward[i]) <= 0;
    if (!inside) {
        double least = 1e300;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 u = t.corners[i], along = t.corners[(i + 1) % 3] - u;
            const double s = std::clamp(dot(center - u, along) / length_squared(along), 0.0, 1.0);
            const Vec3 p = u + along * s;
            if (distance(p, center) < least) {
                least = distance(p, center);
                nearest = p;
            }
        }
    }
    const double radius = sphere.shape->radius;
    const double gap = distance(center, nearest);
    if (gap - radius > margin) return;
    Vec3 outwards = inside ? t.normal : normalized(center - nearest, t.normal);
    if (!inside && leans_too_far(t, outwards)) return;
    if (is_flat_to(t, outwards)) outwards = t.normal;
    region.normal = -outwards;
    region.add(center - outwards * radius, gap - radius, 0);
}

// Region of the convex with one triangle, in region.
void collide_triangle(const PlacedConvex& convex, const PlacedTriangle& t, double margin, ContactRegion& region) {
    region.points.clear();
    if (convex.shape->kind == ConvexKind::sphere) {
        collide_sphere_triangle(convex, t, margin, region);
        return;
    }
    if (!t.open) {
        collide_along_normal(convex, t, margin, region);
        return;
    }
    // An edge where the surface bends away: the best normal of all, if it is this triangle's business.
    thread_local Convex shape{ConvexKind::polytope, 0, 0, triangle_polytope({}, {1, 0, 0}, {0, 0, 1}), {}};
    set_triangle(shape.polytope, t.corners[0], t.corners[1], t.corners[2]);
    shape.bounds = {};
    for (const Vec3& p : t.corners) shape.bounds.add(p);
    PairMemory nothing;
    collide_round(convex, {&shape, {}, {}}, margin, nothing, region);
    if (region.points.empty()) return;
    if (!is_flat_to(t, -region.normal) && !leans_too_far(t, -region.normal)) return;
    region.points.clear();
    collide_along_normal(convex, t, margin, region);
}

void add_to_groups(const ContactRegion& region, std::uint32_t triangle, std::vector<NormalGroup>& groups,
                   std::size_t& count) {
    constexpr double same_normal = 0.9998;  // within 1.1 degrees
    std::size_t g = 0;
    while (g < count && dot(groups[g].region.normal, region.normal) < same_normal) ++g;
    if (g == count) {
        if (count == groups.size()) groups.emplace_back();
        groups[g].region.points.clear();
        groups[g].region.normal = region.normal;
        groups[g].lowest_triangle = triangle;
        ++count;
    }
    for (ManifoldPoint point : region.points) {
        point.feature = feature_name({triangle, point.feature});
        groups[g].region.points.push_back(point);
    }
}

}  // namespace

void collide_surface(const ConvexPiece& piece, std::uint32_t piece_index, const Transform& pose,
                     const PlacedSurface& placed, double margin, std::vector<Manifold>& manifolds) {
    thread_local std::vector<std::uint32_t> near;
    thread_local std::vector<NormalGroup> groups;
    thread_local ContactRegion region;

    // Triangles near the convex, looked up in the surface's own frame.
    const PlacedConvex convex = place(piece, pose, pose.position);
    const PlacedConvex seen{&piece.convex,
                            to_matrix(conjugate(placed.pose.rotation) * (pose.rotation * piece.local.rotation)),
                            inverse_transform_point(placed.pose, transform_point(pose, piece.local.position))};
    const Vec3 half = piece.convex.bounds.half_extents(), center = seen.to_frame(piece.convex.bounds.center());
    const Mat3& r = seen.rotation;
    const Vec3 reach = abs(r.x) * half.x + abs(r.y) * half.y + abs(r.z) * half.z;
    near.clear();
    placed.surface.find(enlarged(Bounds{center - reach, center + reach}, margin), near);

    // Each triangle's contacts join those of others with nearly the same normal.
    std::size_t count = 0;
    const Mat3 rotation = to_matrix(placed.pose.rotation);
    const Vec3 origin = placed.pose.position - pose.position;
    const Probe probe{Core(convex), interior_point(convex), margin};
    for (const std::uint32_t index : near) {
        PlacedTriangle triangle;
        if (!place_corners(placed, rotation, origin, index, probe, triangle)) continue;
        if (!place_sides(placed, rotation, index, probe, triangle)) continue;
        collide_triangle(convex, triangle, margin, region);
        if (!region.points.empty()) add_to_groups(region, index, groups, count);
    }
    for (std::size_t g = 0; g < count; ++g) {
        append_manifold(groups[g].region, {}, pose.position, manifolds);
        manifolds.back().piece_a = piece_index;
        manifolds.back().piece_b = groups[g].lowest_triangle;
    }
}

}  // namespace embody::physics
