// SPDX-License-Identifier: MIT
//
// Several micro-collisions (paper, eq. 3) at once. Sources: B. Mirtich, "Impulse-based dynamic simulation of rigid body
// systems", 1996 (one after the other, the most negative normal velocity first); Ch. Glocker, F. Pfeiffer, "Multiple
// impacts with friction in rigid multibody systems", 1995 (compression of all contacts, then expansion of all).
//   compression  repeat: the site that approaches fastest runs eq. (3) until it no longer approaches; those of other
//                pairs of bodies that are as fast do so together, which keeps a symmetric collision symmetric
//   expansion    one site alone: eq. (3) on, until the normal work e² W_c is given back (Stronge)
//                several: each gives back e of its normal impulse at once, so that a symmetric collision stays
//                symmetric whatever the order was; without friction this is e² of the energy, too
//   joints       impulses act on all jointed bodies at once: A of eq. (3) by their response (impact_joints.h)
//   guard        the kinetic energy after <= before (eq. 5 and 6 hold by construction), else the expansion is scaled
#include "physics/constraint/impact/impact_group.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/constraint/contact/contact.h"

namespace embody::physics::constraint {

namespace {

constexpr double symmetric_rounding = 1e-9;  // of the fastest approach: sites as fast as each other differ by 1e-15
constexpr double speed_rounding = 1e-12;     // m/s: approaches that rounding leaves where nothing moves

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

bool is_jointed(const ImpactWork& work, std::uint32_t body) { return work.joints && work.joints->number_of(body) >= 0; }

void apply(const ImpactWork& work, Vec3 impulse_in_frame, std::span<BodyState> bodies) {
    const ImpactSite& s = *work.site;
    const Vec3 impulse = work.frame * impulse_in_frame;
    if (!is_jointed(work, s.b)) apply_impulse(bodies[s.b], impulse, s.arm_b);
    if (!is_jointed(work, s.a)) apply_impulse(bodies[s.a], -impulse, s.arm_a);
    if (!work.joints) return;
    const Vec6* response = work.response;
    for (const std::uint32_t body : work.joints->bodies()) {
        for (int axis = 0; axis < 3; ++axis, ++response) {
            bodies[body].linear_velocity += response->linear() * impulse_in_frame[axis];
            bodies[body].angular_velocity += response->angular() * impulse_in_frame[axis];
        }
    }
}

// The jointed bodies' responses, and A of eq. (3) by them: its columns are the changes of the site's velocity.
void find_responses(ImpactWork& work, std::span<const BodyState> bodies) {
    const ImpactSite& s = *work.site;
    std::array<Vec3, 3> columns;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 direction = work.frame.column(axis);
        const std::array<ImpactJoints::Push, 2> pushes{{{s.b, direction, s.arm_b}, {s.a, -direction, s.arm_a}}};
        const std::span<const Vec6> changes = work.joints->respond(pushes);
        const auto change_at = [&](const ImpactJoints::Push& push) {
            const int number = work.joints->number_of(push.body);
            const BodyState& body = bodies[push.body];
            const Vec6 change = number >= 0 ? changes[static_cast<std::size_t>(number)]
                                            : make_vec6(push.impulse * body.inverse_mass,
                                                        body.inverse_inertia * cross(push.arm, push.impulse));
            return change.linear() + cross(change.angular(), push.arm);
        };
        columns[static_cast<std::size_t>(axis)] = transpose(work.frame) * (change_at(pushes[0]) - change_at(pushes[1]));
        for (std::size_t i = 0; i < changes.size(); ++i)
            work.response[3 * i + static_cast<std::size_t>(axis)] = changes[i];
    }
    work.inverse_mass = {columns[0], columns[1], columns[2]};
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
    if (work.joints) {
        find_responses(work, bodies);
        return;
    }
    const Mat3 in_world = inverse_mass_at(bodies[site.a], site.arm_a, bodies[site.b], site.arm_b);
    work.inverse_mass = transpose(work.frame) * in_world * work.frame;
}

// The end of a compression without following its path. If it ends in sticking, the impulse is the one that stops the
// point, whatever the path; a slide that hardly turns is taken along its mean direction. False where neither holds.
bool estimate_compression(const Mat3& a, const ImpactCoefficients& c, double min_cosine, ImpactState& state) {
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
        if (along < min_cosine * slip * end_slip) return false;
        if (pass == 1) {
            state.impulse += ratio * amount;
            state.velocity = end;
            return true;
        }
        direction = normalized(direction + Vec3{end.x / end_slip, end.y / end_slip, 0});
    }

    // The sliding stops before the approach does.
    const Vec3 stop = -solve(a, u);
    const double friction = c.friction_slide * stop.z;
    if (!(stop.z > 0) || stop.x * stop.x + stop.y * stop.y > friction * friction) return false;
    state.impulse += stop;
    state.velocity = {};
    return true;
}

// Whether the compressions of the next iteration may be estimated: those of all sites, or those of sites that only rest
// on each other, once the collision itself has been followed.
bool may_estimate(const ImpactWork& work, SlidePath path, std::size_t iteration) {
    return path == SlidePath::estimated || (work.site->coefficients.restitution <= 0 && iteration > 0);
}

bool is_same_pair(const ImpactWork& x, const ImpactWork& y) { return x.site->a == y.site->a && x.site->b == y.site->b; }

// The sites that approach fastest, none if none does: one of each pair of bodies, the earlier one unless a later one is
// faster by more than rounding (a patch stands before its corners). Sites that are as fast are compressed together, so
// that a symmetric collision stays symmetric.
void find_fastest(std::vector<ImpactWork>& works, std::span<const BodyState> bodies, double tolerance, double rounding,
                  std::vector<ImpactWork*>& fastest) {
    fastest.clear();
    double speed = -tolerance;
    for (ImpactWork& work : works) {
        const double velocity = normal_velocity(work, bodies);
        if (velocity >= speed + rounding || velocity >= -tolerance) continue;
        const auto is_of_pair = [&](const ImpactWork* other) { return is_same_pair(*other, work); };
        if (velocity < speed - rounding) {
            fastest.clear();
            speed = velocity;
        } else if (fastest.empty() || std::any_of(fastest.begin(), fastest.end(), is_of_pair)) {
            continue;
        }
        fastest.push_back(&work);
    }
}

/// How the compression of a group is followed.
struct CompressionRules {
    const ImpactSolverSettings& settings;
    SlidePath path;
    double tolerance;  // m/s of approach that may be left
    double fastest;    // of the approaches at the start, m/s
};

// Compresses one site as if it were alone: its state after it, and its normal work. The bodies stay as they are.
void compress_alone(ImpactWork& work, std::span<const BodyState> bodies, const CompressionRules& rules,
                    std::size_t iteration) {
    make_ready(work, bodies);
    const Vec3 before = work.state.impulse;
    const ImpactCoefficients& coefficients = work.site->coefficients;
    work.state.velocity = site_velocity(work, bodies);
    const double approach = -work.state.velocity.z;
    const ImpactSolverSettings& settings = rules.settings;
    const double min_cosine = iteration == 0 ? settings.straight_cosine : settings.straight_cosine_later;
    if (may_estimate(work, rules.path, iteration) &&
        estimate_compression(work.inverse_mass, coefficients, min_cosine, work.state)) {
        // Along a straight path.
        work.state.normal_work = -0.5 * approach * (work.state.impulse.z - before.z);
        return;
    }
    const bool is_fine = iteration == 0 && rules.path == SlidePath::followed;
    compress(work.inverse_mass, coefficients, work.state,
             is_fine ? ImpactPrecision{.step_fraction = settings.step_fraction,
                                       .end_fraction = settings.end_fraction,
                                       .stop_speed = settings.slide_tolerance * rules.fastest}
                     : ImpactPrecision{.step_fraction = settings.rough_step_fraction,
                                       .end_fraction = settings.rough_end_fraction,
                                       .stop_speed = settings.rough_slide_tolerance * rules.fastest});
}

// Compresses these sites at once: each as if it were alone, then all by the same fraction, so far that the first of
// them no longer approaches.
void compress_together(std::span<ImpactWork* const> sites, std::span<BodyState> bodies, const CompressionRules& rules,
                       std::size_t iteration, std::vector<Vec3>& impulses) {
    impulses.clear();
    for (ImpactWork* work : sites) {
        const Vec3 before = work->state.impulse;
        compress_alone(*work, bodies, rules, iteration);
        impulses.push_back(work->state.impulse - before);
        work->state.impulse = before;
        work->velocity = normal_velocity(*work, bodies);
    }
    for (std::size_t i = 0; i < sites.size(); ++i) apply(*sites[i], impulses[i], bodies);
    double fraction = 1;
    for (const ImpactWork* work : sites) {
        const double change = normal_velocity(*work, bodies) - work->velocity;
        if (change > 0) fraction = std::min(fraction, -work->velocity / change);
    }
    for (std::size_t i = 0; i < sites.size(); ++i) {
        ImpactWork& work = *sites[i];
        if (fraction < 1) apply(work, impulses[i] * (fraction - 1), bodies);
        work.state.impulse += impulses[i] * fraction;
    }
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const double mean = (sites[i]->velocity + normal_velocity(*sites[i], bodies)) / 2;
        sites[i]->compression_work -= mean * impulses[i].z * fraction;
    }
}

// Compresses until no site approaches. Returns how many sites took part, or -1 where the iterations were not enough.
int compress_all(ImpactGroupMemory& memory, std::span<BodyState> bodies, const ImpactSolverSettings& settings,
                 SlidePath path) {
    std::vector<ImpactWork>& works = memory.works;
    double fastest = 0;
    for (const ImpactWork& work : works) {
        fastest = std::max(fastest, -dot(work.velocity_before, work.site->normal));
    }
    // Many sites need not come to the last digit: the substeps hold what is left.
    const bool is_rough = works.size() > settings.rough_sites || path == SlidePath::estimated;
    const double tolerance = is_rough ? settings.rough_approach_tolerance : settings.approach_tolerance;
    const CompressionRules rules{settings, path, tolerance * fastest + speed_rounding, fastest};
    const std::size_t max_iterations = settings.base_iterations + settings.iterations_per_site * works.size();
    for (std::size_t iteration = 0; iteration < max_iterations; ++iteration) {
        find_fastest(works, bodies, rules.tolerance, symmetric_rounding * fastest, memory.fastest);
        if (memory.fastest.empty()) {
            return static_cast<int>(std::count_if(works.begin(), works.end(),
                                                  [](const ImpactWork& work) { return work.state.impulse.z > 0; }));
        }
        if (memory.fastest.size() > 1) {
            compress_together(memory.fastest, bodies, rules, iteration, memory.impulses);
            continue;
        }
        ImpactWork& work = *memory.fastest.front();
        const Vec3 before = work.state.impulse;
        compress_alone(work, bodies, rules, iteration);
        work.compression_work -= work.state.normal_work;
        apply(work, work.state.impulse - before, bodies);
    }
    return -1;
}

// Stronge's expansion of a site that collided alone.
void expand_alone(ImpactWork& work, std::span<BodyState> bodies, const ImpactSolverSettings& settings, SlidePath path) {
    ImpactPrecision precision{.step_fraction = settings.expansion_step_fraction,
                              .end_fraction = settings.expansion_end_fraction};
    if (path == SlidePath::estimated) {
        precision = {.step_fraction = settings.rough_step_fraction, .end_fraction = settings.rough_end_fraction};
    }
    // After a slide that stopped with the compression, the direction to slide on along is only rounding.
    precision.stop_speed = settings.slide_tolerance * length(work.velocity_before);
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

// Numbers the sites of each pair of bodies.
void set_places(std::vector<ImpactWork>& works) {
    for (std::size_t i = 0; i < works.size(); ++i) {
        const auto is_of_pair = [&](const ImpactWork& other) { return is_same_pair(other, works[i]); };
        const auto own = works.begin() + static_cast<std::ptrdiff_t>(i);
        works[i].place = static_cast<std::size_t>(std::count_if(works.begin(), own, is_of_pair));
    }
}

// Of bodies, among the sites that bounce.
std::size_t count_bouncing_pairs(const std::vector<ImpactWork>& works) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < works.size(); ++i) {
        const auto bounces = [&](const ImpactWork& other) {
            return other.expansion.z > 0 && is_same_pair(other, works[i]);
        };
        const auto end = works.begin() + static_cast<std::ptrdiff_t>(i);
        if (works[i].expansion.z > 0 && std::none_of(works.begin(), end, bounces)) ++count;
    }
    return count;
}

void expand_together(std::vector<ImpactWork>& works, std::span<BodyState> bodies) {
    for (ImpactWork& work : works) {
        work.expansion = {0, 0, work.site->coefficients.restitution * work.state.impulse.z};
        if (work.expansion.z > 0) apply(work, work.expansion, bodies);
    }

    // The sites of one pair one after the other; those of several pairs at once, in as many equal parts.
    const std::size_t pairs = count_bouncing_pairs(works);
    set_places(works);
    std::size_t places = 0;
    for (const ImpactWork& work : works) places = std::max(places, work.place + 1);
    for (std::size_t part = 0; part < pairs; ++part) {
        for (std::size_t place = 0; place < places; ++place) {
            for (ImpactWork& work : works) {
                work.friction = {};
                if (work.place != place || work.expansion.z <= 0 || work.site->coefficients.friction_slide <= 0)
                    continue;
                work.friction = expansion_friction(work, bodies) / static_cast<double>(pairs);
            }
            for (ImpactWork& work : works) {
                if (work.friction == Vec3{}) continue;
                work.expansion += work.friction;
                apply(work, work.friction, bodies);
            }
        }
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

// Takes the part 1 − s of the expansion back, with the largest fraction s that does not add energy: the energy is T_c +
// b s + c s².
void limit_expansion(std::vector<ImpactWork>& works, std::span<BodyState> bodies) {
    sum_impulses(works);
    const double excess = energy_change(works, bodies);
    if (excess <= 0) return;
    double after = 0, product = 0;
    for (const ImpactWork& work : works) after += dot(work.expansion, site_velocity(work, bodies));
    for (const ImpactWork& work : works) {
        if (work.is_ready) apply(work, -work.expansion, bodies);
    }
    double before = 0;
    for (const ImpactWork& work : works) before += dot(work.expansion, site_velocity(work, bodies));
    product = after - before;

    // Roots of ½ product s² + before s + (excess − before − ½ product) = 0: the smaller energy change at s = 0 is <= 0.
    const double constant = excess - before - 0.5 * product;
    const double discriminant = before * before - 2 * product * constant;
    double fraction = 0;
    if (product > 0 && discriminant >= 0)
        fraction = std::clamp((-before + std::sqrt(discriminant)) / product, 0.0, 1.0);
    for (ImpactWork& work : works) {
        work.expansion *= fraction;
        if (work.is_ready) apply(work, work.expansion, bodies);
    }
    sum_impulses(works);
}

// Restitution of all sites. Returns whether there was any.
bool expand(std::vector<ImpactWork>& works, std::span<BodyState> bodies, int taking_part,
            const ImpactSolverSettings& settings, SlidePath path) {
    bool any = false;
    for (ImpactWork& work : works) {
        work.compression = work.state.impulse;
        any = any || (work.compression.z > 0 && work.site->coefficients.restitution > 0);
    }
    if (!any) return false;
    if (taking_part == 1) {
        for (ImpactWork& work : works) {
            if (work.compression_work > 0) expand_alone(work, bodies, settings, path);
        }
    } else {
        expand_together(works, bodies);
    }
    limit_expansion(works, bodies);
    for (ImpactWork& work : works) work.state.impulse = work.compression + work.expansion;
    return true;
}

// Where the responses of jointed bodies will be written.
void list_responses(std::vector<ImpactWork>& works, ImpactGroupMemory& memory) {
    const std::size_t size = 3 * memory.joints.bodies().size();
    if (size == 0) return;
    memory.responses.resize(size * works.size());
    for (std::size_t i = 0; i < works.size(); ++i) {
        const ImpactSite& site = *works[i].site;
        if (memory.joints.number_of(site.a) < 0 && memory.joints.number_of(site.b) < 0) continue;
        works[i].joints = &memory.joints;
        works[i].response = &memory.responses[size * i];
    }
}

}  // namespace

ImpactReport solve_impact_group(std::span<ImpactSite> sites, std::span<BodyState> bodies, ImpactGroupMemory& memory,
                                const ImpactSolverSettings& settings, SlidePath path) {
    std::vector<ImpactWork>& works = memory.works;
    works.resize(sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i) begin(sites[i], bodies, works[i]);
    list_responses(works, memory);

    // Compression and expansion; sites that approach again by these are stopped without a bounce.
    ImpactReport report;
    const int taking_part = compress_all(memory, bodies, settings, path);
    report.converged = taking_part >= 0;
    const bool expanded = expand(works, bodies, taking_part, settings, path);
    if (expanded && works.size() > 1 && report.converged)
        report.converged = compress_all(memory, bodies, settings, path) >= 0;

    for (ImpactWork& work : works) {
        if (work.is_ready) work.site->impulse = work.frame * work.state.impulse;
    }
    report.energy_change = energy_change(works, bodies);
    return report;
}

}  // namespace embody::physics::constraint
