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

// A site with its frame and what has happened to it.
struct Work {
    ImpactSite* site;
    Mat3 frame;            // columns t1, t2, n
    Mat3 inverse_mass;     // A of eq. (3) in the frame
    Vec3 velocity_before;  // in the frame
    ImpactState state;
    double compression_work = 0;
    Vec3 expansion;  // impulse in the frame
};

Vec3 site_velocity(const Work& work, std::span<const BodyState> bodies) {
    const ImpactSite& s = *work.site;
    return transpose(work.frame) * (velocity_at(bodies[s.b], s.arm_b) - velocity_at(bodies[s.a], s.arm_a));
}

void apply(const Work& work, Vec3 impulse_in_frame, std::span<BodyState> bodies) {
    const ImpactSite& s = *work.site;
    const Vec3 impulse = work.frame * impulse_in_frame;
    apply_impulse(bodies[s.b], impulse, s.arm_b);
    apply_impulse(bodies[s.a], -impulse, s.arm_a);
}

Work begin(ImpactSite& site, std::span<const BodyState> bodies) {
    Work work;
    work.site = &site;
    work.frame.z = site.normal;
    work.frame.x = any_perpendicular(site.normal);
    work.frame.y = cross(work.frame.z, work.frame.x);
    const Mat3 in_world = inverse_mass_at(bodies[site.a], site.arm_a, bodies[site.b], site.arm_b);
    work.inverse_mass = transpose(work.frame) * in_world * work.frame;
    work.velocity_before = site_velocity(work, bodies);
    return work;
}

// Compresses until no site approaches. Returns how many sites took part, or -1 where the rounds were not enough.
int compress_all(std::vector<Work>& works, std::span<BodyState> bodies) {
    double fastest = 0;
    for (const Work& work : works) fastest = std::max(fastest, -work.velocity_before.z);
    // Many sites need not come to the last digit: the substeps hold what is left.
    const double tolerance = (works.size() > 8 ? 1e-2 : 1e-4) * fastest + 1e-12;
    const ImpactPrecision fine{.step_share = 0.25, .end_share = 1e-6, .stop_speed = 1e-5 * fastest};
    const ImpactPrecision coarse{.step_share = 0.5, .end_share = 1e-3, .stop_speed = 1e-3 * fastest};
    const std::size_t most_rounds = 64 + 64 * works.size();
    for (std::size_t round = 0; round < most_rounds; ++round) {
        // The earlier site wins unless a later one is faster by more than rounding: a patch stands before its corners.
        Work* worst = nullptr;
        double speed = -tolerance;
        for (Work& work : works) {
            const double normal_velocity = site_velocity(work, bodies).z;
            if (normal_velocity < speed - 1e-9 * fastest) {
                worst = &work;
                speed = normal_velocity;
            }
        }
        if (!worst) {
            return static_cast<int>(
                std::count_if(works.begin(), works.end(), [](const Work& work) { return work.state.impulse.z > 0; }));
        }
        const Vec3 before = worst->state.impulse;
        worst->state.velocity = site_velocity(*worst, bodies);
        compress(worst->inverse_mass, worst->site->coefficients, worst->state, round == 0 ? fine : coarse);
        worst->compression_work -= worst->state.normal_work;
        apply(*worst, worst->state.impulse - before, bodies);
    }
    return -1;
}

// Stronge's expansion of a site that collided alone.
void expand_alone(Work& work, std::span<BodyState> bodies) {
    const double e = work.site->coefficients.restitution;
    const Vec3 before = work.state.impulse;
    work.state.velocity = site_velocity(work, bodies);
    release(work.inverse_mass, work.site->coefficients, e * e * work.compression_work, work.state);
    work.expansion = work.state.impulse - before;
    apply(work, work.expansion, bodies);
}

// What friction may do during the expansion: stop the sliding, within the cone of the expansion's normal impulse.
Vec3 expansion_friction(const Work& work, std::span<const BodyState> bodies) {
    const Vec3 u = site_velocity(work, bodies);
    const Mat3& a = work.inverse_mass;
    const double det = a.x.x * a.y.y - a.y.x * a.x.y;
    if (!(det > 0)) return {};
    const Vec3 stop{-(a.y.y * u.x - a.y.x * u.y) / det, -(a.x.x * u.y - a.x.y * u.x) / det, 0};
    const double limit = work.site->coefficients.friction_slide * work.expansion.z;
    const double size = length(stop);
    return size > limit ? stop * (limit / size) : stop;
}

void expand_together(std::vector<Work>& works, std::span<BodyState> bodies) {
    for (Work& work : works) {
        work.expansion = {0, 0, work.site->coefficients.restitution * work.state.impulse.z};
        if (work.expansion.z > 0) apply(work, work.expansion, bodies);
    }
    for (Work& work : works) {
        if (work.expansion.z <= 0 || work.site->coefficients.friction_slide <= 0) continue;
        const Vec3 friction = expansion_friction(work, bodies);
        work.expansion += friction;
        apply(work, friction, bodies);
    }
}

// Change of the kinetic energy since the start, J: each site's impulse times its mean velocity.
double energy_change(const std::vector<Work>& works, std::span<const BodyState> bodies) {
    double sum = 0;
    for (const Work& work : works) {
        sum += 0.5 * dot(work.site->impulse, work.frame * (work.velocity_before + site_velocity(work, bodies)));
    }
    return sum;
}

void sum_impulses(std::vector<Work>& works, const std::vector<Vec3>& compression) {
    for (std::size_t i = 0; i < works.size(); ++i) {
        works[i].site->impulse = works[i].frame * (compression[i] + works[i].expansion);
    }
}

// Takes the part 1 − share of the expansion back, with the largest share that does not add energy: in the share the
// energy is T_c + b s + c s².
void limit_expansion(std::vector<Work>& works, const std::vector<Vec3>& compression, std::span<BodyState> bodies) {
    sum_impulses(works, compression);
    const double excess = energy_change(works, bodies);
    if (excess <= 0) return;
    double after = 0, product = 0;
    for (const Work& work : works) after += dot(work.expansion, site_velocity(work, bodies));
    for (Work& work : works) apply(work, -work.expansion, bodies);
    double before = 0;
    for (const Work& work : works) before += dot(work.expansion, site_velocity(work, bodies));
    product = after - before;

    // Roots of ½ product s² + before s + (excess − before − ½ product) = 0: the smaller energy change at s = 0 is <= 0.
    const double constant = excess - before - 0.5 * product;
    const double discriminant = before * before - 2 * product * constant;
    double share = 0;
    if (product > 0 && discriminant >= 0) share = std::clamp((-before + std::sqrt(discriminant)) / product, 0.0, 1.0);
    for (Work& work : works) {
        work.expansion *= share;
        apply(work, work.expansion, bodies);
    }
    sum_impulses(works, compression);
}

}  // namespace

ImpactReport solve_impact_group(std::span<ImpactSite> sites, std::span<BodyState> bodies) {
    std::vector<Work> works;
    works.reserve(sites.size());
    for (ImpactSite& site : sites) works.push_back(begin(site, bodies));

    ImpactReport report;
    const int taking_part = compress_all(works, bodies);
    report.converged = taking_part >= 0;
    std::vector<Vec3> compression;
    compression.reserve(works.size());
    for (const Work& work : works) compression.push_back(work.state.impulse);

    // Expansion; what it drives together again is stopped without a bounce.
    if (taking_part == 1) {
        for (Work& work : works) {
            if (work.compression_work > 0) expand_alone(work, bodies);
        }
    } else {
        expand_together(works, bodies);
    }
    limit_expansion(works, compression, bodies);
    for (std::size_t i = 0; i < works.size(); ++i) works[i].state.impulse = compression[i] + works[i].expansion;
    if (works.size() > 1 && report.converged) report.converged = compress_all(works, bodies) >= 0;

    for (Work& work : works) work.site->impulse = work.frame * work.state.impulse;
    report.energy_change = energy_change(works, bodies);
    return report;
}

}  // namespace embody::physics
