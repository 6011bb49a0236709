// SPDX-License-Identifier: MIT
#include "scene/matter/liquids.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace embody::scene {

using physics::FluidDefinition;
using physics::FluidHandle;
using physics::FluidParticles;
using physics::LiquidMatter;

namespace {

// The solver's grid spans all liquid of a fluid with a margin of about this many cells. Bodies of liquid so far apart
// that the grid would have more cells do not use one fluid.
constexpr double max_cells = 500'000, margin = 24;

LiquidMatter matter_of(const FluidDefinition& fluid) {
    return {fluid.density, fluid.viscosity, fluid.yield_stress, fluid.surface_tension};
}

void set_matter_of(FluidDefinition& fluid, const LiquidMatter& matter) {
    fluid.density = matter.density;
    fluid.viscosity = matter.viscosity;
    fluid.yield_stress = matter.yield_stress;
    fluid.surface_tension = matter.surface_tension;
}

// Whether one of them comes upon the other where it falls.
bool are_above_each_other(const Bounds& a, const Bounds& b) {
    return a.lower.x < b.upper.x && b.lower.x < a.upper.x && a.lower.z < b.upper.z && b.lower.z < a.upper.z;
}

bool are_within(double ratio, double limit) { return ratio <= limit && ratio >= 1 / limit; }

double cells_of(const Bounds& bounds, double cell) {
    if (bounds.is_empty()) return 0;
    const Vec3 size = bounds.size() / cell;
    return (size.x + margin) * (size.y + margin) * (size.z + margin);
}

}  // namespace

Bounds Liquids::bounds_of(SharedFluid& shared) {
    locate(shared);
    Bounds bounds = world_.fluid_particles(shared.fluid).bounds;
    for (const auto& part : shared.parts)
        if (part->places.empty()) bounds.add(part->start);
    return bounds;
}

Liquids::SharedFluid* Liquids::to_join(const Wish& wish) {
    for (SharedFluid& shared : fluids_) {
        if (shared.fluid == wish.except) continue;
        const FluidDefinition& other = *world_.fluid(shared.fluid);
        const FluidParticles particles = world_.fluid_particles(shared.fluid);
        const Bounds bounds = bounds_of(shared);
        const bool is_moved_alike =
            wish.matter.gravity_factor == other.gravity_factor && wish.matter.allow_sleep == other.allow_sleep;
        if (!is_moved_alike || particles.is_frozen) continue;
        const auto is_set_alike = [&](const auto& part) {
            return part->set_cell_size > 0 && are_within(wish.set_cell_size / part->set_cell_size, max_ratio);
        };
        const auto is_same = [&](const auto& part) { return part->matter == matter_of(wish.matter); };
        const bool are_layers = wish.ratio_limit > 1 && std::ranges::none_of(shared.parts, is_same) &&
                                are_above_each_other(bounds, wish.bounds);
        if (!are_within(wish.matter.cell_size / other.cell_size, wish.ratio_limit) && !are_layers &&
            std::ranges::none_of(shared.parts, is_set_alike))
            continue;
        Bounds both = bounds;
        both.add(wish.bounds);
        if (cells_of(both, other.cell_size) < max_cells) return &shared;
    }
    return nullptr;
}

double Liquids::cell_size(const FluidDefinition& matter, double set_cell_size, const Bounds& bounds) {
    const SharedFluid* shared = to_join({matter, bounds, max_ratio, set_cell_size, {}});
    return shared ? world_.fluid(shared->fluid)->cell_size : matter.cell_size;
}

Result<Liquids::Part*> Liquids::add(const FluidDefinition& matter, std::span<const Vec3> places) {
    Bounds bounds;
    for (const Vec3 place : places) bounds.add(place);
    auto part = std::make_unique<Part>();
    Part* added = part.get();
    part->matter = matter_of(matter);
    part->start = bounds;
    if (const SharedFluid* shared = to_join({matter, bounds})) {
        part->fluid = shared->fluid;
        const Result<physics::FluidIds> ids = world_.add_to_fluid(part->fluid, places);
        if (!ids.ok()) return ids.error();
        part->ids = ids.value();
        if (Result<void> set = world_.set_liquid(part->fluid, part->ids, part->matter); !set.ok()) return set.error();
    } else {
        FluidDefinition definition = matter;
        definition.points.assign(places.begin(), places.end());
        const Result<FluidHandle> fluid = world_.create_fluid(definition);
        if (!fluid.ok()) return fluid.error();
        const auto count = static_cast<std::uint32_t>(world_.fluid_particles(fluid.value()).ids.size());
        part->fluid = fluid.value();
        part->ids = {0, count};
    }
    put(std::move(part));
    return added;
}

Result<Liquids::Part*> Liquids::add_empty(const FluidDefinition& matter, const Bounds& bounds) {
    auto part = std::make_unique<Part>();
    Part* added = part.get();
    part->matter = matter_of(matter);
    part->start = bounds;
    if (const SharedFluid* shared = to_join({matter, bounds})) {
        part->fluid = shared->fluid;
        const Result<physics::FluidIds> ids = world_.make_room(part->fluid, {}, 0);
        if (!ids.ok()) return ids.error();
        part->ids = ids.value();
    } else {
        FluidDefinition definition = matter;
        definition.points = {bounds.lower, bounds.upper};
        definition.starts_empty = true;
        const Result<FluidHandle> fluid = world_.create_fluid(definition);
        if (!fluid.ok()) return fluid.error();
        part->fluid = fluid.value();
    }
    put(std::move(part));
    return added;
}

Result<Liquids::Part*> Liquids::add_drops(const FluidDefinition& matter, std::span<const physics::FluidDrop> drops) {
    Bounds bounds;
    for (const physics::FluidDrop& drop : drops) bounds.add(drop.position);
    const Result<Part*> added = add_empty(matter, bounds);
    if (!added.ok()) return added;
    if (const Result<void> set = set_drops(*added.value(), drops); !set.ok()) {
        remove(added.value());
        return set.error();
    }
    return added;
}

// Adds the part to its fluid's list; the newest ids are the largest.
void Liquids::put(std::unique_ptr<Part> part) {
    auto shared = find(part->fluid);
    if (shared == fluids_.end()) shared = fluids_.insert(shared, SharedFluid{part->fluid, {}, 0});
    shared->parts.push_back(std::move(part));
    shared->version = 0;
}

// The part is the last one then; its ids have no room.
void Liquids::set_newest_ids(Part& part, physics::FluidIds ids) {
    SharedFluid& shared = *find(part.fluid);
    const auto at = std::ranges::find_if(shared.parts, [&](const auto& other) { return other.get() == &part; });
    std::rotate(at, at + 1, shared.parts.end());
    shared.version = 0;
    part.ids = ids;
    part.room = {};
    part.used_room = 0;
}

Result<void> Liquids::make_room(Part& part, std::uint32_t count) {
    if (part.room.last - part.room.first - part.used_room >= count) return {};
    // Doubled each time, so that the ids of a particle change a few times only.
    constexpr std::size_t min_room = 4096;
    const auto room = static_cast<std::uint32_t>(std::max({std::size_t{count}, min_room, particles_of(part).size()}));
    const Result<physics::FluidIds> ids = world_.make_room(part.fluid, part.ids, room);
    if (!ids.ok()) return ids.error();
    set_newest_ids(part, ids.value());
    part.room = {ids.value().last - room, ids.value().last};
    return {};
}

void Liquids::count_poured(Part& part, std::uint64_t count) {
    part.poured += count;
    part.used_room += static_cast<std::uint32_t>(count);
}

Result<void> Liquids::set_drops(Part& part, std::span<const physics::FluidDrop> drops) {
    const Result<physics::FluidIds> ids = world_.add_drops(part.fluid, drops);
    if (!ids.ok()) return ids.error();
    const auto remove = [](std::uint32_t, Vec3&, Vec3&) { return false; };
    if (Result<void> removed = world_.change_fluid(part.fluid, part.ids, remove); !removed.ok()) return removed;
    set_newest_ids(part, ids.value());
    return world_.set_liquid(part.fluid, part.ids, part.matter);
}

Result<void> Liquids::append(Part& part, std::span<const physics::FluidDrop> drops) {
    Bounds all = bounds_of(*find(part.fluid));
    for (const physics::FluidDrop& drop : drops) all.add(drop.position);
    if (cells_of(all, world_.fluid(part.fluid)->cell_size) >= max_cells)
        return Error{"liquid", "is too far away: one grid would have to span both",
                     "bring them together, or let it become a liquid of its own"};
    const Result<physics::FluidIds> own = world_.make_room(part.fluid, part.ids, 0);
    if (!own.ok()) return own.error();
    set_newest_ids(part, own.value());
    const Result<physics::FluidIds> added = world_.add_drops(part.fluid, drops);
    if (!added.ok()) return added.error();
    part.ids.last = added.value().last;
    part.poured += drops.size();
    return world_.set_liquid(part.fluid, added.value(), part.matter);
}

// Removes the part from its fluid's list, and the list with its last part.
std::unique_ptr<Liquids::Part> Liquids::take(Part& part) {
    const auto shared = find(part.fluid);
    const auto at = std::ranges::find_if(shared->parts, [&](const auto& other) { return other.get() == &part; });
    std::unique_ptr<Part> taken = std::move(*at);
    shared->parts.erase(at);
    if (!shared->parts.empty()) return taken;
    // The fluid is in the world, so that the world does not refuse.
    (void)world_.destroy_fluid(part.fluid).ok();
    fluids_.erase(shared);
    return taken;
}

void Liquids::remove(Part* part) {
    const std::unique_ptr<Part> taken = take(*part);
    if (find(taken->fluid) == fluids_.end()) return;
    (void)world_.change_fluid(taken->fluid, taken->ids, [](std::uint32_t, Vec3&, Vec3&) { return false; }).ok();
}

// Finds the particles of all parts of a fluid in one pass over its particles.
void Liquids::locate(SharedFluid& shared) {
    const FluidParticles particles = world_.fluid_particles(shared.fluid);
    if (shared.version == particles.version) return;
    constexpr std::uint32_t none = ~std::uint32_t{0};
    for (const auto& part : shared.parts) part->places.assign(part->ids.last - part->ids.first, none);
    for (std::size_t i = 0; i < particles.ids.size(); ++i) {
        const std::uint32_t id = particles.ids[i];
        const auto above = std::ranges::upper_bound(shared.parts, id, {}, [](const auto& s) { return s->ids.first; });
        Part& part = **(above - 1);
        part.places[id - part.ids.first] = static_cast<std::uint32_t>(i);
    }
    for (const auto& part : shared.parts) std::erase(part->places, none);
    shared.version = particles.version;
}

const std::vector<std::uint32_t>& Liquids::particles_of(const Part& part) {
    locate(*find(part.fluid));
    return part.places;
}

Bounds Liquids::bounds_of(const Part& part) {
    const FluidParticles particles = world_.fluid_particles(part.fluid);
    Bounds bounds;
    for (const std::uint32_t i : particles_of(part)) bounds.add(particles.origin + to_vec3(particles.positions[i]));
    return bounds;
}

// Moves the particles to another fluid, or to a new one.
Result<void> Liquids::hand_over(Part& part, FluidHandle to) {
    const Result<physics::FluidPart> moved = world_.move_between_fluids(part.fluid, part.ids, to);
    if (!moved.ok()) return moved.error();
    std::unique_ptr<Part> taken = take(part);
    taken->fluid = moved.value().fluid;
    taken->ids = moved.value().ids;
    taken->room = {};
    taken->used_room = 0;
    put(std::move(taken));
    return {};
}

Result<void> Liquids::set_matter(Part& part, const FluidDefinition& matter) {
    part.matter = matter_of(matter);
    FluidDefinition changed = *world_.fluid(part.fluid);
    if (changed.allow_sleep != matter.allow_sleep) {
        // The other parts of its fluid stay unchanged.
        if (find(part.fluid)->parts.size() > 1) {
            if (Result<void> alone = hand_over(part, {}); !alone.ok()) return alone;
        }
        changed.allow_sleep = matter.allow_sleep;
        if (Result<void> set = world_.set_fluid(part.fluid, changed); !set.ok()) return set;
    }
    if (Result<void> set = world_.set_liquid(part.fluid, part.ids, part.matter); !set.ok()) return set;
    return regroup(part);
}

Result<void> Liquids::regroup(Part& part) {
    const FluidParticles particles = world_.fluid_particles(part.fluid);
    if (particles.is_frozen || particles_of(part).empty()) return {};
    const bool is_alone = find(part.fluid)->parts.size() == 1;
    if (!is_alone && cells_of(particles.bounds, particles.cell_size) < max_cells) return {};
    const Bounds bounds = bounds_of(part);
    FluidDefinition wanted = *world_.fluid(part.fluid);
    set_matter_of(wanted, part.matter);
    const SharedFluid* other = to_join({wanted, bounds, 1, 0, part.fluid});
    if (is_alone && !other) return {};
    return hand_over(part, other ? other->fluid : FluidHandle{});
}

void Liquids::push(double dt) {
    for (const SharedFluid& shared : fluids_) {
        const double cell = world_.fluid(shared.fluid)->cell_size;
        for (const auto& part : shared.parts) {
            const double particle = part->matter.density * cell * cell * cell / 8;
            const std::size_t count = part->force == Vec3{} ? 0 : particles_of(*part).size();
            if (count == 0 || world_.fluid_particles(shared.fluid).is_frozen) continue;
            const Vec3 change = dt / (particle * static_cast<double>(count)) * part->force;
            // The fluid is in the world, so that the world does not refuse.
            (void)world_
                .change_fluid(shared.fluid, part->ids,
                              [change](std::uint32_t, Vec3&, Vec3& velocity) {
                                  velocity += change;
                                  return true;
                              })
                .ok();
        }
    }
}

void Liquids::separate_distant() {
    std::vector<Part*> far;
    for (SharedFluid& shared : fluids_) {
        const FluidParticles particles = world_.fluid_particles(shared.fluid);
        if (shared.parts.size() < 2 || particles.is_asleep || particles.is_frozen) continue;
        const double all = cells_of(particles.bounds, particles.cell_size);
        if (all < max_cells) continue;
        for (const auto& part : shared.parts) {
            Bounds others;
            for (const auto& other : shared.parts) {
                if (other != part) others.add(bounds_of(*other));
            }
            const double apart =
                cells_of(bounds_of(*part), particles.cell_size) + cells_of(others, particles.cell_size);
            if (apart > all / 2) continue;
            far.push_back(part.get());
            break;
        }
    }
    // The fluid is in the world and not frozen, so that the world does not refuse.
    for (Part* part : far) (void)hand_over(*part, {}).ok();
}

std::vector<Liquids::SharedFluid>::iterator Liquids::find(FluidHandle fluid) {
    return std::ranges::find_if(fluids_, [fluid](const SharedFluid& shared) { return shared.fluid == fluid; });
}

}  // namespace embody::scene
