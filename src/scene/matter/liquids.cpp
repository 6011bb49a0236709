// SPDX-License-Identifier: MIT
#include "scene/matter/liquids.h"

#include <algorithm>

namespace embody::scene {

using physics::FluidDefinition;
using physics::FluidHandle;
using physics::FluidParticles;

namespace {

// The solver's grid spans all liquid of a fluid with a margin of about this many cells. Bodies of liquid so far apart
// that the grid would have more cells do not use one fluid.
constexpr double most_cells = 500'000, margin = 24;

bool is_same_matter(const FluidDefinition& a, const FluidDefinition& b) {
    return a.density == b.density && a.viscosity == b.viscosity && a.yield_stress == b.yield_stress &&
           a.surface_tension == b.surface_tension && a.gravity_factor == b.gravity_factor &&
           a.allow_sleep == b.allow_sleep;
}

double cells_of(const Bounds& bounds, double cell) {
    if (bounds.is_empty()) return 0;
    const Vec3 size = bounds.size() / cell;
    return (size.x + margin) * (size.y + margin) * (size.z + margin);
}

}  // namespace

Liquids::Shared* Liquids::to_join(const FluidDefinition& matter, const Bounds& bounds, double most,
                                  FluidHandle except) {
    for (Shared& shared : fluids_) {
        if (shared.fluid == except) continue;
        const FluidDefinition& other = *world_.fluid(shared.fluid);
        const double ratio = matter.cell_size / other.cell_size;
        const FluidParticles particles = world_.fluid_particles(shared.fluid);
        if (!is_same_matter(matter, other) || ratio > most || ratio < 1 / most || particles.is_frozen) continue;
        Bounds both = particles.bounds;
        both.add(bounds);
        if (cells_of(both, other.cell_size) < most_cells) return &shared;
    }
    return nullptr;
}

double Liquids::cell_size(const FluidDefinition& matter, const Bounds& bounds) {
    const Shared* shared = to_join(matter, bounds, most_ratio);
    return shared ? world_.fluid(shared->fluid)->cell_size : matter.cell_size;
}

Result<Liquids::Share*> Liquids::add(const FluidDefinition& matter, std::span<const Vec3> places) {
    Bounds bounds;
    for (const Vec3 place : places) bounds.add(place);
    auto share = std::make_unique<Share>();
    Share* added = share.get();
    if (const Shared* shared = to_join(matter, bounds, 1)) {
        const Result<physics::FluidIds> ids = world_.add_to_fluid(shared->fluid, places);
        if (!ids.ok()) return ids.error();
        share->fluid = shared->fluid;
        share->ids = ids.value();
    } else {
        FluidDefinition definition = matter;
        definition.points.assign(places.begin(), places.end());
        const Result<FluidHandle> fluid = world_.create_fluid(definition);
        if (!fluid.ok()) return fluid.error();
        const auto count = static_cast<std::uint32_t>(world_.fluid_particles(fluid.value()).ids.size());
        share->fluid = fluid.value();
        share->ids = {0, count};
    }
    put(std::move(share));
    return added;
}

// Adds the share to its fluid's list; the newest ids are the largest.
void Liquids::put(std::unique_ptr<Share> share) {
    auto shared = find(share->fluid);
    if (shared == fluids_.end()) shared = fluids_.insert(shared, Shared{share->fluid, {}, 0});
    shared->shares.push_back(std::move(share));
    shared->version = 0;
}

// Removes the share from its fluid's list, and the list with its last share.
std::unique_ptr<Liquids::Share> Liquids::take(Share& share) {
    const auto shared = find(share.fluid);
    const auto at = std::ranges::find_if(shared->shares, [&](const auto& other) { return other.get() == &share; });
    std::unique_ptr<Share> taken = std::move(*at);
    shared->shares.erase(at);
    if (!shared->shares.empty()) return taken;
    // The fluid is in the world, so that the world does not refuse.
    (void)world_.destroy_fluid(share.fluid).ok();
    fluids_.erase(shared);
    return taken;
}

void Liquids::remove(Share* share) {
    const std::unique_ptr<Share> taken = take(*share);
    if (find(taken->fluid) == fluids_.end()) return;
    (void)world_.change_fluid(taken->fluid, taken->ids, [](std::uint32_t, Vec3&, Vec3&) { return false; }).ok();
}

// Finds the particles of all shares of a fluid in one pass over its particles.
void Liquids::locate(Shared& shared) {
    const FluidParticles particles = world_.fluid_particles(shared.fluid);
    if (shared.version == particles.version) return;
    constexpr std::uint32_t none = ~std::uint32_t{0};
    for (const auto& share : shared.shares) share->places.assign(share->ids.last - share->ids.first, none);
    for (std::size_t i = 0; i < particles.ids.size(); ++i) {
        const std::uint32_t id = particles.ids[i];
        const auto above = std::ranges::upper_bound(shared.shares, id, {}, [](const auto& s) { return s->ids.first; });
        Share& share = **(above - 1);
        share.places[id - share.ids.first] = static_cast<std::uint32_t>(i);
    }
    for (const auto& share : shared.shares) std::erase(share->places, none);
    shared.version = particles.version;
}

const std::vector<std::uint32_t>& Liquids::particles_of(const Share& share) {
    locate(*find(share.fluid));
    return share.places;
}

Bounds Liquids::bounds_of(const Share& share) {
    const FluidParticles particles = world_.fluid_particles(share.fluid);
    Bounds bounds;
    for (const std::uint32_t i : particles_of(share)) bounds.add(particles.origin + to_vec3(particles.positions[i]));
    return bounds;
}

// Moves the particles to another fluid, or to a new one.
Result<void> Liquids::hand_over(Share& share, FluidHandle to) {
    const Result<physics::FluidPart> part = world_.move_between_fluids(share.fluid, share.ids, to);
    if (!part.ok()) return part.error();
    std::unique_ptr<Share> taken = take(share);
    taken->fluid = part.value().fluid;
    taken->ids = part.value().ids;
    put(std::move(taken));
    return {};
}

Result<void> Liquids::set_matter(Share& share, const FluidDefinition& matter) {
    // The other shares of its fluid stay unchanged.
    if (find(share.fluid)->shares.size() > 1) {
        if (Result<void> alone = hand_over(share, {}); !alone.ok()) return alone;
    }
    FluidDefinition changed = *world_.fluid(share.fluid);
    changed.density = matter.density;
    changed.viscosity = matter.viscosity;
    changed.yield_stress = matter.yield_stress;
    changed.surface_tension = matter.surface_tension;
    changed.allow_sleep = matter.allow_sleep;
    if (Result<void> set = world_.set_fluid(share.fluid, changed); !set.ok()) return set;
    return regroup(share);
}

Result<void> Liquids::regroup(Share& share) {
    const FluidParticles particles = world_.fluid_particles(share.fluid);
    if (particles.is_frozen || particles_of(share).empty()) return {};
    const bool is_alone = find(share.fluid)->shares.size() == 1;
    if (!is_alone && cells_of(particles.bounds, particles.cell_size) < most_cells) return {};
    const Shared* other = to_join(*world_.fluid(share.fluid), bounds_of(share), 1, share.fluid);
    if (is_alone && !other) return {};
    return hand_over(share, other ? other->fluid : FluidHandle{});
}

void Liquids::push(double dt) {
    for (const Shared& shared : fluids_) {
        const FluidDefinition& matter = *world_.fluid(shared.fluid);
        const double particle = matter.density * matter.cell_size * matter.cell_size * matter.cell_size / 8;
        for (const auto& share : shared.shares) {
            const std::size_t count = share->force == Vec3{} ? 0 : particles_of(*share).size();
            if (count == 0 || world_.fluid_particles(shared.fluid).is_frozen) continue;
            const Vec3 change = dt / (particle * static_cast<double>(count)) * share->force;
            // The fluid is in the world, so that the world does not refuse.
            (void)world_
                .change_fluid(shared.fluid, share->ids,
                              [change](std::uint32_t, Vec3&, Vec3& velocity) {
                                  velocity += change;
                                  return true;
                              })
                .ok();
        }
    }
}

void Liquids::part_far_ones() {
    std::vector<Share*> far;
    for (Shared& shared : fluids_) {
        const FluidParticles particles = world_.fluid_particles(shared.fluid);
        if (shared.shares.size() < 2 || particles.is_asleep || particles.is_frozen) continue;
        const double all = cells_of(particles.bounds, particles.cell_size);
        if (all < most_cells) continue;
        for (const auto& share : shared.shares) {
            Bounds others;
            for (const auto& other : shared.shares) {
                if (other != share) others.add(bounds_of(*other));
            }
            const double apart =
                cells_of(bounds_of(*share), particles.cell_size) + cells_of(others, particles.cell_size);
            if (apart > all / 2) continue;
            far.push_back(share.get());
            break;
        }
    }
    // The fluid is in the world and not frozen, so that the world does not refuse.
    for (Share* share : far) (void)hand_over(*share, {}).ok();
}

std::vector<Liquids::Shared>::iterator Liquids::find(FluidHandle fluid) {
    return std::ranges::find_if(fluids_, [fluid](const Shared& shared) { return shared.fluid == fluid; });
}

}  // namespace embody::scene
