// SPDX-License-Identifier: MIT
#include "physics/inter/world.h"

#include "foundation/state_hash.h"
#include "physics/dynamic/conserved.h"
#include "physics/stages/rigid/body_setup.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/world_state.h"
#include "physics/step/step.h"

namespace embody::physics {

using namespace state;
using namespace stages;

World::World() : state_(std::make_unique<WorldState>()) {}
World::~World() = default;

Result<std::unique_ptr<World>> World::create(const WorldSettings& settings) {
    std::unique_ptr<World> world(new World());
    if (auto result = world->set_settings(settings); !result) return result.error();
    return world;
}

const WorldSettings& World::settings() const { return state_->settings; }

Result<void> World::set_settings(const WorldSettings& settings) {
    if (auto result = validate(settings); !result) return result;
    if (auto result = choose_lanes(state_->substeps, settings.lanes); !result) return result;
    const auto use = settings.workers > 0 ? TaskPool::Use::all : TaskPool::Use::as_many_as_pay;
    const int workers = settings.workers > 0 ? settings.workers : TaskPool::workers_that_pay();
    if (workers != state_->workers->max_workers() || use != state_->workers->use())
        state_->workers = std::make_unique<TaskPool>(workers, use);
    state_->settings = settings;

    // A change of gravity, wind or sleeping affects everything.
    for (std::uint32_t body = 0; body < state_->rigid.bodies.slot_count(); ++body) wake_later(state_->activity, body);
    for (const DeformableHandle deformable : deformables()) {
        if (auto woken = wake(deformable); !woken) return woken;
    }
    return {};
}

Result<void> World::set_surface_pairs(SurfacePairs pairs) {
    if (!bodies().empty()) return Error{"surface_pairs", "must be set before the first body is created"};
    state_->rigid.surface_pairs = std::move(pairs);
    return {};
}

// Shapes.

Result<ShapeHandle> World::create_shape(const ShapeDefinition& definition) {
    auto shape = CollisionShape::create(definition);
    if (!shape) return shape.error();
    return state_->rigid.shapes.insert({std::move(shape).value(), 0});
}

Result<void> World::destroy_shape(ShapeHandle shape) {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    if (!record) return Error{"shape", "is not a shape of this world"};
    if (record->users > 0) return Error{"shape", "is used by " + std::to_string(record->users) + " bodies"};
    state_->rigid.shapes.remove(shape);
    return {};
}

const ShapeDefinition* World::shape(ShapeHandle shape) const {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    return record ? &record->shape->definition() : nullptr;
}

std::optional<double> World::volume(ShapeHandle shape) const {
    const ShapeRecord* record = state_->rigid.shapes.find(shape);
    if (!record) return std::nullopt;
    return record->shape->mass_properties().volume;
}

// Joints.

Result<JointHandle> World::create_joint(const JointDefinition& definition) {
    auto joint = set_up_joint(state_->rigid, definition);
    if (!joint) return joint.error();
    const JointHandle handle = state_->joints.records.insert({definition, std::move(joint).value()});
    add_jointed_pair(state_->joints, definition);

    // A body that other joints hold lies in the group of one of the two bodies.
    wake_touching(WakeAccess(*state_), definition.body_b.index);
    if (!definition.body_a.is_null()) wake_later(state_->activity, definition.body_a.index);
    return handle;
}

Result<void> World::destroy_joint(JointHandle joint) {
    const JointRecord* record = state_->joints.records.find(joint);
    if (!record) return Error{"joint", "is not a joint of this world"};
    wake_around(WakeAccess(*state_), record->definition.body_b.index);
    state_->joints.records.remove(joint);
    list_jointed_pairs(state_->joints);
    return {};
}

std::vector<JointHandle> World::joints() const {
    std::vector<JointHandle> handles;
    for (std::uint32_t slot = 0; slot < state_->joints.records.slot_count(); ++slot) {
        if (state_->joints.records.used(slot)) handles.push_back(state_->joints.records.handle_at(slot));
    }
    return handles;
}

std::optional<JointDefinition> World::joint(JointHandle joint) const {
    const JointRecord* record = state_->joints.records.find(joint);
    if (!record) return std::nullopt;
    return record->definition;
}

Result<void> World::set_joint(JointHandle joint, const JointDefinition& definition) {
    JointRecord* record = state_->joints.records.find(joint);
    if (!record) return Error{"joint", "is not a joint of this world"};
    auto constraint = set_up_joint(state_->rigid, definition);
    if (!constraint) return constraint.error();
    wake_around(WakeAccess(*state_), record->definition.body_b.index);
    *record = {definition, std::move(constraint).value()};
    list_jointed_pairs(state_->joints);
    wake_around(WakeAccess(*state_), definition.body_b.index);
    return {};
}

World::JointReaction World::joint_reaction(JointHandle joint) const {
    const JointRecord* record = state_->joints.records.find(joint);
    if (!record) return {};
    const double dt = state_->settings.time_step;
    return {record->constraint.total_linear / dt, record->constraint.total_angular / dt};
}

double World::joint_coordinate(JointHandle joint) const {
    const JointRecord* record = state_->joints.records.find(joint);
    return record ? constraint::joint_coordinate(record->constraint, state_->rigid.motion) : 0;
}

// Stepping and its results.

const StepReport& World::step() {
    step::step(*state_);
    replace_broken_bodies();
    tear_sheets();
    return state_->report;
}

void World::keep_account(bool is_wanted) {
    if (is_wanted != (state_->ledger != nullptr))
        state_->ledger = is_wanted ? std::make_unique<Ledger>(*state_) : nullptr;
}

const StepReport& World::last_report() const { return state_->report; }

void World::set_clock(double time, std::uint64_t step) {
    state_->report.time = time;
    state_->report.step = step;
}

std::span<const ContactEvent> World::contact_events() const { return state_->events.contacts; }
std::span<const RopeBreakEvent> World::rope_break_events() const { return state_->events.rope_breaks; }
std::span<const BodyBreakEvent> World::body_break_events() const { return state_->events.body_breaks; }
std::span<const SheetTearEvent> World::sheet_tear_events() const { return state_->events.sheet_tears; }
std::span<const SleepEvent> World::sleep_events() const { return state_->events.sleep; }

std::vector<ContactView> World::contacts() const {
    std::vector<ContactView> views;
    const auto add = [&](const Contact& contact) {
        // The region's friction is distributed over its points by their fraction of the load.
        double load = 0;
        for (int i = 0; i < contact.count; ++i) load += contact.points[static_cast<std::size_t>(i)].total;
        const Vec3 friction = friction_force(contact, contact.friction_total);
        for (int i = 0; i < contact.count; ++i) {
            const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
            const double separation = current_separation(contact, point, state_->rigid.motion);
            if (point.total <= 0 && separation > 0) continue;
            const double fraction = load > 0 ? point.total / load : 0;
            views.push_back({state_->rigid.bodies.handle_at(contact.a), state_->rigid.bodies.handle_at(contact.b),
                             position_of(contact, point, state_->rigid.motion), contact.normal, separation,
                             point.total * contact.normal + fraction * friction});
        }
    };
    for (const Contact& contact : state_->contacts.list) add(contact);
    for (const auto& [group, sleepers] : state_->activity.sleepers) {
        for (const Contact& contact : sleepers.contacts) add(contact);
    }
    return views;
}

Conserved World::conserved() const {
    Conserved sum;
    for (std::uint32_t body = 0; body < state_->rigid.bodies.slot_count(); ++body) {
        if (!state_->rigid.is_used(body) || !state_->rigid.is_dynamic(body)) continue;
        const BodyDefinition& definition = state_->rigid.record(body).definition;
        if (!definition.enabled) continue;
        add_conserved(sum, state_->rigid.motion[body], state_->rigid.constants[body],
                      state_->settings.gravity * definition.gravity_factor);
    }
    for (const DeformableHandle handle : deformables()) {
        const DeformableRecord& record = state_->deformables.records.at(handle.index);
        if (!record.definition.enabled) continue;
        const Conserved own = record.conserved(state_->settings.gravity * record.definition.gravity_factor);
        sum.kinetic_energy += own.kinetic_energy;
        sum.potential_energy += own.potential_energy;
        sum.linear_momentum += own.linear_momentum;
        sum.angular_momentum += own.angular_momentum;
    }
    for (const FluidHandle handle : fluids()) {
        const FluidRecord& record = state_->fluids.records.at(handle.index);
        const Conserved own = record.solver->conserved(state_->settings.gravity * record.definition.gravity_factor);
        sum.kinetic_energy += own.kinetic_energy;
        sum.potential_energy += own.potential_energy;
        sum.linear_momentum += own.linear_momentum;
        sum.angular_momentum += own.angular_momentum;
    }
    return sum;
}

std::uint64_t World::state_hash() const {
    StateHash hash;
    const auto add = [&](Vec3 v) {
        for (int i = 0; i < 3; ++i) hash.add(v[i]);
    };
    for (std::uint32_t body = 0; body < state_->rigid.bodies.slot_count(); ++body) {
        if (!state_->rigid.is_used(body)) continue;
        const BodyState& motion = state_->rigid.motion[body];
        hash.add(std::uint64_t{body});
        hash.add(static_cast<std::uint64_t>(state_->activity.sleep[body].state));
        add(motion.center);
        add(motion.linear_velocity);
        add(motion.angular_velocity);
        for (const double q : {motion.rotation.x, motion.rotation.y, motion.rotation.z, motion.rotation.w}) hash.add(q);
    }
    for (const DeformableHandle handle : deformables()) {
        for (const auto& values : {node_positions(handle), node_velocities(handle)}) {
            for (const Vec3 value : values) add(value);
        }
    }
    for (const FluidHandle handle : fluids()) {
        for (const FluidParticle& particle : state_->fluids.records.at(handle.index).solver->particles()) {
            for (int axis = 0; axis < 3; ++axis) {
                hash.add(static_cast<double>(particle.position[axis]));
                hash.add(static_cast<double>(particle.velocity[axis]));
            }
        }
    }
    return hash.value();
}

}  // namespace embody::physics
