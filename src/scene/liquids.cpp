// SPDX-License-Identifier: MIT
#include "scene/liquids.h"

#include <algorithm>

namespace embody::scene {

using physics::FluidDefinition;
using physics::FluidHandle;

namespace {

// The solver's grid spans all of its liquid: bodies so far apart that it would have more cells do not share one.
constexpr double most_cells = 200'000;

bool is_same_matter(const FluidDefinition& a, const FluidDefinition& b) {
    return a.density == b.density && a.viscosity == b.viscosity && a.yield_stress == b.yield_stress &&
           a.gravity_factor == b.gravity_factor && a.allow_sleep == b.allow_sleep;
}

Bounds bounds_of(const physics::FluidParticles& particles) {
    Bounds bounds;
    for (const Vec3f& p : particles.positions) bounds.add(particles.origin + to_vec3(p));
    return bounds;
}

double cells_of(const Bounds& bounds, double cell) {
    const Vec3 size = bounds.size() / cell;
    return (size.x + 1) * (size.y + 1) * (size.z + 1);
}

}  // namespace

const Liquids::Shared* Liquids::to_join(const FluidDefinition& matter, const Bounds& bounds) const {
    for (const Shared& shared : fluids_) {
        const FluidDefinition& other = *world_.fluid(shared.fluid);
        const double ratio = matter.cell_size / other.cell_size;
        const physics::FluidParticles particles = world_.fluid_particles(shared.fluid);
        if (!is_same_matter(matter, other) || ratio > most_ratio || ratio < 1 / most_ratio || particles.is_frozen)
            continue;
        Bounds both = bounds_of(particles);
        both.add(bounds);
        if (cells_of(both, other.cell_size) < most_cells) return &shared;
    }
    return nullptr;
}

double Liquids::cell_size(const FluidDefinition& matter, const Bounds& bounds) const {
    const Shared* shared = to_join(matter, bounds);
    return shared ? world_.fluid(shared->fluid)->cell_size : matter.cell_size;
}

Result<Liquids::Share> Liquids::add(const FluidDefinition& matter, std::span<const Vec3> places) {
    Bounds bounds;
    for (const Vec3 place : places) bounds.add(place);
    if (const Shared* shared = to_join(matter, bounds)) {
        const Result<physics::FluidIds> ids = world_.add_to_fluid(shared->fluid, places);
        if (!ids.ok()) return ids.error();
        ++find(shared->fluid)->users;
        return Share{shared->fluid, ids.value()};
    }
    FluidDefinition definition = matter;
    definition.points.assign(places.begin(), places.end());
    const Result<FluidHandle> fluid = world_.create_fluid(definition);
    if (!fluid.ok()) return fluid.error();
    fluids_.push_back({fluid.value(), 1});
    return Share{fluid.value(), {0, static_cast<std::uint32_t>(world_.fluid_particles(fluid.value()).ids.size())}};
}

// The fluid is in the world, which does not refuse.
void Liquids::remove(const Share& share) {
    const auto shared = find(share.fluid);
    if (--shared->users == 0) {
        (void)world_.destroy_fluid(share.fluid).ok();
        fluids_.erase(shared);
        return;
    }
    (void)world_.change_fluid(share.fluid, share.ids, [](std::uint32_t, Vec3&, Vec3&) { return false; }).ok();
}

bool Liquids::is_alone(const Share& share) const {
    return std::ranges::any_of(fluids_,
                               [&](const Shared& shared) { return shared.fluid == share.fluid && shared.users == 1; });
}

std::vector<Liquids::Shared>::iterator Liquids::find(FluidHandle fluid) {
    return std::ranges::find_if(fluids_, [fluid](const Shared& shared) { return shared.fluid == fluid; });
}

}  // namespace embody::scene
