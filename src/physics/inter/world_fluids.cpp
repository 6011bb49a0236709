// SPDX-License-Identifier: MIT
#include "physics/inter/world.h"

#include <cmath>
#include <limits>
#include <string>

#include "physics/definitions/field_check.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;
using namespace stages;

namespace {

// Volumes of particles that differ by no more than this are equal: rounding of a mean over the particles.
constexpr double same_volume = 1e-9;

}  // namespace

Result<FluidHandle> World::create_fluid(const FluidDefinition& definition) {
    auto record = set_up_fluid(ObstacleAccess(*state_), definition);
    if (!record) return record.error();
    prepare_fluid(FluidAccess(*state_), *record);
    return state_->fluids.records.insert(std::move(*record));
}

Result<void> World::destroy_fluid(FluidHandle fluid) {
    const FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    for (const auto& [slot, seen] : record->seen) {
        if (state_->rigid.is_used(slot)) wake_later(state_->activity, slot);
    }
    state_->fluids.records.remove(fluid);
    return {};
}

std::vector<FluidHandle> World::fluids() const {
    std::vector<FluidHandle> handles;
    for (std::uint32_t slot = 0; slot < state_->fluids.records.slot_count(); ++slot) {
        if (state_->fluids.records.used(slot)) handles.push_back(state_->fluids.records.handle_at(slot));
    }
    return handles;
}

const FluidDefinition* World::fluid(FluidHandle fluid) const {
    const FluidRecord* record = state_->fluids.records.find(fluid);
    return record != nullptr ? &record->definition : nullptr;
}

Result<void> World::set_fluid(FluidHandle fluid, const FluidDefinition& definition) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    if (auto result = validate(definition); !result) return result;
    if (definition.cell_size != record->definition.cell_size)
        return Error{"cell_size", "cannot change", "destroy the fluid and create another one"};
    record->definition = definition;
    record->solver->set_matter({.density = definition.density,
                                .viscosity = definition.viscosity,
                                .yield_stress = definition.yield_stress,
                                .surface_tension = definition.surface_tension});
    return wake(fluid);
}

Result<void> World::set_liquid(FluidHandle fluid, FluidIds ids, const LiquidMatter& matter) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    if (auto result = validate(matter); !result) return result;
    record->solver->set_matter(ids, {.density = matter.density,
                                     .viscosity = matter.viscosity,
                                     .yield_stress = matter.yield_stress,
                                     .surface_tension = matter.surface_tension});
    read_particles(*record, *state_->workers);
    return wake(fluid);
}

Result<FluidIds> World::add_to_fluid(FluidHandle fluid, std::span<const Vec3> places) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    if (record->is_frozen) return Error{"fluid", "is frozen", "destroy it and create another one"};
    const auto ids = add_particles(ObstacleAccess(*state_), *record, places);
    if (!ids) return ids.error();
    if (Result<void> awake = wake(fluid); !awake) return awake.error();
    return *ids;
}

Result<FluidIds> World::add_drops(FluidHandle fluid, std::span<const FluidDrop> drops) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    if (record->is_frozen) return Error{"fluid", "is frozen", "destroy it and create another one"};
    for (std::size_t i = 0; i < drops.size(); ++i) {
        const std::string where = "drops[" + std::to_string(i) + "].";
        if (auto valid = first_error(check_vector(where + "position", drops[i].position, largest_coordinate, "m"),
                                     check_vector(where + "velocity", drops[i].velocity, largest_coordinate, "m/s"));
            !valid)
            return valid.error();
    }
    if (Result<void> room = check_room(*record, drops.size()); !room) return room.error();
    const FluidIds ids = stages::add_drops(*record, drops, *state_->workers);
    if (Result<void> awake = wake(fluid); !awake) return awake.error();
    return ids;
}

Result<FluidIds> World::make_room(FluidHandle fluid, FluidIds ids, std::uint32_t room) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    if (record->is_frozen) return Error{"fluid", "is frozen", "destroy it and create another one"};
    // The particles that are renumbered need ids, too.
    constexpr std::uint32_t max_room = std::numeric_limits<std::uint32_t>::max() - max_fluid_particles;
    const FluidSolver& solver = *record->solver;
    if (room > max_room || solver.next_id() > max_room - room)
        return Error{"ids", "of this fluid are used up", "destroy it and create another one"};
    const FluidIds moved = move_particles(*record, ids, *record);
    const FluidIds kept = record->solver->keep_ids(room);
    read_particles(*record, *state_->workers);
    if (Result<void> awake = wake(fluid); !awake) return awake.error();
    return FluidIds{moved.last > moved.first ? moved.first : kept.first, kept.last};
}

Result<void> World::change_fluid(FluidHandle fluid, FluidIds ids, const FluidChange& change) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    record->solver->change_particles(ids, change);
    read_particles(*record, *state_->workers);
    return wake(fluid);
}

Result<FluidPart> World::move_between_fluids(FluidHandle from, FluidIds ids, FluidHandle to) {
    FluidRecord* source = state_->fluids.records.find(from);
    if (source == nullptr) return Error{"from", "is not one of this world"};
    if (source->is_frozen) return Error{"from", "is frozen", "destroy it and create another one"};
    FluidHandle target = to;
    if (target.is_null()) {
        target = state_->fluids.records.insert(fluid_around(*source, ids));
        source = state_->fluids.records.find(from);
    }
    FluidRecord* record = state_->fluids.records.find(target);
    if (record == nullptr) return Error{"to", "is not one of this world"};
    if (record == source) return Error{"to", "is the fluid that they are in"};
    if (record->is_frozen) return Error{"to", "is frozen", "destroy it and create another one"};
    const double ratio = record->solver->properties().particle_volume / source->solver->properties().particle_volume;
    if (record->definition.cell_size != source->definition.cell_size || std::fabs(ratio - 1) > same_volume)
        return Error{"to", "has particles of another size"};
    FluidPart part{target, move_particles(*source, ids, *record)};
    for (FluidRecord* changed : {source, record}) read_particles(*changed, *state_->workers);
    for (const FluidHandle changed : {from, target}) {
        if (Result<void> awake = wake(changed); !awake) return awake.error();
    }
    if (to.is_null()) prepare_fluid(FluidAccess(*state_), *record);
    return part;
}

FluidParticles World::fluid_particles(FluidHandle fluid) const {
    const FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return {};
    return {record->solver->origin(),
            record->positions,
            record->velocities,
            record->ids,
            record->solver->properties().particle_volume,
            record->bounds,
            record->definition.cell_size,
            record->is_asleep,
            record->is_frozen,
            record->version};
}

double World::fluid_pressure(FluidHandle fluid, Vec3 point) const {
    const FluidRecord* record = state_->fluids.records.find(fluid);
    return record != nullptr ? record->solver->pressure_at(point - record->solver->origin()) : 0;
}

FluidForce World::fluid_force(BodyHandle body) const {
    if (!contains(body)) return {};
    const BodyRecord& record = state_->rigid.record(body.index);
    return {record.fluid_force, record.fluid_torque};
}

Result<void> World::wake(FluidHandle fluid) {
    FluidRecord* record = state_->fluids.records.find(fluid);
    if (record == nullptr) return Error{"fluid", "is not one of this world"};
    record->is_asleep = false;
    record->quiet_time = 0;
    for (const auto& [slot, seen] : record->seen) {
        if (state_->rigid.is_used(slot)) wake_later(state_->activity, slot);
    }
    return {};
}

}  // namespace embody::physics
