// SPDX-License-Identifier: MIT
// The forces of contacts that hold, stick and slide at once, as if they went on doing so: A x = r, A the displacements
// of contacts by forces on them. Directions that a contact's state does not leave free are filtered out of z and r.
#include "physics/deformable/solid/solid_contacts.h"
#include "physics/linear/conjugate_gradient.h"

namespace embody::physics::deformable {

// The remaining error of the contact's displacement, in the directions in which its force may change.
Vec3 SolidContacts::missing(const Active& active) const {
    const Vec3 n = active.normal, gone = moved(active) + soft_part(active, active.contact->force);
    const Vec3 relative = active.slid + gone, along = (active.target - active.gap - dot(n, gone)) * n;
    switch (active.state) {
        case State::open:
            return {};
        case State::holds:
            return -(active.held * relative);
        case State::sticks:
            return along - (relative - dot(relative, n) * n);
        case State::slides:
            return along;
    }
    return {};
}

void SolidContacts::find_state(Active& active) {
    constexpr double rounding = 1e-6;  // of the limit: sweeps leave sliding contacts within this
    const SolidContact& contact = *active.contact;
    const double along = dot(contact.force, active.normal);
    const double across = length(contact.force - along * active.normal);
    active.state = contact.holds                                                  ? State::holds
                   : !(along > 0)                                                 ? State::open
                   : across < (1 - rounding) * contact.present_friction() * along ? State::sticks
                                                                                  : State::slides;
}

// The part of a vector that the contact's state leaves free.
Vec3 SolidContacts::free_part(const Active& active, Vec3 v) {
    switch (active.state) {
        case State::open:
            return {};
        case State::slides:
            return dot(v, active.normal) * active.normal;
        case State::holds:
            return active.held * v;
        default:
            return v;
    }
}

void SolidContacts::probe(const Group& group, TaskPool& workers) {
    constexpr std::size_t min_parallel_count = 100;  // contacts
    struct Part {
        std::uint32_t solid = 0;
        std::size_t part = 0;
    };
    std::vector<Part> parts;
    for (const std::uint32_t solid : group.solids) {
        touched_[solid].begin_probe();
        for (std::size_t part = 0; part < touched_[solid].probe_parts(); ++part) parts.push_back({solid, part});
    }
    parallel_for(workers, parts.size(), group.active.size() >= min_parallel_count, [&](int, IndexRange range) {
        for (std::size_t k = range.first; k < range.last; ++k) touched_[parts[k].solid].run_probe(parts[k].part);
    });
    for (const std::uint32_t solid : group.solids) touched_[solid].end_probe();
}

// q = A p: the relative motion of each contact by the p of all.
void SolidContacts::respond(const Group& group, double h, TaskPool& workers) {
    for (const std::uint32_t solid : group.solids) touched_[solid].clear_probe();
    for (const std::uint32_t body : group.bodies) probe_forces_[body] = probe_torques_[body] = {};
    for (Active* const one : group.active) {
        const Active& active = *one;
        for (std::size_t k = 0; k < active.term_count; ++k) {
            const Term& term = active.terms[k];
            touched_[term.solid].add_to_probe(term.number, term.weight * active.gradient.p);
        }
        if (active.body == nullptr || !active.body->is_dynamic) continue;
        probe_forces_[active.contact->body] -= active.gradient.p;
        probe_torques_[active.contact->body] -= cross(active.arm, active.gradient.p);
    }
    probe(group, workers);
    for (Active* const one : group.active) {
        Active& active = *one;
        Vec3 sum;
        if (active.body != nullptr && active.body->is_dynamic) {
            const Vec3 turn = active.body->inverse_inertia * probe_torques_[active.contact->body];
            sum =
                -(h * h) * (active.body->inverse_mass * probe_forces_[active.contact->body] + cross(turn, active.arm));
        }
        for (std::size_t k = 0; k < active.term_count; ++k) {
            const Term& term = active.terms[k];
            sum += term.weight * touched_[term.solid].probe_move(term.number);
        }
        active.gradient.q = sum + soft_part(active, active.gradient.p);
    }
}

// z = M⁻¹ r, M a contact's own compliance; r·z.
double SolidContacts::precondition(Active& active) {
    ContactGradient& own = active.gradient;
    const Mat3 compliance = active.contact->holds ? compliance_of_held(active) : active.compliance;
    own.z = free_part(active, embody::solve(compliance, own.r));
    return dot(own.r, own.z);
}

// Then projected onto each contact's limits.
void SolidContacts::solve_together(const Group& group, double h, TaskPool& workers) {
    struct System {
        SolidContacts& of;
        const Group& group;
        double h;
        TaskPool& workers;

        GradientResidual begin() {
            double product = 0;
            for (Active* const active : group.active) {
                find_state(*active);
                active->gradient = {.r = of.missing(*active)};
                product += precondition(*active);
            }
            return {product, product};
        }
        void turn(double beta) {
            for (Active* const active : group.active)
                active->gradient.p = active->gradient.z + beta * active->gradient.p;
        }
        double multiply() {
            of.respond(group, h, workers);
            double curvature = 0;
            for (const Active* active : group.active) curvature += dot(active->gradient.p, active->gradient.q);
            return curvature;
        }
        GradientResidual advance(double alpha) {
            double product = 0;
            for (Active* const active : group.active) {
                ContactGradient& own = active->gradient;
                own.x += alpha * own.p;
                own.r -= free_part(*active, alpha * own.q);
                product += precondition(*active);
            }
            return {product, product};
        }
    };
    System system{*this, group, h, workers};
    conjugate_gradient(system, {.iterations = settings_.gradient_iterations, .relative = settings_.gradient_tolerance});
    for (Active* const one : group.active) {
        Active& active = *one;
        if (active.state == State::open) continue;
        const SolidContact& contact = *active.contact;
        const Vec3 force = contact.force + active.gradient.x;
        apply(active,
              (contact.holds ? force : within_cone(force, active.normal, contact.present_friction())) - contact.force,
              h);
    }
}

}  // namespace embody::physics::deformable
