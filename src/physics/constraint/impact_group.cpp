// SPDX-License-Identifier: MIT
//
// Several micro-collisions (paper, eq. 3) at once. Sources: B. Mirtich, "Impulse-based dynamic simulation of rigid body
// systems", 1996 (one after the other, the most negative normal velocity first); Ch. Glocker, F. Pfeiffer, "Multiple
// impacts with friction in rigid multibody systems", 1995 (compression of all contacts, then expansion of all).
//   compression  repeat: the site that approaches fastest runs eq. (3) until it no longer approaches
//   expansion    one site alone: eq. (3) on, until the normal work e² W_c is given back (Stronge)
//                several: each gives back e of its normal impulse at once, so that a symmetric collision stays
//                symmetric whatever the order was; without friction this is e² of the energy, too
//   guard        the kinetic energy after <= before (eq. 5 and 6 hold by construction), else the expansion is scaled
#include "physics/constraint/impact_group.h"

#include <algorithm>
#include <cmath>

#include "physics/constraint/contact.h"

namespace embody::physics {

namespace {

constexpr double slide_rounding = 1e-5;  // of the approach: what a followed slide may be wrong by at its end

Vec3 velocity_of(const ImpactSite& s, std::span<const BodyState> bodies) {
    return velocity_at(bodies[s.b], s.arm_b) - velocity_at(bodies[s.a], s.arm_a);
}

Vec3 site_velocity(const ImpactWork& work, std::span<const BodyState> bodies) {
    return transpose(work.frame) * velocity_of(*work.site, bodies);
}

double normal_velocity(const ImpactWork& work, std::span<const BodyState> bodies) {
    const BodyState &a = bodies[work.site->a], &b = bodies[work.site->b];
    return dot(work.site->normal, b.linear_velocity - a.linear_velocity) + dot(work.turn_b, b.angular_velocity) -
           dot(work.turn_a, a.angular_velocity);
}

void apply(const ImpactWork& work, Vec3 impulse_in_frame, std::span<BodyState> bodies) {
    const ImpactSite& s = *work.site;
    const Vec3 impulse = work.frame * impulse_in_frame;
    apply_impulse(bodies[s.b], impulse, s.arm_b);
    apply_impulse(bodies[s.a], -impulse, s.arm_a);
}

void begin(ImpactSite& site, std::span<const BodyState> bodies, ImpactWork& work) {
    work = {};
    work.site = &site;
    work.velocity_before = velocity_of(site, bodies);
    work.turn_a = cross(site.arm_a, site.normal);
    work.turn_b = cross(site.arm_b, site.normal);
    site.impulse = {};
}

// Most neighbours never approach: frame and masses only for those that do.
void make_ready(ImpactWork& work, std::span<const BodyState> bodies) {
    if (work.is_ready) return;
    const ImpactSite& site = *work.site;
    work.is_ready = true;
    work.frame.z = site.normal;
    work.frame.x = any_perpendicular(site.normal);
    work.frame.y = cross(work.frame.z, work.frame.x);
    const Mat3 in_world = inverse_mass_at(bodies[site.a], site.arm_a, bodies[site.b], site.arm_b);
    work.inverse_mass = transpose(work.frame) * in_world * work.frame;
}

// The end of a compression without its path. If it ends in sticking, the impulse is the one that stops the point,
// whatever the path; a slide that hardly turns goes along its mean direction. False: neither.
bool estimate_compression(const Mat3& a, const ImpactCoefficients& c, double least_cosine, ImpactState& state) {
    const Vec3 u = state.velocity;
    const double slip = std::sqrt(u.x * u.x + u.y * u.y);
    Vec3 direction = slip > 0 ? Vec3{u.x / slip, u.y / slip, 0} : Vec3{};
    for (int pass = 0; pass < 2; ++pass) {
        const Vec3 ratio{-c.friction_slide * direction.x, -c.friction_slide * direction.y, 1};
        const Vec3 rate = a * ratio;
        if (!(rate.z > 0)) return false;
        const double amount = -u.z / rate.z;
        const Vec3 end = u + rate * amount;
        const double end_slip = std::sqrt(end.x * end.x + end.y * end.y), along = end.x * u.x + end.y * u.y;
        if (along <= 0) break;
        if (along < least_cosine * slip * end_slip) return false;
        if (pass == 1) {
            state.impulse += ratio * amount;
            state.velocity = end;
            return true;
        }
        direction = normalized(direction + Vec3{end.x / end_slip, end.y / end_slip, 0});
    }

    // It stops before the approach does.
    const Vec3 stop = -solve(a, u);
    const double friction = c.friction_slide * stop.z;
    if (!(stop.z > 0) || stop.x * stop.x + stop.y * stop.y > friction * friction) return false;
    state.impulse += stop;
    state.velocity = {};
    return true;
}

// Whether the compression of one more round may be estimated: all sites, or those that only rest on each other once
// the collision itself has been followed.
bool may_estimate(const ImpactWork& work, SlidePath path, std::size_t round) {
    return path == SlidePath::estimated || (work.site->coefficients.restitution <= 0 && round > 0);
}

// The site that approaches fastest, nullptr if none does. The earlier site wins unless a later one is faster by more
// than rounding: a patch stands before its corners.
ImpactWork* fastest_site(std::vector<ImpactWork>& works, std::span<const BodyState> bodies, double tolerance,
                         double rounding) {
    ImpactWork* worst = nullptr;
    double speed = -tolerance;
    for (ImpactWork& work : works) {
        const double velocity = normal_velocity(work, bodies);
        if (velocity >= speed - rounding) continue;
        worst = &work;
        speed = velocity;
    }
    return worst;
}

// Compresses until no site approaches. Returns how many sites took part, or -1 where the rounds were not enough.
int compress_all(std::vector<ImpactWork>& works, std::span<BodyState> bodies, SlidePath path) {
    double fastest = 0;
    for (const ImpactWork& work : works) {
        fastest = std::max(fastest, -dot(work.velocity_before, work.site->normal));
    }
    // Many sites need not come to the last digit: the substeps hold what is left.
    const bool is_rough = works.size() > 8 || path == SlidePath::estimated;
    const double tolerance = (path == SlidePath::estimated ? 1e-2 : is_rough ? 1e-2 : 1e-4) * fastest + 1e-12;
    const ImpactPrecision fine{.step_share = 0.25, .end_share = 1e-6, .stop_speed = slide_rounding * fastest};
    const ImpactPrecision coarse{.step_share = 0.5, .end_share = 1e-3, .stop_speed = 1e-3 * fastest};
    const std::size_t most_rounds = 64 + 64 * works.size();
    for (std::size_t round = 0; round < most_rounds; ++round) {
        ImpactWork* worst = fastest_site(works, bodies, tolerance, 1e-9 * fastest);
        if (!worst) {
            return static_cast<int>(std::count_if(works.begin(), works.end(),
                                                  [](const ImpactWork& work) { return work.state.impulse.z > 0; }));
        }
        make_ready(*worst, bodies);
        const Vec3 before = worst->state.impulse;
        const ImpactCoefficients& coefficients = worst->site->coefficients;
        worst->state.velocity = site_velocity(*worst, bodies);
        const double approach = -worst->state.velocity.z;
        const bool is_done =
            may_estimate(*worst, path, round) &&
            estimate_compression(worst->inverse_mass, coefficients, round == 0 ? 0.9 : 0.5, worst->state);
        if (is_done) {
            // Along a straight path.
            worst->compression_work += 0.5 * approach * (worst->state.impulse.z - before.z);
        } else {
            const bool is_fine = round == 0 && path == SlidePath::followed;
            compress(worst->inverse_mass, coefficients, worst->state, is_fine ? fine : coarse);
            worst->compression_work -= worst->state.normal_work;
        }
        apply(*worst, worst->state.impulse - before, bodies);
    }
    return -1;
}

// Stronge's expansion of a site that collided alone.
void expand_alone(ImpactWork& work, std::span<BodyState> bodies, SlidePath path) {
    ImpactPrecision precision =
        path == SlidePath::estimated ? ImpactPrecision{.step_share = 0.5, .end_share = 1e-3} : ImpactPrecision{};
    // A slide that stopped with the compression has left no direction to slide on along, but its rounding.
    precision.stop_speed = slide_rounding * length(work.velocity_before);
    const double e = work.site->coefficients.restitution;
    const Vec3 before = work.state.impulse;
    work.state.velocity = site_velocity(work, bodies);
    release(work.inverse_mass, work.site->coefficients, e * e * work.compression_work, work.state, precision);
    work.expansion = work.state.impulse - before;
    apply(work, work.expansion, bodies);
}

// What friction may do during the expansion: stop the sliding, within the cone of the expansion's normal impulse.
Vec3 expansion_friction(const ImpactWork& work, std::span<const BodyState> bodies) {
    const Vec3 u = site_velocity(work, bodies);
    const Mat3& a = work.inverse_mass;
    const double det = a.x.x * a.y.y - a.y.x * a.x.y;
    if (!(det > 0)) return {};
    const Vec3 stop{-(a.y.y * u.x - a.y.x * u.y) / det, -(a.x.x * u.y - a.x.y * u.x) / det, 0};
    const double limit = work.site->coefficients.friction_slide * work.expansion.z;
    const double size = length(stop);
    return size > limit ? stop * (limit / size) : stop;
}

void expand_together(std::vector<ImpactWork>& works, std::span<BodyState> bodies) {
    for (ImpactWork& work : works) {
        work.expansion = {0, 0, work.site->coefficients.restitution * work.state.impulse.z};
        if (work.expansion.z > 0) apply(work, work.expansion, bodies);
    }
    for (ImpactWork& work : works) {
        if (work.expansion.z <= 0 || work.site->coefficients.friction_slide <= 0) continue;
        const Vec3 friction = expansion_friction(work, bodies);
        work.expansion += friction;
        apply(work, friction, bodies);
    }
}

// Change of the kinetic energy since the start, J: each site's impulse times its mean velocity.
double energy_change(const std::vector<ImpactWork>& works, std::span<const BodyState> bodies) {
    double sum = 0;
    for (const ImpactWork& work : works) {
        if (work.site->impulse == Vec3{}) continue;
        sum += 0.5 * dot(work.site->impulse, work.velocity_before + velocity_of(*work.site, bodies));
    }
    return sum;
}

void sum_impulses(std::vector<ImpactWork>& works) {
    for (ImpactWork& work : works) {
        if (work.is_ready) work.site->impulse = work.frame * (work.compression + work.expansion);
    }
}

// Takes the part 1 − share of the expansion back, with the largest share that does not add energy: in the share the
// energy is T_c + b s + c s².
void limit_expansion(std::vector<ImpactWork>& works, std::span<BodyState> bodies) {
    sum_impulses(works);
    const double excess = energy_change(works, bodies);
    if (excess <= 0) return;
    double after = 0, product = 0;
    for (const ImpactWork& work : works) after += dot(work.expansion, site_velocity(work, bodies));
    for (ImpactWork& work : works) apply(work, -work.expansion, bodies);
    double before = 0;
    for (const ImpactWork& work : works) before += dot(work.expansion, site_velocity(work, bodies));
    product = after - before;

    // Roots of ½ product s² + before s + (excess − before − ½ product) = 0: the smaller energy change at s = 0 is <= 0.
    const double constant = excess - before - 0.5 * product;
    const double discriminant = before * before - 2 * product * constant;
    double share = 0;
    if (product > 0 && discriminant >= 0) share = std::clamp((-before + std::sqrt(discriminant)) / product, 0.0, 1.0);
    for (ImpactWork& work : works) {
        work.expansion *= share;
        apply(work, work.expansion, bodies);
    }
    sum_impulses(works);
}

// Restitution of all sites. Returns whether there was any.
bool expand(std::vector<ImpactWork>& works, std::span<BodyState> bodies, int taking_part, SlidePath path) {
    bool any = false;
    for (ImpactWork& work : works) {
        work.compression = work.state.impulse;
        any = any || (work.compression.z > 0 && work.site->coefficients.restitution > 0);
    }
    if (!any) return false;
    if (taking_part == 1) {
        for (ImpactWork& work : works) {
            if (work.compression_work > 0) expand_alone(work, bodies, path);
        }
    } else {
        expand_together(works, bodies);
    }
    limit_expansion(works, bodies);
    for (ImpactWork& work : works) work.state.impulse = work.compression + work.expansion;
    return true;
}

}  // namespace

ImpactReport solve_impact_group(std::span<ImpactSite> sites, std::span<BodyState> bodies, ImpactGroupMemory& memory,
                                SlidePath path) {
    std::vector<ImpactWork>& works = memory.works;
    works.resize(sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) begin(sites[i], bodies, works[i]);

    // Compression and expansion; what that drives together again is stopped without a bounce.
    ImpactReport report;
    const int taking_part = compress_all(works, bodies, path);
    report.converged = taking_part >= 0;
    const bool expanded = expand(works, bodies, taking_part, path);
    if (expanded && works.size() > 1 && report.converged) report.converged = compress_all(works, bodies, path) >= 0;

    for (ImpactWork& work : works) {
        if (work.is_ready) work.site->impulse = work.frame * work.state.impulse;
    }
    report.energy_change = energy_change(works, bodies);
    return report;
}

}  // namespace embody::physics
