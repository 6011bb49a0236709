// SPDX-License-Identifier: MIT
#include "physics/deformable/solid_contacts.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr int most_rounds = 12, sweeps_a_round = 2, most_gradient_rounds = 40;
constexpr double close_enough = 1e-6;      // m: no contact moves by more in the last sweep
constexpr double recovery_speed = 0.5;     // m/s: what overlaps is parted no faster
constexpr double reach_beyond_radius = 1;  // contacts farther than this many radii stay out of the sweeps

Vec3 position(const CarriedPoint& point, std::span<const Vec3> nodes) {
    Vec3 sum;
    for (std::size_t k = 0; k < point.count; ++k) sum += point.weight[k] * nodes[point.node[k]];
    return sum;
}

Vec3 start_position(const CarriedPoint& point, const SolidDeformable& solid) {
    Vec3 sum;
    for (std::size_t k = 0; k < point.count; ++k) sum += point.weight[k] * solid.start(point.node[k]);
    return sum;
}

}  // namespace

void SolidContacts::begin(std::span<const SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies,
                          double h) {
    for (const SolidContact& contact : contacts) {
        if (contact.force == Vec3{}) continue;
        const CarriedPoint& point = contact.point;
        for (std::size_t k = 0; k < point.count; ++k)
            solids[point.solid]->push(point.node[k], point.weight[k] * contact.force);
        TouchedBody& body = bodies[contact.body];
        body.push(-h * contact.force, contact.anchor, h);
    }
}

void SolidContacts::solve(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h,
                          double time, TaskPool& workers) {
    gather(contacts, solids, bodies, h, time);
    gather_nodes(solids);
    for (Active& active : active_) find_give(active, bodies[active.contact->body], h);
    // Sweeps find which contacts hold, stick and slide; conjugate gradients solve for the forces of these at once
    // (M. Silcowitz, S. Niebe, K. Erleben, "Projected Gauss-Seidel subspace minimization method", 2010).
    for (int round = 0; round < most_rounds; ++round) {
        double moved = 0;
        for (int k = 0; k < sweeps_a_round; ++k) moved = sweep(bodies, h, k % 2 == 0);
        if (!(moved > close_enough) || round + 1 == most_rounds) break;
        solve_together(bodies, h);
    }
    for (std::size_t s = 0; s < solids.size(); ++s) {
        const Touched& touched = touched_[s];
        if (touched.nodes.empty()) continue;
        for (std::size_t k = 0; k < touched.nodes.size(); ++k) solids[s]->push(touched.nodes[k], touched.force[k]);
        solids[s]->settle(workers);
    }
}

// Contacts that touch or nearly do after the free motion; others let go of their forces.
void SolidContacts::gather(std::span<SolidContact> contacts, Solids solids, std::span<TouchedBody> bodies, double h,
                           double time) {
    active_.clear();
    for (SolidContact& contact : contacts) {
        const SolidDeformable& solid = *solids[contact.point.solid];
        const TouchedBody& body = bodies[contact.body];
        const Mat3 rotation = body.rotation_at(time);
        Active active;
        active.contact = &contact;
        active.normal = rotation * contact.normal;
        const Vec3 center = body.center_at(time), anchor = rotation * contact.anchor;
        const Vec3 at = position(contact.point, solid.nodes().position);
        const Vec3 was = start_position(contact.point, solid);
        const Vec3 apart = at - center - anchor;
        active.gap = dot(apart, active.normal) - contact.radius;
        // The body's surface under the point, and how far it has gone in the substep.
        active.arm = contact.holds ? anchor : at - (contact.radius + active.gap) * active.normal - center;
        const Vec3 body_way = body.way(h, time, active.arm);
        active.slid = contact.holds ? apart : at - was - body_way;
        if (!contact.holds && contact.force == Vec3{} && active.gap > reach_beyond_radius * contact.radius) continue;
        const double gap_before = active.gap - dot(active.slid, active.normal);
        active.target = std::min(0.0, gap_before + recovery_speed * h);
        active.shift = body.shift;
        active.turn = body.turn;
        active_.push_back(active);
    }
}

void SolidContacts::gather_nodes(Solids solids) {
    touched_.resize(solids.size());
    constexpr std::uint32_t none = 0xFFFFFFFF;
    for (std::size_t s = 0; s < solids.size(); ++s) {
        touched_[s].nodes.clear();
        touched_[s].local_of.assign(solids[s]->nodes().size(), none);
    }
    for (Active& active : active_) {
        const CarriedPoint& point = active.contact->point;
        Touched& touched = touched_[point.solid];
        for (std::size_t k = 0; k < point.count; ++k) {
            std::uint32_t& local = touched.local_of[point.node[k]];
            if (local == none) {
                local = static_cast<std::uint32_t>(touched.nodes.size());
                touched.nodes.push_back(point.node[k]);
            }
            active.local[k] = local;
        }
    }
    for (std::size_t s = 0; s < solids.size(); ++s) {
        Touched& touched = touched_[s];
        const std::size_t count = touched.nodes.size();
        touched.stride = (count + 15) / 16 * 16;
        touched.rotation.resize(count);
        touched.compliance.assign(9 * count * touched.stride, 0.0f);
        touched.moved.assign(3 * touched.stride, 0.0f);
        touched.probe.assign(3 * touched.stride, 0.0f);
        touched.probe_force.assign(count, {});
        touched.force.assign(count, {});
        for (std::size_t a = 0; a < count; ++a) {
            touched.rotation[a] = solids[s]->turn(touched.nodes[a]);
            for (std::size_t b = 0; b < count; ++b) {
                const Mat3 block = solids[s]->compliance(touched.nodes[a], touched.nodes[b]);
                float* to = touched.compliance.data() + 9 * b * touched.stride + a;
                for (int k = 0; k < 9; ++k, to += touched.stride) *to = static_cast<float>(block(k % 3, k / 3));
            }
        }
    }
}

void SolidContacts::find_give(Active& active, const TouchedBody& body, double h) const {
    // Of the solid: Σ wₐ w_b Qₐ Wₐ_b Q_bᵀ
    const CarriedPoint& point = active.contact->point;
    const Touched& touched = touched_[point.solid];
    for (std::size_t a = 0; a < point.count; ++a) {
        const Mat3 to_world = to_matrix(touched.rotation[active.local[a]]);
        for (std::size_t b = 0; b < point.count; ++b) {
            const Mat3 from_world = transpose(to_matrix(touched.rotation[active.local[b]]));
            active.give += (point.weight[a] * point.weight[b]) *
                           (to_world * touched.block(active.local[a], active.local[b]) * from_world);
        }
    }
    // Of the body: h² (1/m - [arm] I⁻¹ [arm])
    const Mat3 arm = skew(active.arm);
    active.give += (h * h) * (Mat3::diagonal({body.inverse_mass, body.inverse_mass, body.inverse_mass}) -
                              arm * body.inverse_inertia * arm);
}

Mat3 SolidContacts::Touched::block(std::size_t i, std::size_t j) const {
    Mat3 block;
    for (int k = 0; k < 9; ++k)
        block(k % 3, k / 3) = static_cast<double>(compliance[(9 * j + static_cast<std::size_t>(k)) * stride + i]);
    return block;
}

Vec3 SolidContacts::Touched::move_of(std::size_t i, std::span<const float> moves) const {
    return to_vec3(Vec3f{moves[i], moves[stride + i], moves[2 * stride + i]});
}

void SolidContacts::Touched::push(std::size_t j, Vec3 given) {
    force[j] += given;
    add_moves(j, given, moved);
}

void SolidContacts::Touched::add_moves(std::size_t j, Vec3 given, std::span<float> moves) const {
    const Vec3f own = to_vec3f(rotate_inverse(rotation[j], given));
    const float* w = compliance.data() + 9 * j * stride;
    float *x = moves.data(), *y = x + stride, *z = y + stride;
    for (std::size_t i = 0; i < stride; ++i) {
        x[i] += w[i] * own.x + w[3 * stride + i] * own.y + w[6 * stride + i] * own.z;
        y[i] += w[stride + i] * own.x + w[4 * stride + i] * own.y + w[7 * stride + i] * own.z;
        z[i] += w[2 * stride + i] * own.x + w[5 * stride + i] * own.y + w[8 * stride + i] * own.z;
    }
}

// How far the two have moved from each other by forces of this solve.
Vec3 SolidContacts::moved(const Active& active, const TouchedBody& body) const {
    const CarriedPoint& point = active.contact->point;
    const Touched& touched = touched_[point.solid];
    Vec3 sum = -(body.shift - active.shift) - cross(body.turn - active.turn, active.arm);
    for (std::size_t k = 0; k < point.count; ++k)
        sum += point.weight[k] *
               rotate(touched.rotation[active.local[k]], touched.move_of(active.local[k], touched.moved));
    return sum;
}

void SolidContacts::apply(const Active& active, TouchedBody& body, Vec3 force, double h) {
    const CarriedPoint& point = active.contact->point;
    Touched& touched = touched_[point.solid];
    for (std::size_t k = 0; k < point.count; ++k) touched.push(active.local[k], point.weight[k] * force);
    body.push(-h * force, active.arm, h);
    active.contact->force += force;
}

double SolidContacts::sweep(std::span<TouchedBody> bodies, double h, bool forwards) {
    double moved = 0;
    for (std::size_t k = 0; k < active_.size(); ++k) {
        Active& active = active_[forwards ? k : active_.size() - 1 - k];
        moved = std::max(moved, relax(active, bodies[active.contact->body], h));
    }
    return moved;
}

// What is left of the way to where the contact wants to be, in the directions that its force may change in.
Vec3 SolidContacts::missing(const Active& active, const TouchedBody& body) const {
    const Vec3 n = active.normal, relative = active.slid + moved(active, body);
    switch (active.state) {
        case State::open:
            return {};
        case State::holds:
            return -relative;
        case State::sticks: {
            const double along = active.target - active.gap - dot(n, relative - active.slid);
            return along * n - (relative - dot(relative, n) * n);
        }
        case State::slides:
            return (active.target - active.gap - dot(n, relative - active.slid)) * n;
    }
    return {};
}

void SolidContacts::find_state(Active& active) {
    const SolidContact& contact = *active.contact;
    const double along = dot(contact.force, active.normal);
    const double across = length(contact.force - along * active.normal);
    active.state = contact.holds                                    ? State::holds
                   : !(along > 0)                                   ? State::open
                   : across < (1 - 1e-6) * contact.friction * along ? State::sticks
                                                                    : State::slides;
}

// The part of a vector that the contact's state leaves free.
Vec3 SolidContacts::free_part(const Active& active, Vec3 v) {
    switch (active.state) {
        case State::open:
            return {};
        case State::slides:
            return dot(v, active.normal) * active.normal;
        default:
            return v;
    }
}

// Relative motion of each contact by its `direction` and those of all others, into `response`.
void SolidContacts::respond(std::span<const TouchedBody> bodies, double h) {
    for (Touched& touched : touched_) {
        std::ranges::fill(touched.probe, 0.0f);
        std::ranges::fill(touched.probe_force, Vec3{});
    }
    probe_forces_.assign(bodies.size(), {});
    probe_torques_.assign(bodies.size(), {});
    for (const Active& active : active_) {
        const CarriedPoint& point = active.contact->point;
        for (std::size_t k = 0; k < point.count; ++k)
            touched_[point.solid].probe_force[active.local[k]] += point.weight[k] * active.direction;
        probe_forces_[active.contact->body] -= active.direction;
        probe_torques_[active.contact->body] -= cross(active.arm, active.direction);
    }
    for (Touched& touched : touched_) {
        for (std::size_t j = 0; j < touched.nodes.size(); ++j) {
            if (touched.probe_force[j] != Vec3{}) touched.add_moves(j, touched.probe_force[j], touched.probe);
        }
    }
    for (Active& active : active_) {
        const CarriedPoint& point = active.contact->point;
        const Touched& touched = touched_[point.solid];
        const TouchedBody& body = bodies[active.contact->body];
        const Vec3 turn = body.inverse_inertia * probe_torques_[active.contact->body];
        Vec3 sum = -(h * h) * (body.inverse_mass * probe_forces_[active.contact->body] + cross(turn, active.arm));
        for (std::size_t k = 0; k < point.count; ++k) {
            const std::uint32_t node = active.local[k];
            sum += point.weight[k] * rotate(touched.rotation[node], touched.move_of(node, touched.probe));
        }
        active.response = sum;
    }
}

void SolidContacts::solve_together(std::span<TouchedBody> bodies, double h) {
    double size = 0;
    for (Active& active : active_) {
        find_state(active);
        active.residual = missing(active, bodies[active.contact->body]);
        active.direction = free_part(active, embody::solve(active.give, active.residual));
        active.change = {};
        size += dot(active.residual, active.direction);
    }
    const double enough = 1e-6 * size;
    for (int round = 0; round < most_gradient_rounds && size > enough; ++round) {
        respond(bodies, h);
        double curvature = 0;
        for (const Active& active : active_) curvature += dot(active.direction, active.response);
        if (!(curvature > 0)) break;
        double next = 0;
        for (Active& active : active_) {
            active.change += (size / curvature) * active.direction;
            active.residual -= free_part(active, (size / curvature) * active.response);
            next += dot(active.residual, free_part(active, embody::solve(active.give, active.residual)));
        }
        for (Active& active : active_) {
            active.direction =
                free_part(active, embody::solve(active.give, active.residual)) + (next / size) * active.direction;
        }
        size = next;
    }
    // As far as each contact may.
    for (Active& active : active_) {
        if (active.state == State::open) continue;
        SolidContact& contact = *active.contact;
        Vec3 force = contact.force + active.change;
        if (!contact.holds) {
            const double along = std::max(0.0, dot(force, active.normal)), most = contact.friction * along;
            Vec3 across = force - dot(force, active.normal) * active.normal;
            const double sideways = length(across);
            if (sideways > most) across = sideways > 0 ? (most / sideways) * across : Vec3{};
            force = along * active.normal + across;
        }
        apply(active, bodies[contact.body], force - contact.force, h);
    }
}

// One contact to where it wants to be with the others as they are; returns how far it had to move.
double SolidContacts::relax(Active& active, TouchedBody& body, double h) {
    SolidContact& contact = *active.contact;
    if (contact.holds) {
        const Vec3 off = active.slid + moved(active, body);
        apply(active, body, -embody::solve(active.give, off), h);
        return length(off);
    }

    // Along the normal: force where there is no gap, none where there is one.
    const Vec3 n = active.normal;
    const double give = dot(n, active.give * n);
    if (!(give > 0)) return 0;
    const double before = dot(contact.force, n);
    const double missing = active.target - active.gap - dot(n, moved(active, body));
    const double after = std::max(0.0, before + missing / give);
    double moved_by = std::fabs(after - before) * give;
    if (after != before) apply(active, body, (after - before) * n, h);

    // Against sliding, within Coulomb's cone. The larger of the two tangential compliances is at most their sum.
    const Vec3 relative = active.slid + moved(active, body);
    const Vec3 sliding = relative - dot(relative, n) * n;
    const double tangential_give = trace(active.give) - give;
    const Vec3 held = contact.force - dot(contact.force, n) * n;
    Vec3 holds = held - sliding / tangential_give;
    const double most = contact.friction * after, size = length(holds);
    if (size > most) holds = size > 0 ? (most / size) * holds : Vec3{};
    const Vec3 change = holds - held;
    if (change != Vec3{}) apply(active, body, change, h);
    moved_by = std::max(moved_by, length(change) * tangential_give);
    return moved_by;
}

}  // namespace embody::physics
