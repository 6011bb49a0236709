// SPDX-License-Identifier: MIT
#include "physics/inter/world.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

// Whether the port makes sense, and what it names is in the world.
Result<void> check(const WorldState& world, const FluidPort& port) {
    if (Result<void> valid = validate(port); !valid) return valid;
    const auto* source = std::get_if<FluidSource>(&port);
    const FluidRecord* fluid = source != nullptr ? world.fluids.records.find(source->fluid) : nullptr;
    if (source != nullptr && fluid == nullptr) return Error{"fluid", "is not one of this world"};
    if (source != nullptr && source->ids.last > fluid->solver->next_id())
        return Error{"ids", "are not kept free", "have them from World::make_room"};
    const BodyHandle body = std::visit([](const auto& of_kind) { return of_kind.body; }, port);
    if (!body.is_null() && !world.rigid.bodies.contains(body)) return Error{"body", "is not one of this world"};
    return {};
}

}  // namespace

Result<FluidPortHandle> World::create_fluid_port(const FluidPort& port) {
    if (Result<void> valid = check(*state_, port); !valid) return valid.error();
    return state_->fluids.ports.insert({.port = port});
}

Result<void> World::set_fluid_port(FluidPortHandle handle, const FluidPort& port) {
    FluidPortRecord* record = state_->fluids.ports.find(handle);
    if (record == nullptr) return Error{"port", "is not one of this world"};
    if (Result<void> valid = check(*state_, port); !valid) return valid;
    record->port = port;
    return {};
}

Result<void> World::destroy_fluid_port(FluidPortHandle handle) {
    if (!state_->fluids.ports.contains(handle)) return Error{"port", "is not one of this world"};
    state_->fluids.ports.remove(handle);
    return {};
}

const FluidPort* World::fluid_port(FluidPortHandle handle) const {
    const FluidPortRecord* record = state_->fluids.ports.find(handle);
    return record != nullptr ? &record->port : nullptr;
}

std::uint64_t World::passed_particles(FluidPortHandle handle) const {
    const FluidPortRecord* record = state_->fluids.ports.find(handle);
    return record != nullptr ? record->passed : 0;
}

bool World::is_waiting(FluidPortHandle handle) const {
    const FluidPortRecord* record = state_->fluids.ports.find(handle);
    return record != nullptr && record->waits;
}

}  // namespace embody::physics
