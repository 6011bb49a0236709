// SPDX-License-Identifier: MIT
// What a liquid gains while it runs: things that melt (docs/physics/melting.md).
#include <cmath>
#include <string>

#include "scene/matter/fluid_body.h"

namespace embody::scene {

using physics::FluidDrop;

namespace {

Error too_small() {
    return {"attributes.fluid_cell_size", "is too large for so small a thing: its drops would lie on a line",
            "make the liquid's cells smaller, or the thing thicker"};
}

Result<void> check_drops(std::span<const FluidDrop> drops, double particle_mass) {
    if (drops.empty()) return too_small();
    std::vector<Vec3> places;
    for (const FluidDrop& drop : drops) places.push_back(drop.position);
    return can_turn(moments_of(places, particle_mass)) ? Result<void>{} : too_small();
}

std::vector<Vec3> velocities_of(std::span<const FluidDrop> drops) {
    std::vector<Vec3> velocities;
    for (const FluidDrop& drop : drops) velocities.push_back(drop.velocity);
    return velocities;
}

}  // namespace

Result<void> FluidBody::gain(const Momenta& momenta,
                             const std::function<Result<std::vector<FluidDrop>>(std::size_t)>& make_drops) {
    const double count = std::round((momenta.mass - ahead_) / particle_mass());
    if (count + static_cast<double>(this->count()) > static_cast<double>(particle_budget_ * max_particles_ratio))
        return Error{"attributes.particle_budget",
                     "is too small: with what melts into it it would have " +
                         std::to_string(std::llround(count) + static_cast<long long>(this->count())) + " drops",
                     "raise it"};
    if (count < 1) return too_small();
    const Result<std::vector<FluidDrop>> drops = make_drops(static_cast<std::size_t>(count));
    if (!drops.ok()) return drops.error();
    if (Result<void> checked = check_drops(drops.value(), particle_mass()); !checked.ok()) return checked;
    if (Result<void> added = liquids_.append(*part_, drops.value()); !added.ok()) return added;
    ahead_ += count * particle_mass() - momenta.mass;
    return set_last_velocities(velocities_of(drops.value()), momenta);
}

Result<void> FluidBody::begin_with(std::span<const FluidDrop> drops, const Momenta& momenta) {
    if (Result<void> checked = check_drops(drops, particle_mass()); !checked.ok()) return checked;
    return set_last_velocities(velocities_of(drops), momenta);
}

Result<void> FluidBody::set_last_velocities(const std::vector<Vec3>& velocities, const Momenta& momenta) {
    // The places as the fluid has them, in single precision.
    std::vector<Vec3> places;
    read(places);
    places.erase(places.begin(), places.end() - static_cast<std::ptrdiff_t>(velocities.size()));
    const std::vector<Vec3> exact = with_momenta(places, velocities, particle_mass(), momenta);
    const auto first = part_->ids.last - static_cast<std::uint32_t>(exact.size());
    return world_.change_fluid(part_->fluid, {first, part_->ids.last}, [&](std::uint32_t id, Vec3&, Vec3& velocity) {
        velocity = exact[id - first];
        return true;
    });
}

}  // namespace embody::scene
