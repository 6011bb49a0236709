// SPDX-License-Identifier: MIT
#include "scene/matter/fluid_body.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "scene/embody/filled_region.h"
#include "scene/matter/fluid_filling.h"

namespace embody::scene {

using physics::FluidDrop;
using physics::FluidParticles;
using physics::SleepState;

Result<std::unique_ptr<FluidBody>> FluidBody::create(physics::World& world, Liquids& liquids,
                                                     const LiquidDefinition& definition) {
    std::unique_ptr<FluidBody> made(new FluidBody(world, liquids));
    made->matter_ = definition.matter;
    made->force_ = definition.force;
    made->set_cell_size_ = definition.set_cell_size;
    made->has_run_ = !definition.places.empty();
    made->particle_budget_ = definition.particle_budget;
    Result<std::vector<Vec3>> places =
        definition.places.empty() ? made->fill(definition) : Result<std::vector<Vec3>>(definition.places);
    if (!places.ok()) return places.error();

    Bounds bounds;
    for (Vec3& place : places.value()) {
        place = transform_point(definition.pose, place);
        bounds.add(place);
    }
    made->room_ = bounds;
    std::vector<FluidDrop> particles;
    if (definition.starts_empty) places.value().clear();
    particles.reserve(places.value().size());
    for (const Vec3 position : places.value())
        particles.push_back(
            {position, definition.linear_velocity + cross(definition.angular_velocity, position - bounds.center())});
    made->kept_ = std::move(particles);
    if (!definition.enabled) return made;
    if (Result<void> put = made->set_enabled(true); !put.ok()) return put.error();
    return made;
}

Result<std::vector<Vec3>> FluidBody::fill(const LiquidDefinition& definition) {
    const Result<FilledRegion> region = FilledRegion::of(definition.shape);
    if (!region.ok()) return region.error();
    Result<FluidFilling> filling = fill_with_fluid(definition.shape, matter_.cell_size, definition.particle_budget);
    if (!filling.ok()) return filling.error();
    // Particles that join a fluid have the volume of that fluid's particles, whatever their number.
    matter_.cell_size = filling.value().cell_size;
    const double cell =
        liquids_.cell_size(matter_, definition.set_cell_size, transformed(definition.pose, region.value().bounds()));
    bool is_own = cell == matter_.cell_size;
    if (!is_own) {
        const std::size_t max_distance = definition.particle_budget * max_particles_ratio;
        Result<FluidFilling> joined = fill_with_fluid(definition.shape, cell, max_distance);
        // A liquid thinner than the other's particles would get more volume from them: it gets its own fluid.
        is_own = !joined.ok() || std::fabs(std::log(joined.value().cell_size / cell)) > std::log(max_cell_ratio);
        if (!is_own) filling = std::move(joined);
    }
    join_ = cell == matter_.cell_size ? Join::none_other : is_own ? Join::apart : Join::joined;
    // The cells of a new fluid are chosen so that the particles have the liquid's volume.
    constexpr double max_cell_size = 1;  // m, limit of the physics
    if (filling.value().cell_size > max_cell_size)
        return Error{"attributes.particle_budget",
                     "is too small for so much liquid: its cells would be " +
                         std::to_string(static_cast<int>(std::ceil(filling.value().cell_size))) +
                         " m wide, more than 1 m",
                     "raise it, or fill a smaller shape"};
    matter_.cell_size = is_own ? std::max(filling.value().cell_size, 1e-3) : cell;
    return std::move(filling.value().places);
}

FluidBody::~FluidBody() {
    if (part_) liquids_.remove(part_);
}

Result<void> FluidBody::put(const std::vector<FluidDrop>& particles) {
    std::vector<Vec3> places;
    places.reserve(particles.size());
    for (const FluidDrop& particle : particles) places.push_back(particle.position);
    const Result<Liquids::Part*> part = places.empty() ? liquids_.add_empty(matter_, room_)
                                        : has_run_     ? liquids_.add_drops(matter_, particles)
                                                       : liquids_.add(matter_, places);
    if (!part.ok())
        return Error{"shape", "holds no liquid: " + part.error().why,
                     "place it outside of solid things, or make it larger"};
    part_ = part.value();
    part_->force = force_;
    part_->set_cell_size = set_cell_size_;
    const auto is_at_rest = [](const FluidDrop& particle) { return particle.velocity == Vec3{}; };
    if (has_run_ || std::ranges::all_of(particles, is_at_rest)) return {};

    // Particles in solids were left out, so that ids are no indices into `particles`, but the order is the same.
    std::size_t at = 0;
    return world_.change_fluid(part_->fluid, part_->ids, [&](std::uint32_t, Vec3& position, Vec3& velocity) {
        constexpr double same_place = 1e-4;
        while (at < particles.size() && length(particles[at].position - position) > same_place) ++at;
        if (at < particles.size()) velocity = particles[at++].velocity;
        return true;
    });
}

Result<void> FluidBody::set_definition(const PointsDefinition& definition) {
    const auto& liquid = std::get<LiquidDefinition>(definition);
    const double cell_size = matter_.cell_size;
    matter_ = liquid.matter;
    force_ = liquid.force;
    matter_.cell_size = cell_size;
    if (part_) {
        part_->force = force_;
        if (Result<void> set = liquids_.set_matter(*part_, matter_); !set.ok()) return set;
    }
    return set_enabled(liquid.enabled);
}

std::vector<FluidDrop> FluidBody::particles() const {
    if (!part_) return kept_;
    const FluidParticles all = world_.fluid_particles(part_->fluid);
    std::vector<FluidDrop> own;
    own.reserve(count());
    for (const std::uint32_t i : liquids_.particles_of(*part_))
        own.push_back({all.origin + to_vec3(all.positions[i]), to_vec3(all.velocities[i])});
    return own;
}

std::size_t FluidBody::count() const { return part_ ? liquids_.particles_of(*part_).size() : kept_.size(); }

void FluidBody::read(std::vector<Vec3>& positions) const {
    positions.clear();
    for (const FluidDrop& particle : particles()) positions.push_back(particle.position);
}

void FluidBody::read_velocities(std::vector<Vec3>& velocities) const {
    velocities.clear();
    for (const FluidDrop& particle : particles()) velocities.push_back(particle.velocity);
}

// From what has come and what is there follows what has gone.
std::uint64_t FluidBody::membership() const {
    return (part_ ? part_->poured : 0) * (physics::max_fluid_particles + 1) + count();
}

std::size_t FluidBody::max_drops() const {
    return particle_budget_ * (join_ == Join::joined ? max_particles_ratio : 1);
}

double FluidBody::particle_mass() const {
    const double cell = matter_.cell_size;
    return matter_.density * cell * cell * cell / 8;
}

double FluidBody::radius() const { return std::cbrt(3 * particle_mass() / (4 * std::numbers::pi * matter_.density)); }

SleepState FluidBody::state() const {
    if (!part_) return SleepState::asleep;
    const FluidParticles all = world_.fluid_particles(part_->fluid);
    return all.is_asleep || all.is_frozen ? SleepState::asleep : SleepState::active;
}

Vec3 FluidBody::center_of_mass() const {
    const std::vector<FluidDrop> own = particles();
    Vec3 sum;
    for (const FluidDrop& particle : own) sum += particle.position;
    return own.empty() ? Vec3{} : sum / static_cast<double>(own.size());
}

Vec3 FluidBody::linear_velocity() const {
    const std::vector<FluidDrop> own = particles();
    Vec3 sum;
    for (const FluidDrop& particle : own) sum += particle.velocity;
    return own.empty() ? Vec3{} : sum / static_cast<double>(own.size());
}

double FluidBody::mass() const { return particle_mass() * static_cast<double>(count()); }

Bounds FluidBody::bounds() const {
    Bounds bounds;
    for (const FluidDrop& particle : particles()) bounds.add(particle.position);
    return bounds.is_empty() ? room_ : enlarged(bounds, radius());
}

// Casts a ray down from the lowest particle of each column of cells.
std::optional<double> FluidBody::drop_distance(double max_distance) const {
    std::map<std::pair<int, int>, Vec3> lowest;
    for (const FluidDrop& particle : particles()) {
        const Vec3 p = particle.position;
        const std::pair column{static_cast<int>(std::floor(p.x / matter_.cell_size)),
                               static_cast<int>(std::floor(p.z / matter_.cell_size))};
        const auto [found, is_new] = lowest.try_emplace(column, p);
        if (!is_new && p.y < found->second.y) found->second = p;
    }
    const double clearance = radius();
    std::optional<double> min_distance;
    for (const auto& [column, place] : lowest) {
        const auto hit = world_.cast_ray(place, {0, -1, 0}, max_distance + clearance);
        if (hit && (!min_distance || hit->distance < *min_distance)) min_distance = hit->distance;
    }
    if (min_distance) *min_distance = std::max(0.0, *min_distance - clearance);
    return min_distance;
}

// First hit with balls so large that neighbours at rest overlap.
std::optional<SurfaceHit> FluidBody::cast_ray(Vec3 origin, Vec3 direction, double max_distance) const {
    const double reach = 1.5 * radius();
    const Bounds box = bounds();
    if (box.is_empty()) return {};
    std::optional<SurfaceHit> nearest;
    for (const FluidDrop& particle : particles()) {
        const Vec3 to = particle.position - origin;
        const double along = dot(to, direction), off = length_squared(to) - along * along;
        if (off > reach * reach) continue;
        const double distance = along - std::sqrt(reach * reach - off);
        if (distance < 0 || distance > max_distance || (nearest && distance >= nearest->distance)) continue;
        nearest = SurfaceHit{distance, normalized(distance * direction - to)};
    }
    return nearest;
}

Result<void> FluidBody::move(const Transform& motion) {
    for (FluidDrop& particle : kept_) particle = {transform_point(motion, particle.position), {}};
    room_ = transformed(motion, room_);
    if (!part_) return {};
    if (count() == 0) {
        // Nothing is there to be moved: it begins anew there.
        liquids_.remove(std::exchange(part_, nullptr));
        return put({});
    }
    Result<void> moved =
        world_.change_fluid(part_->fluid, part_->ids, [&](std::uint32_t, Vec3& position, Vec3& velocity) {
            position = transform_point(motion, position);
            velocity = {};
            return true;
        });
    if (!moved.ok()) return moved;
    return liquids_.regroup(*part_);
}

Result<void> FluidBody::set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) {
    if (!part_) return Error{"positions", "cannot be set while the liquid is disabled"};
    if (velocities.size() != positions.size()) return Error{"velocities", "must be as many as positions"};
    std::vector<FluidDrop> drops;
    drops.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) drops.push_back({positions[i], velocities[i]});
    if (Result<void> set = liquids_.set_drops(*part_, drops); !set.ok()) return set;
    return liquids_.regroup(*part_);
}

Result<void> FluidBody::set_velocity(Vec3 linear, Vec3 angular) {
    const Vec3 center = center_of_mass();
    for (FluidDrop& particle : kept_) particle.velocity = linear + cross(angular, particle.position - center);
    if (!part_) return {};
    return world_.change_fluid(part_->fluid, part_->ids, [&](std::uint32_t, Vec3& position, Vec3& velocity) {
        velocity = linear + cross(angular, position - center);
        return true;
    });
}

Result<void> FluidBody::apply_impulse(Vec3 impulse) {
    if (!part_ || count() == 0) return {};
    const Vec3 change = impulse / mass();
    return world_.change_fluid(part_->fluid, part_->ids, [&](std::uint32_t, Vec3&, Vec3& velocity) {
        velocity += change;
        return true;
    });
}

Result<void> FluidBody::apply_force(Vec3 force) { return apply_impulse(world_.settings().time_step * force); }

Result<void> FluidBody::set_enabled(bool enabled) {
    if (enabled == (part_ != nullptr)) return {};
    if (enabled) {
        if (Result<void> in = put(kept_); !in.ok()) return in;
        kept_.clear();
        return {};
    }
    kept_ = particles();
    has_run_ = true;
    liquids_.remove(std::exchange(part_, nullptr));
    return {};
}

}  // namespace embody::scene
