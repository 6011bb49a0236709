// SPDX-License-Identifier: MIT
// The best normal of two convexes, of which one or both are round. A normal is a lower bound of the gap, a point of one
// solid and its distance from the other's surface an upper one: where the two agree, the normal is the best of all. So
// the search alternates between normal and surface, and ends where a face, cap or side meets the point that is deepest
// over it. Where edges and rims cross, Newton's method finds the normal and crossing_is_best proves it.
// Where that ends without proof, GJK finds the normal between one solid and the other one's core, shrunk so that they
// do not overlap; a normal that separates the solids as far as the cores allow is the best of all. Where an edge meets
// a rim deeply the cores do not decide, and EPA on the solids does. All are compared with the exact normals close by
// (faces, caps, crossing lines): a cylinder on a box stands on the box's exact normal. (D. Gregorius's remark that GJK
// and EPA alone give noisy face contacts, GDC 2015.)
#include "physics/collision/pairs/parting_axis.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/pairs/convex_pairs.h"
#include "physics/collision/pairs/curve_crossing.h"
#include "physics/collision/pairs/round_features.h"
#include "physics/collision/queries/gjk.h"

namespace embody::physics::collision {

namespace {

/// A direction known from the shapes themselves.
struct CandidateNormal {
    Vec3 normal;
    bool is_exact = false;  ///< does not depend on the direction from which its search began
};
struct CandidateScratch {
    std::vector<CandidateNormal> candidates;
    std::vector<Vec3> own;
    std::vector<SlopedLine> lines_a, lines_b;
};

/// A pair while its best normal is searched.
struct AxisSearch {
    const PlacedConvex& a;
    const PlacedConvex& b;
    Core core_a, core_b;  ///< without the radii only
    double margin = 0, size = 0;
    CandidateScratch& scratch;
    Vec3 inside_a, inside_b;                ///< the inner points
    Vec3 on_a = inside_a, on_b = inside_b;  ///< points of the cores that were farthest along some normal
    PartingAxis axis;
    bool is_crossing = false;  ///< the axis is where curves cross
    Vec3 apart;                ///< a direction that separates the pair by more than the margin; zero if none was found
    double most = 1e300;       ///< upper bound of the separation along any direction
    Vec3 toward;               ///< the surface's normal at the point that gave the bound

    [[nodiscard]] double separation(Vec3 normal) const { return separation_along(core_a, core_b, normal); }
    // Upper bound of the separation along the normal: by any two points, one of each solid, and by the balls around
    // them:
    // those inside the solids and the radii around the cores.
    [[nodiscard]] double separation_at_most(Vec3 normal) const {
        const double middle = dot(normal, inside_b - inside_a) - a.shape->inner - b.shape->inner;
        const double from_a = dot(normal, on_b - inside_a) - a.shape->inner - core_b.depth;
        const double from_b = dot(normal, inside_b - on_a) - b.shape->inner - core_a.depth;
        return std::min({middle, from_a, from_b});
    }
    // Finds the points of both that are farthest along the normal.
    double touch_along(Vec3 normal) {
        on_a = core_a.support(normal);
        on_b = core_b.support(-normal);
        return dot(normal, on_b - on_a) - core_a.depth - core_b.depth;
    }
    // Ends the search with the present axis: the best one, or one that separates the pair.
    bool accept() {
        if (axis.separation > margin) apart = axis.normal;
        return true;
    }
};

// Normals of faces and caps are fixed; the normal of a smooth side was read off at the direction found so far.
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

void gather_own_normals(AxisSearch& s, Vec3 normal, bool all_faces) {
    s.scratch.candidates.clear();
    add_normals_of(s.a, normal, 1, all_faces, s.scratch);
    add_normals_of(s.b, -normal, -1, all_faces, s.scratch);
}

// Unit vectors n with dot(n, u) = p and dot(n, v) = q: a u + b v + c u x v, where the square of the length gives c. Of
// the two the one nearer to `wanted`; false where there is none or the lines are parallel.
bool solve_normal(const SlopedLine& first, const SlopedLine& second, Vec3 wanted, Vec3& n) {
    constexpr double min_square_sine = 1e-8;  // of the angle between lines: 1e-4 rad count as parallel
    const Vec3 u = first.direction, v = second.direction, across = cross(u, v);
    const double p = first.cosine, q = second.cosine, uv = dot(u, v), square_sine = length_squared(across);
    if (!(square_sine > min_square_sine)) return false;
    const double a = (p - uv * q) / square_sine, b = (q - uv * p) / square_sine;
    const double rest = 1 - (a * p + b * q);
    if (!(rest >= 0)) return false;
    const double c = std::sqrt(rest / square_sine);
    n = u * a + v * b + across * (dot(across, wanted) < 0 ? -c : c);
    return true;
}

// Two lines of surfaces separate along the normal that is perpendicular to both, or leans from a cone's axis as its
// side does.
void gather_crossing_lines(AxisSearch& s, Vec3 normal) {
    CandidateScratch& scratch = s.scratch;
    scratch.candidates.clear();
    scratch.lines_a.clear();
    scratch.lines_b.clear();
    add_sloped_lines(s.a, normal, scratch.lines_a);
    add_sloped_lines(s.b, -normal, scratch.lines_b);
    for (const SlopedLine& of_a : scratch.lines_a) {
        for (const SlopedLine& of_b : scratch.lines_b) {
            Vec3 n;
            if (solve_normal(of_a, {of_b.direction, -of_b.cosine}, normal, n)) scratch.candidates.push_back({n, true});
        }
    }
}

// Least cosine between normals that count as near each other.
constexpr double near = 0.99;

/// The candidates that may replace the normal that was found.
struct Preference {
    double hair = 0;        ///< their separation may be smaller by this
    double within = -2;     ///< minimum cosine between the two
    double enough = 1e300;  ///< a face with this separation is taken at once
    bool exact_only = false;
    bool all_faces = false;
};

// The separation along an exact normal may be smaller than along the best one by this: as among the axes of polytopes.
double bias_of(const AxisSearch& s) { return 1e-4 * s.size + 0.02 * std::fabs(s.axis.separation); }

// Replaces the axis by the candidate of the largest separation above `least`. True if there was one.
bool take_best_candidate(AxisSearch& s, const Preference& preference, Vec3 found, double least) {
    double best = least;
    for (const CandidateNormal& candidate : s.scratch.candidates) {
        if (preference.exact_only && !candidate.is_exact) continue;
        if (dot(candidate.normal, found) < preference.within) continue;
        if (s.separation_at_most(candidate.normal) <= best) continue;
        const double separation = s.separation(candidate.normal);
        if (separation <= best) continue;
        best = separation;
        s.axis.normal = candidate.normal;
        s.axis.separation = separation;
    }
    return best > least;
}

// Replaces the normal by the best of the candidates, if it is good enough.
bool prefer_candidate(AxisSearch& s, const Preference& preference) {
    const Vec3 found = s.axis.normal;
    const double least = s.axis.separation - preference.hair;
    gather_own_normals(s, found, preference.all_faces);
    const bool is_own = take_best_candidate(s, preference, found, least);
    if (is_own && s.axis.separation >= preference.enough) return true;
    gather_crossing_lines(s, found);
    return take_best_candidate(s, preference, found, is_own ? s.axis.separation : least) || is_own;
}

/// The solids, one of them shrunk to a core.
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

// Any point of one solid is an upper bound: the separation along any direction is at most its distance from the other's
// surface. The bound is tight where the point is deepest over a face, cap or smooth side.
void limit_by_point(AxisSearch& s, const PlacedConvex& solid, Vec3 point, double radius) {
    if (!has_volume(*solid.shape)) return;
    const SurfaceDistance from_surface = distance_from_surface(*solid.shape, solid.to_local(point));
    const double most = from_surface.distance - radius;
    if (most >= s.most) return;
    s.most = most;
    const Vec3 outwards = solid.direction_to_frame(from_surface.normal);
    s.toward = &solid == &s.a ? outwards : -outwards;
}

void limit_by_points(AxisSearch& s, Vec3 on_a, Vec3 on_b) {
    limit_by_point(s, s.a, on_b, s.core_b.depth);
    limit_by_point(s, s.b, on_a, s.core_a.depth);
}

// Whether both solids are farthest along the crossing's normal at the crossing, and no other normal is better by more
// than `loss`.
bool is_certain(AxisSearch& s, const CurveCrossing& crossing, double separation, double loss) {
    const double radii = s.core_a.depth + s.core_b.depth, hair = 1e-9 * s.size;
    const Vec3 displacement = crossing.on_b - crossing.on_a;
    if (crossing.is_within && std::fabs(separation - (dot(crossing.normal, displacement) - radii)) > hair) return false;

    // Cores that are apart are nearest there, since they are convex.
    if (crossing.is_within && separation > -radii && separation >= length(displacement) - radii - hair) return true;
    if (crossing.is_best) return true;
    limit_by_points(s, crossing.on_a, crossing.on_b);
    return crossing.is_within && separation >= s.most - loss;
}

// The exact normal of the curves that meet at the one found, if it is certain within `loss`.
bool search_by_curves(AxisSearch& s, double loss) {
    CurveCrossing crossing;
    if (!s.axis.found || !cross_curves(s.a, s.b, s.axis.normal, crossing)) return false;
    const double separation = s.separation(crossing.normal);
    if (!is_certain(s, crossing, separation, loss) || separation < s.axis.separation - 1e-9 * s.size) return false;
    s.axis = {true, crossing.normal, separation, true, crossing.on_a, crossing.on_b};
    s.is_crossing = !prefer_candidate(s, {.hair = bias_of(s), .exact_only = true});
    return s.accept();
}

bool has_few_faces(const Convex& convex) { return convex.kind != ConvexKind::polytope || convex.is_box; }

// The best exact normal close to the axis, if it is certain; else the better one of the two stays.
bool take_exact_normal(AxisSearch& s) {
    const PartingAxis found = s.axis;
    const double hair = 1e-7 * s.size;
    if (!prefer_candidate(s, {.hair = bias_of(s), .enough = s.most - hair, .exact_only = true})) return false;
    if (s.axis.separation > s.margin || s.axis.separation >= s.most - hair) return s.accept();
    s.touch_along(s.axis.normal);
    limit_by_points(s, s.on_a, s.on_b);
    if (s.axis.separation >= s.most - hair) return s.accept();
    // Where faces, sides or edges lie on each other, both are farthest at corners that are not over the other one. A
    // hull has many faces that are as good within the bias: the choice must not depend on the start.
    if (has_few_faces(*s.a.shape) && has_few_faces(*s.b.shape)) {
        limit_by_points(s, facing_point(s.a, s.axis.normal, s.inside_b), facing_point(s.b, -s.axis.normal, s.inside_a));
        if (s.axis.separation >= s.most - bias_of(s)) return s.accept();
    }
    if (s.axis.separation < found.separation) s.axis = found;
    return false;
}

// The normal of the surface that limits the gap, if it is certain; if it is the better one it stays in any case.
bool take_surface_normal(AxisSearch& s) {
    const double separation = s.separation(s.toward);
    if (separation <= s.axis.separation - 1e-9 * s.size) return false;
    s.axis = {true, s.toward, separation, false, {}, {}};
    if (separation > s.margin) return s.accept();
    if (separation < s.most - 1e-12 * s.size) return false;
    prefer_candidate(s, {.hair = bias_of(s), .within = near, .exact_only = true});
    return s.accept();
}

bool is_face_normal(const AxisSearch& s) {
    constexpr double equal = 1 - 1e-15;  // cosine: the same but for rounding
    return has_aligned_face(s.a, s.axis.normal, equal) || has_aligned_face(s.b, -s.axis.normal, equal);
}

// From a normal to the point that is deepest along it, from there to the surface over it, whose normal is the next one.
// True where a normal is certain or the pair is apart: mostly after two iterations. The result does not depend on the
// start.
bool search_by_surfaces(AxisSearch& s, Vec3 start) {
    constexpr int max_iterations = 4;  // the longer search takes what needs more
    Vec3 normal = start;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        s.axis = {true, normal, s.touch_along(normal), false, {}, {}};
        if (s.axis.separation > s.margin) return s.accept();
        limit_by_points(s, s.on_a, s.on_b);
        if (is_face_normal(s) && s.axis.separation >= s.most - 1e-7 * s.size) return true;
        if (take_exact_normal(s) || take_surface_normal(s)) return true;
        // The bound from the curves may be better.
        if (search_by_curves(s, 5e-5 * s.size) || take_surface_normal(s)) return true;
        if (dot(s.toward, normal) > 1 - 1e-9) return false;
        normal = s.toward;
    }
    return false;
}

// The shortest direction out of the larger one from the inner point of the smaller one.
Vec3 first_normal(const AxisSearch& s) {
    const bool from_a = has_volume(*s.a.shape) && (!has_volume(*s.b.shape) || s.a.shape->reach >= s.b.shape->reach);
    const PlacedConvex &larger = from_a ? s.a : s.b, &smaller = from_a ? s.b : s.a;
    const SurfaceDistance displacement = distance_from_surface(*larger.shape, larger.to_local(interior_point(smaller)));
    const Vec3 outwards = larger.direction_to_frame(displacement.normal);
    return from_a ? outwards : -outwards;
}

// The normal between one solid's shrunk core and the other solid. No direction can separate the solids farther than the
// gap there less the core's depth: if that normal separates the solids themselves as far, it is the best one, whether
// they overlap or not. That is so wherever a face, a smooth side or a crossing line of the shrunk one is met.
// True where the normal is certain or the pair is apart.
bool search_by_core(AxisSearch& s, bool is_core_of_a) {
    constexpr double corner_loss = 1.5;  // what shrinking takes away at a corner, in shares of the depth
    constexpr double corner_met = 0.05;
    const Convex& inner = is_core_of_a ? *s.a.shape : *s.b.shape;
    const double shrink = shrinkable(inner);
    if (shrink + rounding(inner) <= 0) return false;
    CorePair p{s.core_a, s.core_b, is_core_of_a, 0, shrink};
    (is_core_of_a ? p.a : p.b) = Core(is_core_of_a ? s.a : s.b, shrink);
    p.depth = p.a.depth + p.b.depth;

    // First a rough search: exact normals close by are preferred by a small bias, as among the axes of polytopes.
    if (!measure_cores(s, p, s.margin + p.depth + corner_loss * shrink, shrink > 0 ? 1e-3 : 1e-4)) return false;
    if (s.axis.separation <= s.margin) {
        const PartingAxis rough = s.axis;
        const double bias = bias_of(s);
        if (search_by_surfaces(s, rough.normal)) return true;
        s.axis = rough;
        const bool is_exact = prefer_candidate(s, {.hair = bias, .within = near, .exact_only = true});
        if (is_exact && s.axis.separation >= s.most - bias) return s.accept();
        s.axis = rough;
        // A separation far below the cores' bound means that a corner of the core was met, which gives no bound.
        if (rough.separation < s.most - corner_met * (shrink + rounding(inner))) return false;
        if (!measure_cores(s, p, 1e300, 1e-12)) return false;
    }
    if (s.axis.separation > s.margin) return s.accept();
    if (s.axis.separation < s.most - 1e-7 * s.size) return false;
    prefer_candidate(s, {.hair = 1e-7 * s.size, .within = near});
    return s.accept();
}

// Where neither surfaces nor cores decide (rims and edges, at which shrinking removes more than its depth): GJK on the
// solids, and EPA where they overlap.
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
    // The exact normal there, where surfaces or curves have one.
    const PartingAxis rough = s.axis;
    if (!is_lost && search_by_surfaces(s, rough.normal)) return;
    s.axis = rough;
    if (!is_lost && search_by_curves(s, 1e300)) return;
    s.axis = rough;
    prefer_candidate(s, {.hair = 1e-7 * s.size, .all_faces = is_lost});
}

// Searches from the last normal. Two deeply overlapping solids have more than one good normal: the choice must not
// depend on the past.
bool search_from_memory(AxisSearch& s, const PairMemory& memory) {
    using Kind = PairMemory::Kind;
    const double deep = -0.05 * s.size;
    if (memory.kind == Kind::crossing) {
        s.axis = {true, memory.axis, -1e300, false, {}, {}};
        if (search_by_curves(s, 5e-5 * s.size)) return s.axis.separation > deep;
    } else if (memory.kind != Kind::apart && memory.kind != Kind::along) {
        return false;
    }
    return search_by_surfaces(s, memory.axis) && s.axis.separation > deep;
}

// Searches as if nothing was known of the pair.
void search_from_nothing(AxisSearch& s) {
    s.axis = {};
    s.most = 1e300;
    // A capsule's axis and a triangle are found to be apart quickly.
    const bool is_simple = s.core_a.depth + s.core_b.depth > 0 && !(has_volume(*s.a.shape) && has_volume(*s.b.shape));
    if (!is_simple && search_by_surfaces(s, first_normal(s))) return;
    if (!search_by_core(s, true) && !search_by_core(s, false)) search_by_penetration(s);
}

}  // namespace

double smaller_size(const PlacedConvex& a, const PlacedConvex& b) {
    const Vec3 extent_a = a.shape->bounds.size(), extent_b = b.shape->bounds.size();
    const double size_a = std::max({extent_a.x, extent_a.y, extent_a.z});
    const double size_b = std::max({extent_b.x, extent_b.y, extent_b.z});
    return std::min(size_a, size_b);
}

PartingAxis find_parting_axis(const PlacedConvex& a, const PlacedConvex& b, double margin, PairMemory& memory) {
    using Kind = PairMemory::Kind;
    thread_local CandidateScratch scratch;
    AxisSearch s{a, b, Core(a), Core(b), margin, smaller_size(a, b), scratch, interior_point(a), interior_point(b)};
    if (memory.kind == Kind::apart) {
        memory.gap = s.separation(memory.axis);
        if (memory.gap > margin) return {};
    }
    if (!search_from_memory(s, memory)) search_from_nothing(s);
    memory.kind = Kind::nothing;
    if (length_squared(s.apart) > 0) {
        memory.part_along(s.apart, s.separation(s.apart));
        return {};
    }
    if (s.axis.found) memory.meet_along(s.axis.normal, s.is_crossing);
    return s.axis;
}

}  // namespace embody::physics::collision
