// SPDX-License-Identifier: MIT
// Any two convexes, for pairs with a round side and for single triangles. GJK finds the normal between one solid and
// the other one's core, shrunk so that they do not overlap; what parts the solids as far as the cores allow is the best
// of all normals. Where an edge meets a rim neither core tells, and EPA on the solids does. Each is then held against
// the exact normals nearby (faces, caps, sides, crossing lines): a cylinder on a box stands on the box's exact normal.
// (D. Gregorius's remark that GJK and EPA alone give noisy face contacts, GDC 2015.)
#include <algorithm>
#include <cmath>

#include "physics/collision/convex_pairs.h"
#include "physics/collision/curve_crossing.h"
#include "physics/collision/disc_region.h"
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

/// A direction known from the shapes themselves.
struct CandidateNormal {
    Vec3 normal;
    bool is_exact = false;  ///< does not depend on the direction near which it was looked for
};
struct CandidateScratch {
    std::vector<CandidateNormal> candidates;
    std::vector<Vec3> own, lines_a, lines_b;
};

/// A pair while its best normal is searched.
struct AxisSearch {
    const PlacedConvex& a;
    const PlacedConvex& b;
    Core core_a, core_b;  ///< without the radii only
    double margin = 0, size = 0;
    CandidateScratch& scratch;
    PartingAxis axis;
    Vec3 apart;           ///< a direction that parts the pair by more than the margin; zero if none was found
    double most = 1e300;  ///< no direction parts the pair by more than this

    [[nodiscard]] double separation(Vec3 normal) const { return separation_along(core_a, core_b, normal); }
    // Ends the search with the axis there is: the best one, or one that parts the pair.
    bool accept() {
        if (axis.separation > margin) apart = axis.normal;
        return true;
    }
};

// Faces and caps stand still; the normal of a smooth side was read off at the direction found so far.
void add_normals_of(const PlacedConvex& convex, Vec3 direction, double sign, bool all_faces,
                    CandidateScratch& scratch) {
    scratch.own.clear();
    add_own_normals(convex, direction, all_faces, scratch.own);
    const bool is_polytope = convex.shape->kind == ConvexKind::polytope;
    for (const Vec3& n : scratch.own) {
        const bool is_exact = is_polytope || std::fabs(dot(n, convex.rotation.y)) > 1 - 1e-12;
        scratch.candidates.push_back({n * sign, is_exact});
    }
}

void gather_candidates(AxisSearch& s, bool all_faces) {
    const Vec3 normal = s.axis.normal;
    CandidateScratch& scratch = s.scratch;
    scratch.candidates.clear();
    scratch.lines_a.clear();
    scratch.lines_b.clear();
    add_normals_of(s.a, normal, 1, all_faces, scratch);
    add_normals_of(s.b, -normal, -1, all_faces, scratch);

    // Lines that cross part along what is perpendicular to both; a cone's line depends on the direction.
    const bool is_exact = s.a.shape->kind != ConvexKind::cone && s.b.shape->kind != ConvexKind::cone;
    add_line_directions(s.a, normal, scratch.lines_a);
    add_line_directions(s.b, -normal, scratch.lines_b);
    for (const Vec3& u : scratch.lines_a) {
        for (const Vec3& v : scratch.lines_b) {
            const Vec3 n = cross(u, v);
            const double sine = length(n);
            if (sine < 1e-4) continue;
            scratch.candidates.push_back({n * ((dot(n, normal) < 0 ? -1 : 1) / sine), is_exact});
        }
    }
}

/// Which candidates may replace the normal that was found.
struct Preference {
    double hair = 0;     ///< they may part the pair by this much less
    double within = -2;  ///< least cosine between the two
    bool exact_only = false;
    bool all_faces = false;
};

// Replaces the normal by the best of the candidates, if it is good enough.
bool prefer_candidate(AxisSearch& s, const Preference& preference) {
    gather_candidates(s, preference.all_faces);
    double best = s.axis.separation - preference.hair;
    const Vec3 found = s.axis.normal;
    bool is_replaced = false;
    for (const CandidateNormal& candidate : s.scratch.candidates) {
        if (preference.exact_only && !candidate.is_exact) continue;
        if (dot(candidate.normal, found) < preference.within) continue;
        const double separation = s.separation(candidate.normal);
        if (separation <= best) continue;
        best = separation;
        s.axis.normal = candidate.normal;
        s.axis.separation = separation;
        is_replaced = true;
    }
    return is_replaced;
}

/// The solids with one of them shrunk to a core.
struct CorePair {
    Core a, b;
    bool is_core_of_a = true;
    double depth = 0, shrink = 0;
};

// The normal between the core and the other solid; false where they overlap.
bool measure_cores(AxisSearch& s, const CorePair& p, double enough, double converged) {
    const CoreDistance gap = core_distance(p.a, p.b, enough, s.axis.normal, converged);
    if (gap.overlap || !(gap.distance > 1e-9 * s.size)) return false;
    const Vec3 normal = normalized(gap.direction);
    const double separation = s.separation(normal);
    if (gap.is_final || separation > s.margin) {
        s.axis = {true, normal, separation, true, gap.on_a + normal * (p.a.depth - s.core_a.depth), {}};
        if (!p.is_core_of_a) s.axis.on_a = gap.on_b - normal * (p.b.depth + separation + s.core_a.depth);
        s.most = std::min(s.most, gap.distance - p.depth);
        return true;
    }
    return measure_cores(s, p, 1e300, converged);
}

// The exact normal of the curves that meet near the one found, if it is where both solids reach farthest along it and
// falls short of the cores' limit by no more than `loss`.
bool search_by_curves(AxisSearch& s, double loss) {
    CurveCrossing crossing;
    if (!s.axis.found || !cross_curves(s.a, s.b, s.axis.normal, crossing)) return false;
    const double separation = s.separation(crossing.normal);
    const double radii = s.core_a.depth + s.core_b.depth;
    const double between = dot(crossing.normal, crossing.on_b - crossing.on_a) - radii;
    if (std::fabs(separation - between) > 1e-9 * s.size || separation < s.most - loss) return false;
    if (separation < s.axis.separation - 1e-9 * s.size) return false;
    s.axis = {true, crossing.normal, separation, true, crossing.on_a, crossing.on_b};
    prefer_candidate(s, {.hair = 1e-4 * s.size + 0.02 * std::fabs(separation), .exact_only = true});
    return s.accept();
}

// The normal between one solid's shrunk core and the other solid. No direction can part the solids farther than the
// gap there less the core's depth: where the solids themselves are parted as far along that normal, it is the best one,
// whether they overlap or not. That is so wherever a face, a smooth side or a crossing line of the shrunk one is met.
// True where the normal is certain or the pair is apart.
bool search_by_core(AxisSearch& s, bool is_core_of_a) {
    constexpr double corner_loss = 1.5;  // what shrinking takes away at a corner, in shares of the depth
    constexpr double near = 0.99, corner_met = 0.05;
    const Convex& inner = is_core_of_a ? *s.a.shape : *s.b.shape;
    const double shrink = shrinkable(inner);
    if (shrink + rounding(inner) <= 0) return false;
    CorePair p{s.core_a, s.core_b, is_core_of_a, 0, shrink};
    (is_core_of_a ? p.a : p.b) = Core(is_core_of_a ? s.a : s.b, shrink);
    p.depth = p.a.depth + p.b.depth;

    // Roughly first: exact normals near by are preferred by a little, as among the axes of polytopes.
    if (!measure_cores(s, p, s.margin + p.depth + corner_loss * shrink, shrink > 0 ? 1e-3 : 1e-4)) return false;
    if (s.axis.separation <= s.margin) {
        const PartingAxis rough = s.axis;
        const double bias = 1e-4 * s.size + 0.02 * std::fabs(s.axis.separation);
        const bool is_exact = prefer_candidate(s, {.hair = bias, .within = near, .exact_only = true});
        if (is_exact && s.axis.separation >= s.most - bias) return s.accept();
        s.axis = rough;
        if (search_by_curves(s, 5e-5 * s.size)) return true;
        // Far below what the cores allow it is a corner of the core that was met, which never tells.
        if (rough.separation < s.most - corner_met * (shrink + rounding(inner))) return false;
        if (!measure_cores(s, p, 1e300, 1e-12)) return false;
    }
    if (s.axis.separation > s.margin) return s.accept();
    if (s.axis.separation < s.most - 1e-7 * s.size) return false;
    prefer_candidate(s, {.hair = 1e-7 * s.size, .within = near});
    return s.accept();
}

// Where neither core tells: GJK on the solids, and EPA where they overlap.
void search_by_penetration(AxisSearch& s) {
    const double radii = s.core_a.depth + s.core_b.depth;
    const CoreDistance gap = core_distance(s.core_a, s.core_b, s.margin + radii);
    if (!gap.overlap && gap.distance - radii > s.margin) {
        s.apart = normalized(gap.direction);
        return;
    }
    // Below this gap the difference of the witness points has no direction left.
    bool is_lost = false;
    if (!gap.overlap && gap.distance > 1e-9 * s.size) {
        s.axis = {true, gap.direction / gap.distance, gap.distance - radii, true, gap.on_a, gap.on_b};
    } else {
        Vec3 normal;
        is_lost = !penetration_normal(s.core_a, s.core_b, gap, normal);
        if (is_lost) normal = normalized(interior_point(s.b) - interior_point(s.a), {0, 1, 0});
        const double separation = s.separation(normal);
        if (!s.axis.found || separation > s.axis.separation) s.axis = {true, normal, separation, false, {}, {}};
    }
    prefer_candidate(s, {.hair = 1e-7 * s.size, .all_faces = is_lost});
}

PartingAxis find_axis(AxisSearch& s, PairMemory& memory) {
    using Kind = PairMemory::Kind;
    if (memory.kind == Kind::apart && s.separation(memory.axis) > s.margin) return {};
    memory.kind = Kind::nothing;
    if (!search_by_core(s, true) && !search_by_core(s, false)) {
        // Rims and edges, at which shrinking takes away more than its depth: the cores prove little there, so only a
        // shallow crossing is taken for the best.
        const double shrink = std::max(shrinkable(*s.a.shape), shrinkable(*s.b.shape));
        const PartingAxis rough = s.axis;
        if (!search_by_curves(s, 0.45 * shrink) || s.axis.separation < -0.1 * shrink) {
            s.axis = rough;
            search_by_penetration(s);
        }
    }
    if (length_squared(s.apart) > 0) {
        memory.part_along(s.apart);
        return {};
    }
    return s.axis;
}

struct FeatureScratch {
    ContactFeature face_a, face_b, other, line_a, line_b;
};
struct RoundScratch {
    CandidateScratch candidates;
    FeatureScratch features;
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
    thread_local RoundScratch scratch;
    FeatureScratch& f = scratch.features;
    AxisSearch search{a, b, Core(a), Core(b), margin, smaller_size(a, b), scratch.candidates};
    const PartingAxis axis = find_axis(search, memory);
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
