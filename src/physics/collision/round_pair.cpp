// SPDX-License-Identifier: MIT
// Any two convexes, for pairs with a round side and for single triangles. GJK gives the normal of separated cores and
// EPA that of overlapping ones; both are then held against the exact normals nearby (faces, caps, sides, crossing
// lines). Every normal's separation is measured by the support functions and never exceeds the true one, so the largest
// is the best, and a face that is as good as EPA's answer replaces it: a cylinder on a box stands on the box's exact
// normal. (D. Gregorius's remark that GJK and EPA alone give noisy face contacts, GDC 2015.)
#include <algorithm>
#include <cmath>

#include "physics/collision/convex_pairs.h"
#include "physics/collision/gjk.h"
#include "physics/collision/round_features.h"

namespace embody::physics {

namespace {

/// The parting direction of a pair and how it was found.
struct PartingAxis {
    bool found = false;
    Vec3 normal;  ///< unit, a to b
    double separation = 0;
    bool has_witness = false;  ///< on_a and on_b are the nearest points of the cores
    Vec3 on_a, on_b;
};

double smaller_size(const PlacedConvex& a, const PlacedConvex& b) {
    const Vec3 extent_a = a.shape->bounds.size(), extent_b = b.shape->bounds.size();
    const double size_a = std::max({extent_a.x, extent_a.y, extent_a.z});
    const double size_b = std::max({extent_b.x, extent_b.y, extent_b.z});
    return std::min(size_a, size_b);
}

void gather_candidates(const PlacedConvex& a, const PlacedConvex& b, Vec3 normal, bool all_faces,
                       std::vector<Vec3>& candidates) {
    thread_local std::vector<Vec3> lines_a, lines_b, normals_b;
    candidates.clear();
    normals_b.clear();
    lines_a.clear();
    lines_b.clear();
    add_own_normals(a, normal, all_faces, candidates);
    add_own_normals(b, -normal, all_faces, normals_b);
    for (const Vec3& n : normals_b) candidates.push_back(-n);

    // Lines that cross part along what is perpendicular to both.
    add_line_directions(a, normal, lines_a);
    add_line_directions(b, -normal, lines_b);
    for (const Vec3& u : lines_a) {
        for (const Vec3& v : lines_b) {
            const Vec3 n = cross(u, v);
            const double sine = length(n);
            if (sine < 1e-4) continue;
            candidates.push_back(n * ((dot(n, normal) < 0 ? -1 : 1) / sine));
        }
    }
}

PartingAxis find_axis(const PlacedConvex& a, const PlacedConvex& b, double margin) {
    thread_local std::vector<Vec3> candidates;
    PartingAxis axis;
    const double radii = rounding(*a.shape) + rounding(*b.shape);
    const double size = smaller_size(a, b);
    const CoreDistance gap = core_distance(a, b, margin + radii);
    if (!gap.overlap && gap.distance - radii > margin) return axis;

    // Below this gap the difference of the witness points has no direction left.
    const bool apart = !gap.overlap && gap.distance > 1e-9 * size;
    bool is_lost = false;
    if (apart) {
        axis = {true, (gap.on_b - gap.on_a) / gap.distance, gap.distance - radii, true, gap.on_a, gap.on_b};
    } else {
        is_lost = !penetration_normal(a, b, gap, axis.normal);
        if (is_lost) {
            axis.normal = normalized(interior_point(b) - interior_point(a), {0, 1, 0});
        }
        axis.separation = separation_along(a, b, axis.normal);
        axis.found = true;
    }

    // An exact normal that is better, or as good within a hair; of all faces where the search found no direction.
    gather_candidates(a, b, axis.normal, is_lost, candidates);
    const double hair = 1e-7 * size;
    Vec3 best_normal;
    double best = axis.separation - hair;
    for (const Vec3& n : candidates) {
        const double separation = separation_along(a, b, n);
        if (separation <= best) continue;
        best = separation;
        best_normal = n;
    }
    if (length_squared(best_normal) > 0) {
        axis.normal = best_normal;
        axis.separation = best;
    }
    return axis;
}

struct FeatureScratch {
    ContactFeature face_a, face_b, other, line_a, line_b;
};

double twice_area(const ContactFeature& face) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < face.points.size(); ++i)
        sum += cross(face.points[i] - face.points[0], face.points[i + 1] - face.points[0]);
    return length(sum);
}

// A polytope's own face is exact, a rim is a polygon: the former first. Of two polytopes' faces the larger one: the
// small faces that a scanned hull's side is made of say little about how it lies.
bool is_better_reference(const PlacedConvex& a, const ContactFeature& face_a, const PlacedConvex& b,
                         const ContactFeature& face_b) {
    if (a.shape->kind != ConvexKind::polytope || b.shape->kind != ConvexKind::polytope)
        return a.shape->kind == ConvexKind::polytope;
    return twice_area(face_a) >= (1 - 1e-6) * twice_area(face_b);
}

// A face of one against what the other turns to it, and the other's deepest point whatever happens.
void add_face_region(const PlacedConvex& a, const PlacedConvex& b, const PartingAxis& axis, bool is_face_a,
                     double margin, FeatureScratch& f, ContactRegion& region) {
    const PlacedConvex& incident = is_face_a ? b : a;
    const Vec3 outwards = is_face_a ? -axis.normal : axis.normal;
    get_facing(incident, outwards, f.other);
    add_near_corners(is_face_a ? f.face_a : f.face_b, incident, is_face_a, margin, region);
    clip_to_region(is_face_a ? f.face_a : f.face_b, f.other, is_face_a, rounding(*incident.shape), margin, region);
    const Vec3 deepest = core_support(incident, outwards) + outwards * rounding(*incident.shape);
    const Vec3 on_a = is_face_a ? deepest - axis.normal * axis.separation : deepest;
    keep_deepest(on_a, axis.separation, 1e-6 * smaller_size(a, b), region);
}

// One point, where a corner or a rim of one meets the other.
void add_point(const PlacedConvex& a, const PlacedConvex& b, const PartingAxis& axis, bool is_point_a,
               ContactRegion& region) {
    const double radius_a = rounding(*a.shape);
    const bool witness = axis.has_witness;
    Vec3 on_a = witness ? axis.on_a + axis.normal * radius_a : core_support(a, axis.normal) + axis.normal * radius_a;
    if (!witness && !is_point_a) {
        on_a = core_support(b, -axis.normal) - axis.normal * (axis.separation + rounding(*b.shape));
    }
    region.add(on_a, axis.separation, 0);
}

}  // namespace

void collide_round(const PlacedConvex& a, const PlacedConvex& b, double margin, ContactRegion& region) {
    thread_local FeatureScratch f;
    const PartingAxis axis = find_axis(a, b, margin);
    if (!axis.found || axis.separation > margin) return;
    region.normal = axis.normal;

    // A flat face on either side: a region.
    const bool is_face_a = get_aligned_face(a, axis.normal, f.face_a);
    const bool is_face_b = get_aligned_face(b, -axis.normal, f.face_b);
    if (is_face_a || is_face_b) {
        const bool prefer_a = is_face_a && (!is_face_b || is_better_reference(a, f.face_a, b, f.face_b));
        add_face_region(a, b, axis, prefer_a, margin, f, region);
        return;
    }
    // Two straight lines, else a point.
    const bool is_line_a = get_aligned_line(a, axis.normal, f.line_a);
    const bool is_line_b = get_aligned_line(b, -axis.normal, f.line_b);
    if (is_line_a && is_line_b) {
        cross_segments(f.line_a, f.line_b, rounding(*a.shape), rounding(*b.shape), margin, region);
        // Lines that pass each other beyond an end do not meet there: the end itself is the point.
        const auto is_deepest = [&](const ManifoldPoint& p) {
            return p.separation <= axis.separation + 1e-5 * smaller_size(a, b);
        };
        if (std::none_of(region.points.begin(), region.points.end(), is_deepest)) region.points.clear();
    }
    if (region.points.empty()) add_point(a, b, axis, !is_line_a, region);
}

}  // namespace embody::physics
