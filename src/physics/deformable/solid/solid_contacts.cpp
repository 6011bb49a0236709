// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/solid_contacts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <iterator>

namespace embody::physics::deformable {

namespace {

constexpr double max_finite_gap = 1e3;  // m: gaps beyond belong to solids whose numbers have broken

Vec3 position(const CarriedPoint& point, SolidContacts::Solids solids) {
    Vec3 sum;
    for (std::size_t k = 0; k < point.count; ++k)
        sum += point.weight[k] * solids[point.solid]->nodes().position[point.node[k]];
    return sum;
}

Vec3 start_position(const CarriedPoint& point, SolidContacts::Solids solids) {
    Vec3 sum;
    for (std::size_t k = 0; k < point.count; ++k) sum += point.weight[k] * solids[point.solid]->start(point.node[k]);
    return sum;
}

// What bears a body acts on it with the force that it had, once a substep.
void begin_supports(TouchedBody& body, double h, double time) {
    for (BodySupport& support : body.supports) {
        const Vec3 arm = support.turns ? body.rotation_before(h, time) * support.anchor : support.anchor;
        if (support.force != support.given) body.bear(-h * (support.force - support.given), arm, h);
        support.given = support.force;
    }
}

}  // namespace

void SolidContacts::begin(std::span<const SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies,
                          double h, double time) {
    for (const SolidContact& contact : contacts) {
        if (contact.force == Vec3{}) continue;
        const auto push = [&](const CarriedPoint& point, double sign) {
            for (std::size_t k = 0; k < point.count; ++k)
                solids[point.solid]->push(point.node[k], sign * point.weight[k] * contact.force);
        };
        push(contact.point, 1);
        push(contact.other, -1);
        if (!contact.has_body()) continue;
        TouchedBody& body = bodies[contact.body];
        body.push(-h * contact.force, body.rotation_before(h, time) * contact.anchor, h);
        begin_supports(body, h, time);
    }
}

void SolidContacts::solve(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies,
                          const Substep& substep, TaskPool& workers) {
    const double h = substep.h;
    settings_ = substep.settings;
    gather(contacts, solids, bodies, h, substep.time);
    gather_supports(bodies, h, substep.time);
    for (std::size_t s = 0; s < solids.size(); ++s) touched_[s].complete(*solids[s], workers);
    for (Active& active : active_) find_compliance(active, h);
    find_groups(solids.size(), bodies);
    probe_forces_.assign(bodies.size(), {});
    probe_torques_.assign(bodies.size(), {});
    find_forces(h, workers);
    for (const Active& active : active_) note_sticking(active, h);
    end_supports();
    for (std::size_t s = 0; s < solids.size(); ++s) {
        const TouchedNodes& touched = touched_[s];
        if (!touched.is_pushed()) continue;
        for (std::size_t k = 0; k < touched.size(); ++k) solids[s]->push(touched.node(k), touched.force(k));
        solids[s]->settle(workers);
    }
}

// A group with more than half of the work is solved by all workers together, the others by one worker each.
void SolidContacts::find_forces(double h, TaskPool& workers) {
    if (groups_.empty()) return;
    std::size_t first_parallel = 0;
    if (2 * groups_[0].active.size() > active_.size()) find_forces(groups_[first_parallel++], h, workers);
    std::atomic<std::size_t> next = first_parallel;
    const auto work = [&](int) {
        TaskPool alone(1);
        for (std::size_t g = next++; g < groups_.size(); g = next++) find_forces(groups_[g], h, alone);
    };
    if (groups_.size() > first_parallel + 1 && workers.workers() > 1)
        workers.run(work);
    else
        work(0);
}

// Solids and bodies are joined by contacts; bodies that do not move join nothing. Larger groups first, so that workers
// end at about the same time.
void SolidContacts::find_groups(std::size_t solids, std::span<const TouchedBody> bodies) {
    std::vector<std::uint32_t> joined(solids + bodies.size());
    for (std::uint32_t i = 0; i < joined.size(); ++i) joined[i] = i;
    const auto root_of = [&](std::uint32_t i) {
        while (joined[i] != i) i = joined[i] = joined[joined[i]];
        return i;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        a = root_of(a);
        b = root_of(b);
        joined[std::max(a, b)] = std::min(a, b);
    };
    const auto first_body = static_cast<std::uint32_t>(solids);
    for (const Active& active : active_) {
        const SolidContact& contact = *active.contact;
        if (!contact.has_body())
            join(contact.point.solid, contact.other.solid);
        else if (active.support == nullptr && bodies[contact.body].is_dynamic)
            join(contact.point.solid, first_body + contact.body);
    }
    std::vector<std::uint32_t> group_of(joined.size(), 0xFFFFFFFF);
    groups_.clear();
    for (Active& active : active_) {
        const SolidContact& contact = *active.contact;
        std::uint32_t& group =
            group_of[root_of(active.support != nullptr ? first_body + contact.body : contact.point.solid)];
        if (group == 0xFFFFFFFF) {
            group = static_cast<std::uint32_t>(groups_.size());
            groups_.emplace_back();
        }
        groups_[group].active.push_back(&active);
    }
    for (std::uint32_t i = 0; i < joined.size(); ++i) {
        const std::uint32_t group = group_of[root_of(i)];
        if (group == 0xFFFFFFFF) continue;
        if (i < first_body)
            groups_[group].solids.push_back(i);
        else
            groups_[group].bodies.push_back(i - first_body);
    }
    std::ranges::stable_sort(groups_, std::greater{}, [](const Group& group) { return group.active.size(); });
}

// Sweeps find which contacts hold, stick and slide; the conjugate gradient solves for the forces of these at once (M.
// Silcowitz, S. Niebe, K. Erleben, "Projected Gauss-Seidel subspace minimization method", 2010), as long as that helps.
// Where many contacts are nearly redundant, sweeps with conjugate directions go on (by the same, "A nonsmooth nonlinear
// conjugate gradient method for interactive contact force problems", 2010).
void SolidContacts::find_forces(const Group& group, double h, TaskPool& workers) {
    const auto sweeps = [&] {
        double moved = 0;
        for (int k = 0; k < settings_.sweeps_per_iteration && (k == 0 || moved > settings_.sweep_tolerance); ++k)
            moved = sweep(group, h, k % 2 == 0);
        return moved;
    };
    double moved = sweeps(), best = moved;
    double slid = 0;
    for (const Active* active : group.active) slid = std::max(slid, length(active->slid));
    const double enough = std::max({settings_.sweep_tolerance, settings_.sweep_tolerance_of_first * moved,
                                    settings_.sweep_tolerance_of_slip * slid});
    const auto keep = [&] {
        for (Active* active : group.active) active->best = active->contact->force;
    };
    keep();
    for (int iteration = 0; iteration < settings_.max_iterations && moved > enough; ++iteration) {
        solve_together(group, h, workers);
        moved = sweeps();
        if (!(moved < best)) continue;
        best = moved;
        keep();
    }
    if (moved > best) {
        for (const Active* active : group.active) apply(*active, active->best - active->contact->force, h);
        moved = best;
    }
    const int max_sweeps = settings_.max_conjugate_sweeps;
    double last = 0;
    for (int k = 0; k < max_sweeps && moved > enough; ++k) {
        for (Active* active : group.active) active->before = active->contact->force;
        moved = sweep(group, h, k % 2 == 0);
        double size = 0;
        for (const Active* active : group.active) size += length_squared(active->contact->force - active->before);
        const double factor = k > 0 && size < last ? size / last : 0;
        last = size;
        if (k + 1 < max_sweeps && moved > enough) lean_on(group, factor, h);
    }
    settle_bodies(group, h);
}

// What sweeps leave undone belongs on the solids: of a body of a thousandth of their mass the same force would be a
// blow. So the contacts of each body are swept once more, alone, the solids' others as they are.
void SolidContacts::settle_bodies(const Group& group, double h) {
    constexpr int max_sweeps = 300;  // Test: HeldBall.GainsNothingBetweenASolidAndTheFloor
    std::vector<Active*> own;
    for (const std::uint32_t body : group.bodies) {
        own.clear();
        std::ranges::copy_if(group.active, std::back_inserter(own), [&](const Active* active) {
            return active->body != nullptr && active->contact->body == body;
        });
        double moved = 2 * settings_.sweep_tolerance;
        for (int k = 0; k < max_sweeps && moved > settings_.sweep_tolerance; ++k) {
            moved = 0;
            for (std::size_t i = 0; i < own.size(); ++i)
                moved = std::max(moved, relax(*own[k % 2 == 0 ? i : own.size() - 1 - i], h));
        }
    }
}

// p ← β p + change of the sweep;  force ← force + β p
void SolidContacts::lean_on(const Group& group, double factor, double h) {
    for (Active* active : group.active) {
        const Vec3 along = factor * active->direction;
        active->direction = along + active->contact->force - active->before;
        if (along != Vec3{}) apply(*active, along, h);
    }
}

// Contacts that touch or nearly do after the free motion; others lose their forces.
void SolidContacts::gather(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h,
                           double time) {
    active_.clear();
    touched_.resize(solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s) touched_[s].begin(*solids[s]);
    for (SolidContact& contact : contacts) {
        Active active;
        active.contact = &contact;
        const Vec3 at = position(contact.point, solids), was = start_position(contact.point, solids);
        if (contact.has_body()) {
            active.body = &bodies[contact.body];
            place_against_body(active, at, was, h, time);
        } else {
            const Vec3 other = position(contact.other, solids);
            active.normal = contact.normal;
            active.gap = dot(at - other, contact.normal) - contact.radius;
            active.slid = at - was - (other - start_position(contact.other, solids));
        }
        if (!(std::fabs(active.gap) < max_finite_gap && length(active.slid) < max_finite_gap)) {
            contact.force = {};
            continue;
        }
        if (!contact.holds && contact.force == Vec3{} && active.gap > settings_.reach_radii * contact.radius) continue;
        const double gap_before = active.gap - dot(active.slid, active.normal);
        active.target = std::min(0.0, gap_before + settings_.recovery_speed * h);
        add_terms(active, contact.point, 1);
        add_terms(active, contact.other, -1);
        active_.push_back(active);
    }
}

void SolidContacts::place_against_body(Active& active, Vec3 at, Vec3 was, double h, double time) const {
    const SolidContact& contact = *active.contact;
    const TouchedBody& body = *active.body;
    const Mat3 rotation = body.rotation_at(time);
    active.normal = rotation * contact.normal;
    active.shift = body.shift;
    active.turn = body.turn;
    if (contact.holds) {
        // With the arm at the substep's start, which no push changes. The error at that time is corrected no faster
        // than overlaps are.
        active.arm = body.rotation_before(h, time) * contact.anchor;
        const Vec3 before = was - body.center_before(h, time) - active.arm;
        const double off = length(before), most = settings_.recovery_speed * h;
        active.slid = at - was - body.displacement(h, time, active.arm) + (off > most ? (most / off) * before : before);
        return;
    }
    const Vec3 center = body.center_at(time), anchor = rotation * contact.anchor;
    active.gap = dot(at - center - anchor, active.normal) - contact.radius;
    // The body's surface under the point, and its displacement in the substep.
    active.arm = at - (contact.radius + active.gap) * active.normal - center;
    active.slid = at - was - body.displacement(h, time, active.arm);
}

void SolidContacts::add_terms(Active& active, const CarriedPoint& point, double sign) {
    for (std::size_t k = 0; k < point.count; ++k) {
        active.terms[active.term_count++] = {point.solid, touched_[point.solid].number_of(point.node[k]),
                                             sign * point.weight[k]};
    }
}

void SolidContacts::find_compliance(Active& active, double h) const {
    // Of the solids: Σ wₐ w_b W_ab
    for (std::size_t a = 0; a < active.term_count; ++a) {
        for (std::size_t b = 0; b < active.term_count; ++b) {
            const Term &one = active.terms[a], &two = active.terms[b];
            if (one.solid != two.solid) continue;
            active.compliance += (one.weight * two.weight) * touched_[one.solid].block(one.number, two.number);
        }
    }
    if (active.body == nullptr) return;
    // Of the body: h² (1/m - [arm] I⁻¹ [arm])
    const Mat3 arm = skew(active.arm);
    const double inverse_mass = active.body->inverse_mass;
    active.compliance += (h * h) * (Mat3::diagonal({inverse_mass, inverse_mass, inverse_mass}) -
                                    arm * active.body->inverse_inertia * arm);
}

// Relative displacement of the two by forces of this solve.
Vec3 SolidContacts::moved(const Active& active) const {
    Vec3 sum;
    if (active.body != nullptr)
        sum = -(active.body->shift - active.shift) - cross(active.body->turn - active.turn, active.arm);
    for (std::size_t k = 0; k < active.term_count; ++k) {
        const Term& term = active.terms[k];
        sum += term.weight * touched_[term.solid].moved(term.number);
    }
    return sum;
}

void SolidContacts::apply(const Active& active, Vec3 force, double h) {
    for (std::size_t k = 0; k < active.term_count; ++k) {
        const Term& term = active.terms[k];
        touched_[term.solid].push(term.number, term.weight * force);
    }
    if (active.support != nullptr)
        active.body->bear(-h * force, active.arm, h);
    else if (active.body != nullptr)
        active.body->push(-h * force, active.arm, h);
    active.contact->force += force;
}

double SolidContacts::sweep(const Group& group, double h, bool forwards) {
    double moved = 0;
    const std::size_t count = group.active.size();
    for (std::size_t k = 0; k < count; ++k)
        moved = std::max(moved, relax(*group.active[forwards ? k : count - 1 - k], h));
    return moved;
}

// The compliance in the directions that a contact holds; in the others, in which no force acts, anything but zero.
Mat3 SolidContacts::compliance_of_held(const Active& active) {
    const double size = trace(active.compliance) / 3;
    return active.held * active.compliance * active.held + size * (Mat3::identity() - active.held);
}

// Solves one contact with the others fixed; returns how far it had to move.
double SolidContacts::relax(Active& active, double h) {
    const SolidContact& contact = *active.contact;
    const double softness = settings_.softness;
    if (contact.holds) {
        const Vec3 off = active.held * (active.slid + moved(active) + soft_part(active, contact.force));
        apply(active, (-1 / (1 + softness)) * embody::solve(compliance_of_held(active), off), h);
        return length(off);
    }

    // Along the normal: force where there is no gap, none where there is one.
    const Vec3 n = active.normal;
    const double compliance = dot(n, active.compliance * n);
    if (!(compliance > 0)) return 0;
    const double before = dot(contact.force, n);
    Vec3 relative = active.slid + moved(active) + soft_part(active, contact.force);
    const double missing = active.target - active.gap + dot(n, active.slid - relative);
    const double after = std::max(0.0, before + missing / ((1 + softness) * compliance));
    const Vec3 along = (after - before) * n;
    relative += active.compliance * along;

    // Against sliding, within Coulomb's cone. The larger of the two tangential compliances is at most their sum.
    const double tangential_compliance = trace(active.compliance) - compliance;
    const Vec3 sliding = relative - dot(relative, n) * n;
    const Vec3 wanted =
        within_cone(contact.force + along - sliding / tangential_compliance, n, contact.present_friction());
    const Vec3 change = wanted - contact.force, across = change - dot(change, n) * n;
    const double moved_by = std::max(std::fabs(after - before) * compliance, length(across) * tangential_compliance);
    if (moved_by > settings_.idle_move) apply(active, along + across, h);
    return moved_by;
}

// The nearest force that Coulomb's cone about the normal allows.
Vec3 SolidContacts::within_cone(Vec3 force, Vec3 normal, double friction) {
    const double along = std::max(0.0, dot(force, normal)), most = friction * along;
    const Vec3 across = force - dot(force, normal) * normal;
    const double sideways = length(across);
    return along * normal + (sideways > most ? (most / sideways) * across : across);
}

// Displacement of a contact by a force beyond that of bodies and solids, m.
Vec3 SolidContacts::soft_part(const Active& active, Vec3 force) const {
    const double softness = settings_.softness;
    if (active.contact->holds) return softness * (active.compliance * force);
    const Vec3 n = active.normal;
    return (softness * dot(n, active.compliance * n) * dot(force, n)) * n;
}

// For the next substep. Within a substep a contact has one limit: sweeps pass through forces beyond any limit.
void SolidContacts::note_sticking(const Active& active, double h) {
    const Vec3 slip = active.slid + moved(active);
    active.contact->sticks =
        length(slip - dot(slip, active.normal) * active.normal) <= PairFriction::stribeck_speed * h;
}

}  // namespace embody::physics::deformable
