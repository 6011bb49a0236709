// SPDX-License-Identifier: MIT
// Any two convexes, for pairs with a round side and for single triangles: the best normal, then the region over which
// the faces, lines or points there are within the margin of each other.
#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/disc_region.h"
#include "physics/collision/pairs/parting_axis.h"
#include "physics/collision/pairs/round_features.h"

namespace embody::physics::collision {

namespace {

struct FeatureScratch {
    ContactFeature face_a, face_b, other, line_a, line_b;
};

double twice_area(const ContactFeature& face) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < face.points.size(); ++i)
        sum += cross(face.points[i] - face.points[0], face.points[i + 1] - face.points[0]);
    return length(sum);
}

// The reference: a polytope's own face, which is exact, before a rim, which is a polygon. Of two polytopes' faces the
// larger one: the small faces of a scanned hull's side say little about how it lies.
bool is_better_reference(const PlacedConvex& a, const ContactFeature& face_a, const PlacedConvex& b,
                         const ContactFeature& face_b) {
    if (a.shape->kind != ConvexKind::polytope || b.shape->kind != ConvexKind::polytope)
        return a.shape->kind == ConvexKind::polytope;
    return twice_area(face_a) >= (1 - 1e-6) * twice_area(face_b);
}

// A face of one against the facing feature of the other, and always the other's deepest point.
void add_face_region(const PlacedConvex& a, const PlacedConvex& b, const PartingAxis& axis, bool is_face_a,
                     double margin, FeatureScratch& f, ContactRegion& region) {
    const PlacedConvex& incident = is_face_a ? b : a;
    const Vec3 outwards = is_face_a ? -axis.normal : axis.normal;
    get_facing(incident, outwards, f.other);
    const ContactFeature& reference = is_face_a ? f.face_a : f.face_b;
    if (!add_disc_region(reference, f.other, is_face_a, margin, region)) {
        thin_out_cap(reference, f.other);
        add_near_corners(reference, incident, is_face_a, margin, region);
        clip_to_region(reference, f.other, is_face_a, rounding(*incident.shape), margin, region);
    }
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

void collide_round(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory,
                   ContactRegion& region) {
    thread_local FeatureScratch f;
    const PartingAxis axis = find_parting_axis(a, b, margin, memory);
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
        const double lift_a = rounding(*a.shape), lift_b = rounding(*b.shape);
        if (span_face(a, true, f.line_b, lift_b, axis.separation, margin, f.face_a, region)) return;
        if (span_face(b, false, f.line_a, lift_a, axis.separation, margin, f.face_b, region)) return;
        cross_segments(f.line_a, f.line_b, lift_a, lift_b, margin, region);
        // Lines that pass each other beyond an end do not meet there: the end itself is the point.
        const auto is_deepest = [&](const ManifoldPoint& p) {
            return p.separation <= axis.separation + 1e-5 * smaller_size(a, b);
        };
        if (std::none_of(region.points.begin(), region.points.end(), is_deepest)) region.points.clear();
    }
    if (region.points.empty()) add_point(a, b, axis, !is_line_a, region);
}

}  // namespace embody::physics::collision
