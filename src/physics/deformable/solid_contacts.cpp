// SPDX-License-Identifier: MIT
#include "physics/deformable/solid_contacts.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr int most_sweeps = 60;
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
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
        double moved = 0;
        for (std::size_t k = 0; k < active_.size(); ++k) {
            Active& active = active_[sweep % 2 == 0 ? k : active_.size() - 1 - k];
            moved = std::max(moved, relax(active, bodies[active.contact->body], h));
        }
        if (!(moved > close_enough)) break;
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
        const Vec3 body_way = h * (body.path_velocity + body.velocity + cross(body.path_spin + body.spin, active.arm));
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
        touched.rotation.resize(count);
        touched.compliance.resize(count * count);
        touched.moved.assign(count, {});
        touched.force.assign(count, {});
        for (std::size_t a = 0; a < count; ++a) {
            touched.rotation[a] = solids[s]->rotation(touched.nodes[a]);
            for (std::size_t b = 0; b < count; ++b)
                touched.compliance[a * count + b] = solids[s]->compliance(touched.nodes[a], touched.nodes[b]);
        }
    }
}

void SolidContacts::find_give(Active& active, const TouchedBody& body, double h) const {
    // Of the solid: Σ wₐ w_b Qₐ Wₐ_b Q_bᵀ
    const CarriedPoint& point = active.contact->point;
    const Touched& touched = touched_[point.solid];
    const std::size_t count = touched.nodes.size();
    for (std::size_t a = 0; a < point.count; ++a) {
        const Mat3 to_world = to_matrix(touched.rotation[active.local[a]]);
        for (std::size_t b = 0; b < point.count; ++b) {
            const Mat3 from_world = transpose(to_matrix(touched.rotation[active.local[b]]));
            active.give += (point.weight[a] * point.weight[b]) *
                           (to_world * touched.compliance[active.local[a] * count + active.local[b]] * from_world);
        }
    }
    // Of the body: h² (1/m - [arm] I⁻¹ [arm])
    const Mat3 arm = skew(active.arm);
    active.give += (h * h) * (Mat3::diagonal({body.inverse_mass, body.inverse_mass, body.inverse_mass}) -
                              arm * body.inverse_inertia * arm);
}

// How far the two have moved from each other by forces of this solve.
Vec3 SolidContacts::moved(const Active& active, const TouchedBody& body) const {
    const CarriedPoint& point = active.contact->point;
    const Touched& touched = touched_[point.solid];
    Vec3 sum = -(body.shift - active.shift) - cross(body.turn - active.turn, active.arm);
    for (std::size_t k = 0; k < point.count; ++k)
        sum += point.weight[k] * rotate(touched.rotation[active.local[k]], touched.moved[active.local[k]]);
    return sum;
}

void SolidContacts::apply(const Active& active, TouchedBody& body, Vec3 force, double h) {
    const CarriedPoint& point = active.contact->point;
    Touched& touched = touched_[point.solid];
    const std::size_t count = touched.nodes.size();
    for (std::size_t k = 0; k < point.count; ++k) {
        const std::uint32_t node = active.local[k];
        const Vec3 share = point.weight[k] * force, own = rotate_inverse(touched.rotation[node], share);
        touched.force[node] += share;
        for (std::size_t other = 0; other < count; ++other)
            touched.moved[other] += touched.compliance[other * count + node] * own;
    }
    body.push(-h * force, active.arm, h);
    active.contact->force += force;
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
