// SPDX-License-Identifier: MIT
// Taps and drains of entities (docs/scene-format.md, "Taps and drains"). What they are in the world follows their
// entities before each step: a tap's liquid may have moved to another fluid, be disabled or be gone.
#include <algorithm>
#include <cmath>

#include "scene/matter/fluid_body.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

constexpr double litres_per_minute = 1.0 / 60'000;  // m³/s

physics::FluidSource source_of(const Tap& tap) {
    return {.position = tap.position,
            .radius = tap.radius,
            .rate = tap.litres_per_minute * litres_per_minute,
            .speed = tap.speed};
}

physics::FluidDrain drain_of(const Drain& drain) { return {.position = drain.position, .radius = drain.radius}; }

Error of_port(const char* port, Error error) {
    error.where = error.where == "rate" ? "litres_per_minute" : error.where;
    error.where = std::string(port) + "." + error.where;
    return error;
}

bool is_tap(const Entity& entity) { return entity.tap.litres_per_minute > 0; }
bool is_drain(const Entity& entity) { return entity.drain.radius > 0; }

}  // namespace

Result<void> check_ports(const Entity& entity) {
    if (is_tap(entity)) {
        physics::FluidSource source = source_of(entity.tap);
        source.fluid.generation = 1;  // any but none
        if (Result<void> valid = validate(physics::FluidPort(source)); !valid.ok())
            return of_port("tap", valid.error());
    }
    if (!is_drain(entity)) return {};
    Result<void> valid = validate(physics::FluidPort(drain_of(entity.drain)));
    return valid.ok() ? valid : of_port("drain", valid.error());
}

void Simulation::State::list_ports(const LiveEntity& entity) {
    const EntityIndex index = entity.definition.index;
    if (as_liquid(entity.points.get()) != nullptr)
        liquid_entities.insert(index);
    else
        liquid_entities.erase(index);
    if (is_tap(entity.definition) || is_drain(entity.definition)) {
        ports.try_emplace(index);
        return;
    }
    unlist_ports(index);
}

void Simulation::State::unlist_ports(EntityIndex index) {
    const auto found = ports.find(index);
    if (found == ports.end()) return;
    put_port(found->second.tap, {});
    put_port(found->second.drain, {});
    ports.erase(found);
}

// Null where there is none.
const LiveEntity* Simulation::State::liquid_of(const Tap& tap) const {
    if (tap.liquid == 0) return liquid_entities.empty() ? nullptr : find(*liquid_entities.begin());
    return liquid_entities.contains(tap.liquid) ? find(tap.liquid) : nullptr;
}

std::optional<Error> Simulation::State::port_fault(const LiveEntity& entity) const {
    const Tap& tap = entity.definition.tap;
    if (entity.points)
        return Error{is_tap(entity.definition) ? "tap" : "drain", "is of a thing that is not one rigid body",
                     "put it on a rigid or static thing"};
    if (!is_tap(entity.definition) || liquid_of(tap) != nullptr) return {};
    if (tap.liquid == 0) return Error{"tap.liquid", "is not set, and the scene has no liquid", "add a liquid"};
    const std::string who = "is entity " + std::to_string(tap.liquid);
    if (find(tap.liquid) == nullptr) return Error{"tap.liquid", who + ", which is not there", "set it to a liquid"};
    return Error{"tap.liquid", who + ", which is no liquid", "set it to a liquid"};
}

void Simulation::State::put_port(LivePort& port, const std::optional<physics::FluidPort>& wanted) {
    if (!wanted && !port.handle.is_null()) {
        // The port is in the world, so that the world does not refuse.
        (void)world->destroy_fluid_port(port.handle).ok();
        port.handle = {};
        port.seen = 0;
    }
    if (!wanted) return;
    Result<void> put;
    if (!port.handle.is_null()) {
        put = world->set_fluid_port(port.handle, *wanted);
    } else if (const auto made = world->create_fluid_port(*wanted); made.ok()) {
        port.handle = made.value();
    } else {
        put = made.error();
    }
    if (!put.ok()) actions->problems.push_back(put.error());
}

// None while nothing can come. Its particles are of the liquid's matter, and it waits while the liquid is full.
std::optional<physics::FluidSource> Simulation::State::open_source(const LiveEntity& entity) {
    const Tap& tap = entity.definition.tap;
    if (!is_tap(entity.definition) || !tap.open || port_fault(entity)) return {};
    const FluidBody* liquid = as_liquid(liquid_of(tap)->points.get());
    Liquids::Part* part = liquid->part();
    if (part == nullptr || world->fluid_particles(part->fluid).is_frozen) return {};
    const physics::FluidParticles all = world->fluid_particles(part->fluid);
    const std::size_t others = all.positions.size() - liquids.particles_of(*part).size();
    physics::FluidSource source = source_of(tap);
    source.fluid = part->fluid;
    source.body = entity.body;
    source.matter = part->matter;
    source.max_particles = std::min(others + liquid->max_drops(), physics::max_fluid_particles);
    return source;
}

void Simulation::State::set_ports() {
    struct OpenTap {
        LivePort& port;
        physics::FluidSource source;
        Liquids::Part* part;
    };
    std::vector<OpenTap> open;
    std::map<EntityIndex, std::uint32_t> comes;  // particles by liquid, in a step
    for (auto& [index, its] : ports) {
        const LiveEntity& entity = live.at(index);
        const Drain& drain = entity.definition.drain;
        std::optional<physics::FluidPort> hole;
        if (is_drain(entity.definition) && drain.open && !port_fault(entity)) {
            physics::FluidDrain placed = drain_of(drain);
            placed.body = entity.body;
            hole = placed;
        }
        put_port(its.drain, hole);
        const std::optional<physics::FluidSource> source = open_source(entity);
        its.fed = nullptr;
        if (!source) {
            put_port(its.tap, {});
            continue;
        }
        const LiveEntity& liquid = *liquid_of(entity.definition.tap);
        const double owed = source->rate * world->settings().time_step;
        const double count = std::ceil(owed / world->fluid_particles(source->fluid).particle_volume) + 1;
        const std::size_t limit = as_liquid(liquid.points.get())->max_drops();
        std::uint32_t& all = comes[liquid.definition.index];
        all = static_cast<std::uint32_t>(std::min(all + count, static_cast<double>(limit)));
        its.fed = as_liquid(liquid.points.get())->part();
        open.push_back({its.tap, *source, its.fed});
    }
    for (const auto& [index, count] : comes) {
        const Result<void> room = liquids.make_room(*as_liquid(live.at(index).points.get())->part(), count);
        if (!room.ok()) actions->problems.push_back(of_entity(live.at(index).definition, room.error()));
    }
    for (OpenTap& tap : open) {
        tap.source.ids = tap.part->room;
        put_port(tap.port, tap.source);
    }
}

void Simulation::State::count_ports() {
    const auto count = [this](LivePort& port) {
        const std::uint64_t passed = world->passed_particles(port.handle);
        const std::uint64_t now = passed - std::exchange(port.seen, passed);
        port.passed += now;
        return now;
    };
    for (auto& [index, its] : ports) {
        if (!its.drain.handle.is_null()) count(its.drain);
        if (its.fed != nullptr) Liquids::count_poured(*its.fed, count(its.tap));
    }
}

Simulation::PassedDrops Simulation::passed_drops(EntityIndex entity) const {
    const auto found = state_->ports.find(entity);
    return found == state_->ports.end() ? PassedDrops{}
                                        : PassedDrops{found->second.tap.passed, found->second.drain.passed};
}

std::vector<EntityIndex> Simulation::waiting_taps() const {
    std::vector<EntityIndex> waiting;
    for (const auto& [index, its] : state_->ports)
        if (state_->world->is_waiting(its.tap.handle)) waiting.push_back(index);
    return waiting;
}

std::vector<PortFault> Simulation::port_faults() const {
    std::vector<PortFault> faults;
    for (const auto& [index, its] : state_->ports)
        if (const auto fault = state_->port_fault(state_->live.at(index))) faults.push_back({index, *fault});
    return faults;
}

}  // namespace embody::scene
