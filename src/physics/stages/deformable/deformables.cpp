// SPDX-License-Identifier: MIT
// Deformables after the rigid bodies (docs/physics/deformables.md): in substeps of their own, while the bodies that
// they touch move along their paths of this step and are pushed by the nodes.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/dynamic/equations_of_motion.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/body_supports.h"
#include "physics/stages/deformable/solid_bounces.h"
#include "physics/stages/deformable/solid_contact_search.h"
#include "physics/stages/deformable/solid_ties.h"
#include "physics/stages/deformable/thin_groups.h"
#include "physics/stages/stages.h"
#include "physics/state/activity_state.h"
#include "physics/state/contact_state.h"
#include "physics/state/deformable_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

template <class Visit>
void for_each_body_near(const DeformableAccess& world, const DeformableRecord& record, Visit visit) {
    world.contacts.broad_phase.query(enlarged(record.bounds(), reach_of(world, record)), [&](std::uint32_t slot) {
        if (world.rigid.record(slot).shape && may_collide(record.definition, world.rigid.record(slot).definition))
            visit(slot);
    });
}

// A body with its path in this step; a sleeping or fixed body stands still.
TouchedBody touched(const DeformableAccess& world, std::uint32_t slot) {
    const BodyRecord& record = world.rigid.record(slot);
    const BodyState& state = world.rigid.motion[slot];
    constexpr double min_cosine = 1e-3;  // of half the turn in a step: keeps its tangent finite at a whole half turn
    const double dt = world.settings.time_step;
    const bool moves = record.definition.kind != BodyKind::static_body && !world.activity.is_asleep(slot);
    TouchedBody body;
    body.body = slot;
    body.shape = record.shape;
    body.is_dynamic = world.rigid.is_dynamic(slot);
    body.material = record.definition.material;
    body.start_center = moves ? state.start_center : state.center;
    const Quat rotation = moves ? state.start_rotation : state.rotation;
    body.start = {body.start_center - rotate(rotation, world.rigid.constants[slot].local_center), rotation};
    if (!moves) return body;
    const Quat turn = state.rotation * conjugate(rotation);
    const Vec3 half_sine = (turn.w < 0 ? -1.0 : 1.0) * Vec3{turn.x, turn.y, turn.z};
    const double half_cosine = std::fabs(turn.w), sine = length(half_sine);
    body.step_time = dt;
    if (world.rigid.is_dynamic(slot)) {
        body.path_acceleration = (state.linear_velocity - record.start_linear_velocity) / dt;
        body.path_spin_up = (state.angular_velocity - record.start_angular_velocity) / dt;
    }
    body.path_velocity = (state.center - body.start_center) / dt;
    body.path_spin = sine > 0 ? (2 * std::asin(std::min(sine, 1.0)) / (sine * dt)) * half_sine : Vec3{};
    body.path_turn = (2 / (std::max(half_cosine, min_cosine) * dt)) * half_sine;
    body.inverse_mass = state.inverse_mass;
    body.inverse_inertia = state.inverse_inertia;
    body.expected_force = record.deformable_force;
    body.expected_torque = record.deformable_torque;
    body.expected_late_force = record.late_force;
    body.expected_late_torque = record.late_torque;
    return body;
}

double fastest_node(const DeformableRecord& record) {
    double fastest = 0;
    for (const Vec3 v : record.nodes().velocity) fastest = std::max(fastest, length(v));
    return fastest;
}

// Whether the user moves it by hand, however slowly.
bool is_led(const DeformableAccess& world, std::uint32_t slot) {
    const BodyState& state = world.rigid.motion[slot];
    return world.rigid.record(slot).definition.kind == BodyKind::kinematic_body && !world.activity.is_asleep(slot) &&
           (state.linear_velocity != Vec3{} || state.angular_velocity != Vec3{});
}

// Whether something has happened around a sleeping deformable.
bool is_disturbed(const DeformableAccess& world, const DeformableRecord& record) {
    for (const DeformableRecord::Support& support : record.supports) {
        const std::uint32_t slot = support.body.index;
        if (world.rigid.bodies.find(support.body) == nullptr || world.rigid.record(slot).version != support.version)
            return true;
        if (world.rigid.is_dynamic(slot) ? !world.activity.is_asleep(slot) : is_led(world, slot)) return true;
    }
    for (const std::uint32_t slot : record.touched_deformables) {
        if (!world.deformables.records.used(slot) || !world.deformables.records.at(slot).is_asleep) return true;
    }
    for (const Attachment& attachment : record.definition.attachments) {
        if (world.rigid.bodies.find(attachment.body) != nullptr && is_led(world, attachment.body.index)) return true;
    }
    const double wake_speed = world.settings.solver.deformable.sleep.wake_speed;
    bool is_disturbed = false;
    for_each_body_near(world, record, [&](std::uint32_t slot) {
        if (world.rigid.record(slot).definition.kind == BodyKind::static_body || world.activity.is_asleep(slot)) return;
        const BodyState& state = world.rigid.motion[slot];
        is_disturbed = is_disturbed || length(state.linear_velocity) > wake_speed ||
                       length(state.angular_velocity) * world.rigid.record(slot).reach > wake_speed;
    });
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        const DeformableRecord& other = world.deformables.records.at(slot);
        is_disturbed = is_disturbed || (other.definition.enabled && !other.is_asleep &&
                                        may_collide(record.definition, other.definition) &&
                                        overlaps(enlarged(record.bounds(), reach_of(world, other)), other.bounds()) &&
                                        fastest_node(other) > wake_speed);
    }
    return is_disturbed;
}

// Returns whether any was woken: it may disturb others.
bool wake_disturbed(const DeformableAccess& world) {
    bool has_woken = false;
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        DeformableRecord& record = world.deformables.records.at(slot);
        if (!record.definition.enabled || !record.is_asleep || !is_disturbed(world, record)) continue;
        record.is_asleep = false;
        record.quiet_time = 0;
        has_woken = true;
    }
    return has_woken;
}

/// All deformables that move in this step, with the bodies that they may touch.
struct MovingDeformables {
    std::vector<DeformableRecord*> records;
    std::vector<DeformableRecord*> solid_records;  ///< those of solids
    std::vector<SolidDeformable*> solids;          ///< of these, in their order
    std::vector<ThinDeformable> thin;              ///< sheets and ropes
    std::vector<ThinGroup> groups;                 ///< of these
    std::vector<TouchedBody> bodies;               ///< by slot
    std::vector<SolidContact> contacts;            ///< solid after solid
    [[nodiscard]] std::uint32_t index_of(std::uint32_t slot) const {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies, slot, {}, &TouchedBody::body) -
                                          bodies.begin());
    }
};

// Whole turns in a step do not show in the rotations before and after it. They count for what a solid holds, which was
// braked as if it turned by less; sheets spun grains up by them that turned by more than half a turn a step.
void count_whole_turns(const DeformableAccess& world, MovingDeformables& moving) {
    constexpr double whole_turn = 6.283185307179586;  // rad
    const double dt = world.settings.time_step;
    for (const DeformableRecord* record : moving.solid_records) {
        for (const Attachment& attachment : record->definition.attachments) {
            const auto body = std::ranges::lower_bound(moving.bodies, attachment.body.index, {}, &TouchedBody::body);
            if (body == moving.bodies.end() || body->body != attachment.body.index) continue;
            const double spin = length(body->path_spin);
            if (!(spin > 0)) continue;
            const Vec3 axis = body->path_spin / spin;
            const Vec3 sum =
                world.rigid.record(body->body).start_angular_velocity + world.rigid.motion[body->body].angular_velocity;
            const double missing = dot(sum, axis) / 2 - spin;
            body->path_spin += (whole_turn * std::round(missing * dt / whole_turn) / dt) * axis;
        }
    }
}

// A ball's rotation changes nothing, so its spin need not be told by the rotations before and after the step, which
// show none of its whole turns: solids that touched one at 70 turns a second drove it as if it turned the other way.
// Not of one that a solid holds, for which the turns are counted.
void find_spins_of_balls(const DeformableAccess& world, MovingDeformables& moving) {
    std::vector<bool> is_held(moving.bodies.size(), false);
    for (const SolidContact& contact : moving.contacts) {
        if (contact.holds) is_held[contact.body] = true;
    }
    for (const SolidContact& contact : moving.contacts) {
        if (!contact.has_body() || is_held[contact.body]) continue;
        TouchedBody& body = moving.bodies[contact.body];
        const BodyRecord& record = world.rigid.record(body.body);
        if (!record.is_ball || !body.is_dynamic || !(body.step_time > 0)) continue;
        body.path_spin = (record.start_angular_velocity + world.rigid.motion[body.body].angular_velocity) / 2;
    }
}

void gather_bodies(const DeformableAccess& world, MovingDeformables& moving) {
    std::vector<std::uint32_t> slots;
    for (const DeformableRecord* record : moving.records) {
        for_each_body_near(world, *record, [&](std::uint32_t slot) { slots.push_back(slot); });
        for (const Attachment& attachment : record->definition.attachments) {
            if (world.rigid.bodies.find(attachment.body) != nullptr) slots.push_back(attachment.body.index);
        }
    }
    for (const std::uint32_t slot : world.deformables.pushed_bodies) {
        if (world.rigid.is_used(slot) && !world.activity.is_asleep(slot)) slots.push_back(slot);
    }
    std::ranges::sort(slots);
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    for (const std::uint32_t slot : slots) moving.bodies.push_back(touched(world, slot));
}

// What a sheet or rope may touch.
void find_contacts_of(const DeformableAccess& world, const MovingDeformables& moving, ThinDeformable& thin) {
    EMBODY_ZONE("find contacts of sheet or rope");
    std::vector<bool> colliding;
    for (const TouchedBody& body : moving.bodies) {
        colliding.push_back(body.shape &&
                            may_collide(thin.record->definition, world.rigid.record(body.body).definition));
    }
    thin.attachments = thin.record->definition.attachments;
    for (const Attachment& attachment : thin.attachments) {
        const bool is_there = world.rigid.bodies.find(attachment.body) != nullptr;
        thin.attachment_bodies.push_back(is_there ? moving.index_of(attachment.body.index) : no_body);
    }
    find_thin_contacts(moving.bodies, colliding, world.settings, thin, world.workers);
}

// What sheets and ropes pushed the solids in their last substep.
void push_solids(const DeformableAccess& world, MovingDeformables& moving) {
    for (DeformableRecord* record : moving.solid_records) SolidTies::push(world, record->slot, *record->solid());
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot) || !world.deformables.records.at(slot).definition.enabled) continue;
        for (const SurfacePush& push : world.deformables.records.at(slot).surface_pushes) {
            const auto record = std::ranges::lower_bound(moving.solid_records, push.slot, {}, &DeformableRecord::slot);
            if (record == moving.solid_records.end() || (*record)->slot != push.slot) continue;
            for (std::size_t k = 0; k < 3; ++k) (*record)->solid()->push(push.triangle[k], push.weight[k] * push.force);
        }
    }
}

// Several solids are solved by one worker each, a single one by all.
void parallel_for_solids(const DeformableAccess& world, const MovingDeformables& moving, const auto& work) {
    const std::size_t count = moving.solids.size();
    if (count <= 1 || world.workers.workers() == 1) {
        for (std::size_t i = 0; i < count; ++i) work(i, world.workers);
        return;
    }
    std::atomic<std::size_t> next = 0;
    world.workers.run([&](int) {
        TaskPool alone(1);
        for (std::size_t i = next++; i < count; i = next++) work(i, alone);
    });
}

void solve_solids(const DeformableAccess& world, const MovingDeformables& moving) {
    EMBODY_ZONE("solve solids");
    parallel_for_solids(world, moving, [&](std::size_t i, TaskPool& workers) { moving.solids[i]->solve(workers); });
}

// A further iteration for solids whose moves add energy; returns whether there is any.
bool correct_solids(const DeformableAccess& world, const MovingDeformables& moving) {
    std::atomic<bool> is_any = false;
    parallel_for_solids(world, moving, [&](std::size_t i, TaskPool& workers) {
        if (!moving.solids[i]->gains_energy()) return;
        moving.solids[i]->solve(workers);
        is_any = true;
    });
    return is_any;
}

// A body that a solid holds at a point, r from its centre, turns under the pushes F on it at a rate of up to √(F r /
// I). A light one between its solid and the floor does so within a fraction of a substep: the substeps of a step in
// which that is to be expected are shorter.
int substeps_for(const DeformableAccess& world, const MovingDeformables& moving) {
    // Of that rate times a substep, 1: the limit of stability. Test: HeldBall.GainsNothingBetweenASolidAndTheFloor
    constexpr double max_turn = 2;
    constexpr int max_substeps = 16;  // Test: HeldBall.GainsNothingBetweenASolidAndTheFloor
    const int wanted = world.settings.deformable_substeps;
    std::vector<double> force(moving.bodies.size(), 0), arm(moving.bodies.size(), 0);
    for (const SolidContact& contact : moving.contacts) {
        if (!contact.has_body()) continue;
        force[contact.body] += length(contact.force);
        if (contact.holds) arm[contact.body] = std::max(arm[contact.body], length(contact.anchor));
    }
    double fastest = 0;
    for (std::size_t b = 0; b < moving.bodies.size(); ++b) {
        const Mat3& inverse = moving.bodies[b].inverse_inertia;
        fastest = std::max(fastest, force[b] * arm[b] * trace(inverse) / 3);
    }
    const double needed = std::sqrt(fastest) * world.settings.time_step / max_turn;
    return std::max(wanted, static_cast<int>(std::ceil(std::clamp<double>(needed, 1, max_substeps))));
}

void run_substeps(const DeformableAccess& world, MovingDeformables& moving) {
    const int substeps = substeps_for(world, moving);
    const double h = world.settings.time_step / substeps;
    const DeformableSettings& settings = world.settings.solver.deformable;
    for (int k = 1; k <= substeps; ++k) {
        parallel_for_solids(world, moving, [&](std::size_t i, TaskPool&) {
            moving.solids[i]->begin_substep(h, moving.solid_records[i]->acceleration(world.settings.gravity),
                                            settings.solid);
        });
        push_solids(world, moving);
        for (TouchedBody& body : moving.bodies) body.enter_substep(h);
        SolidContacts::begin(moving.contacts, moving.solids, moving.bodies, h, k * h);
        solve_solids(world, moving);
        int corrections = 0;
        do {
            world.deformables.solid_contacts.solve(moving.contacts, moving.solids, moving.bodies,
                                                   {h, k * h, settings.solid_contact}, world.workers);
        } while (corrections++ < settings.solid.max_corrections && correct_solids(world, moving));
        parallel_for_solids(world, moving, [&](std::size_t i, TaskPool&) { moving.solids[i]->finish(); });
        bounce_solids(world, moving.solid_records, moving.contacts, moving.bodies, h, k * h);
        advance_thin_groups(world, moving.groups, moving.thin, moving.bodies, k, substeps);
    }
}

/// Of a body's pushes, what the next rigid step takes as constant.
struct HeldFractions {
    double force = 1, torque = 1;
};

// Held through a step while the body moves and tilts, a push of hundreds of times its weight throws it away. What bears
// a light body under a heavy sheet answers the rest in the solve of the deformables alone; what nothing bears, and the
// turn of a ball, which is borne by friction alone, have no use for it.
HeldFractions fractions_for_rigid_step(const DeformableAccess& world, const TouchedBody& body) {
    const BodyRecord& record = world.rigid.record(body.body);
    const ThinContactSettings& settings = world.settings.solver.deformable.thin_contact;
    const double dt = world.settings.time_step, g = std::max(length(world.settings.gravity), settings.min_gravity);
    const double most = settings.max_push_in_weights * g * dt / body.inverse_mass;
    const auto fraction = [&](double push) { return push > most ? most / push : 1.0; };
    const double turn = record.reach > 0 ? length(body.angular_impulse) / record.reach : 0;
    if (body.supports.empty() && !body.touches_solid) return {1, 1};
    if (body.supports.empty() && body.is_borne) return {1, record.is_ball ? fraction(turn) : 1};
    const double both = fraction(length(body.impulse) + turn);
    return {both, both};
}

// Moves the bodies to where the pushes have brought them, and stores the pushes for the rigid bodies' next step.
// Sleepers wake if the push has changed since they fell asleep.
void put_back_bodies(const DeformableAccess& world, const MovingDeformables& moving) {
    EMBODY_ZONE("push bodies");
    constexpr double min_reach = 1e-6;  // m: keeps the quotient finite
    const double dt = world.settings.time_step;
    std::erase_if(world.deformables.pushed_bodies,
                  [&](std::uint32_t slot) { return !world.rigid.is_used(slot) || !world.activity.is_asleep(slot); });
    for (const TouchedBody& body : moving.bodies) {
        BodyRecord& record = world.rigid.record(body.body);
        if (!world.rigid.is_dynamic(body.body)) continue;
        const Vec3 force = body.impulse / dt, torque = body.angular_impulse / dt;
        if (world.activity.is_asleep(body.body)) {
            const double mass = 1 / world.rigid.motion[body.body].inverse_mass;
            const double weight = mass * length(world.settings.gravity);
            const double more = std::max(length(force - record.whole_push),
                                         length(torque - record.whole_push_torque) / std::max(record.reach, min_reach));
            if (more > world.settings.solver.optimization.wake_force_fraction * weight)
                world.activity.to_wake.push_back(body.body);
            continue;
        }
        const HeldFractions held = fractions_for_rigid_step(world, body);
        record.whole_push = force;
        record.whole_push_torque = torque;
        record.deformable_force = held.force * force;
        record.deformable_torque = held.torque * torque;
        record.late_force = (held.force / dt) * body.late_impulse;
        record.late_torque = (held.torque / dt) * body.late_angular_impulse;
        if (force != Vec3{} || torque != Vec3{}) world.deformables.pushed_bodies.push_back(body.body);
        if (force == Vec3{} && body.expected_force == Vec3{} && torque == Vec3{} && body.expected_torque == Vec3{})
            continue;
        BodyState& state = world.rigid.motion[body.body];
        state.center += body.shift;
        state.rotation = normalized(cayley(body.turn) * state.rotation);
        state.linear_velocity += body.velocity;
        state.angular_velocity += body.spin;
        refresh_inertia(state, world.rigid.constants[body.body]);
    }
}

// Slots without repetition.
void sort_out(std::vector<std::uint32_t>& slots) {
    std::ranges::sort(slots);
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

// What each solid remembers of its contacts.
void keep_contacts(const DeformableAccess& world, MovingDeformables& moving) {
    for (DeformableRecord* record : moving.records) {
        record->contacts.clear();
        record->touched_bodies.clear();
        record->touched_deformables.clear();
    }
    for (const SolidContact& contact : moving.contacts) {
        if (contact.force == Vec3{}) continue;
        DeformableRecord& record = *moving.solid_records[contact.point.solid];
        record.contacts.push_back(contact);
        if (contact.has_body()) {
            record.touched_bodies.push_back(static_cast<std::uint32_t>(contact.partner));
        } else {
            DeformableRecord& other = *moving.solid_records[contact.other.solid];
            record.touched_deformables.push_back(other.slot);
            other.touched_deformables.push_back(record.slot);
        }
    }
    for (DeformableRecord* record : moving.records) {
        if (!record->solid()) record->touched_bodies = bodies_pushed_by(*record, moving.bodies);
        for (const SurfacePush& push : record->surface_pushes) {
            record->touched_deformables.push_back(push.slot);
            world.deformables.records.at(push.slot).touched_deformables.push_back(record->slot);
        }
    }
    for (DeformableRecord* record : moving.records) {
        for (const Tie& tie : record->definition.ties) {
            DeformableRecord* other = world.deformables.records.find(tie.other);
            if (other == nullptr || !other->definition.enabled) continue;
            record->touched_deformables.push_back(tie.other.index);
            other->touched_deformables.push_back(record->slot);
        }
    }
    for (const auto& [slots, contacts] : world.deformables.thin_contacts) {
        if (slots.first == slots.second) continue;
        if (world.deformables.records.at(slots.first).is_asleep) continue;  // it keeps what it touched
        if (std::ranges::none_of(contacts, [](const ThinContact& contact) { return contact.push > 0; })) continue;
        world.deformables.records.at(slots.first).touched_deformables.push_back(slots.second);
        world.deformables.records.at(slots.second).touched_deformables.push_back(slots.first);
    }
    for (DeformableRecord* record : moving.records) {
        sort_out(record->touched_bodies);
        sort_out(record->touched_deformables);
        record->supports.clear();
        for (const std::uint32_t slot : record->touched_bodies)
            record->supports.push_back({world.rigid.bodies.handle_at(slot), world.rigid.record(slot).version});
    }
}

// Those with non-finite numbers are stopped where they last were.
void freeze_broken(const DeformableAccess& world, MovingDeformables& moving) {
    for (DeformableRecord* record : moving.records) {
        if (!record->is_finite()) {
            record->stop_at(record->last_positions);
            record->definition.enabled = false;
            world.report.limits |= static_cast<std::uint32_t>(StepLimit::not_finite_deformable_frozen);
        }
        record->last_positions = record->nodes().position;
    }
}

// Whether it and all that it touches, directly or through others, are ready to sleep: bodies asleep, deformables quiet.
bool may_sleep(const DeformableAccess& world, const DeformableRecord& record, std::vector<std::uint32_t>& seen) {
    seen.push_back(record.slot);
    if (record.quiet_time < world.settings.time_to_sleep) return false;
    for (const std::uint32_t slot : record.touched_bodies) {
        if (world.rigid.is_used(slot) && world.rigid.is_dynamic(slot) && !world.activity.is_asleep(slot)) return false;
    }
    return std::ranges::all_of(record.touched_deformables, [&](std::uint32_t slot) {
        return std::ranges::find(seen, slot) != seen.end() || !world.deformables.records.used(slot) ||
               may_sleep(world, world.deformables.records.at(slot), seen);
    });
}

// Where contacts of layers and of bodies hold a node alternately, it jitters for good.
bool is_quiet(DeformableRecord& record, const DeformableSleepSettings& settings) {
    if (fastest_node(record) < settings.max_speed) return true;
    if (record.solid()) return false;
    const std::vector<Vec3>& places = record.nodes().position;
    const auto has_stayed = [&](Vec3 a, Vec3 b) { return length(a - b) < settings.max_displacement; };
    if (std::ranges::equal(places, record.quiet_places, has_stayed)) return true;
    record.quiet_places = places;
    return false;
}

// Bodies that they touch stay awake while they are not quiet.
void note_quiet(const DeformableAccess& world, MovingDeformables& moving) {
    for (DeformableRecord* record : moving.records) {
        const bool is_blown = record->cloth() && wind_at(world.settings, world.report.time).is_gusty();
        const bool is_calm = !is_blown && is_quiet(*record, world.settings.solver.deformable.sleep);
        record->quiet_time = is_calm ? record->quiet_time + world.settings.time_step : 0;
        for (const std::uint32_t slot : record->touched_bodies) {
            if (!world.rigid.is_used(slot) || !world.rigid.is_dynamic(slot)) continue;
            world.activity.sleep[slot].quiet_time = std::min(world.activity.sleep[slot].quiet_time, record->quiet_time);
        }
    }
}

// Deformables sleep when they are quiet and so is all that they touch: at once with the bodies, for forces found while
// the bodies stand as if fixed would differ from those that held them.
void let_deformables_sleep(const DeformableAccess& world) {
    if (!world.settings.sleeping) return;
    std::vector<DeformableRecord*> ready;
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        DeformableRecord& record = world.deformables.records.at(slot);
        if (!record.definition.enabled || record.is_asleep) continue;
        std::vector<std::uint32_t> seen;
        if (may_sleep(world, record, seen)) ready.push_back(&record);
    }
    for (DeformableRecord* record : ready) {
        record->is_asleep = true;
        record->rest();
    }
}

}  // namespace

void advance_deformables(const DeformableAccess& world) {
    MovingDeformables moving;
    let_deformables_sleep(world);
    while (wake_disturbed(world) || wake_touched_thin(world)) {
    }
    for (std::uint32_t slot = 0; slot < world.deformables.records.slot_count(); ++slot) {
        if (!world.deformables.records.used(slot)) continue;
        DeformableRecord& record = world.deformables.records.at(slot);
        if (!record.definition.enabled || record.is_asleep) continue;
        record.slot = slot;
        moving.records.push_back(&record);
        if (record.solid()) {
            moving.solid_records.push_back(&record);
            moving.solids.push_back(record.solid());
        } else {
            moving.thin.push_back({.record = &record});
        }
    }
    gather_bodies(world, moving);
    count_whole_turns(world, moving);
    moving.contacts = find_solid_contacts(world, moving.solid_records, moving.bodies);
    find_spins_of_balls(world, moving);
    for (ThinDeformable& thin : moving.thin) find_contacts_of(world, moving, thin);
    find_supports(world, moving.contacts, moving.thin, moving.bodies);
    moving.groups = find_thin_groups(world, moving.thin, moving.bodies);
    run_substeps(world, moving);
    put_back_bodies(world, moving);
    if (!moving.records.empty())
        limit_speeds({world.settings, world.activity, world.workers, world.report, world.rigid});
    keep_contacts(world, moving);
    freeze_broken(world, moving);
    note_quiet(world, moving);
}

}  // namespace embody::physics::stages
