// SPDX-License-Identifier: MIT
// Sources and drains of liquid (docs/physics/fluids.md, "Sources and drains").
#include "physics/stages/fluid/fluid_ports.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "physics/definitions/step_report.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/fluid/fluids.h"
#include "physics/state/fluid_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

/// The frame that a port stands in: where it is and how that moves. None where its body is no more, or is disabled.
struct PortFrame {
    Transform pose;
    Vec3 center, linear_velocity, angular_velocity;

    [[nodiscard]] Vec3 velocity_at(Vec3 p) const { return linear_velocity + cross(angular_velocity, p - center); }
};

std::optional<PortFrame> frame_of(const FluidAccess& world, BodyHandle body) {
    if (body.is_null()) return PortFrame{};
    if (!world.rigid.bodies.contains(body) || !world.rigid.record(body.index).definition.enabled) return std::nullopt;
    const BodyState& state = world.rigid.motion[body.index];
    return PortFrame{world.rigid.pose(body.index), state.center, state.linear_velocity, state.angular_velocity};
}

void wake(const FluidAccess& world, FluidRecord& fluid) {
    read_particles(fluid, world.workers);
    fluid.is_asleep = false;
    fluid.quiet_time = 0;
}

void take(const FluidAccess& world, FluidPortRecord& record, const FluidDrain& drain) {
    const std::optional<PortFrame> frame = drain.is_open ? frame_of(world, drain.body) : std::nullopt;
    if (!frame) return;
    const Vec3 center = transform_point(frame->pose, drain.position);
    const Bounds ball = enlarged(Bounds{center, center}, drain.radius);
    for (std::uint32_t slot = 0; slot < world.fluids.records.slot_count(); ++slot) {
        if (!world.fluids.records.used(slot)) continue;
        FluidRecord& fluid = world.fluids.records.at(slot);
        if (fluid.is_frozen || fluid.positions.empty() || !overlaps(fluid.bounds, ball)) continue;
        const std::size_t taken = fluid.solver->take_within(center, drain.radius);
        if (taken == 0) continue;
        record.passed += taken;
        wake(world, fluid);
    }
}

// The next place in the unit disc: even whatever the number of them (M. Roberts, "The unreasonable effectiveness of
// quasirandom sequences", 2018, R2), of the square around it those that lie in the disc.
Vec3 next_in_disc(std::uint64_t& index, Vec3 across, Vec3 aside) {
    constexpr double plastic = 1.32471795724474602596;  // root of x³ = x + 1
    for (;;) {
        const auto number = static_cast<double>(++index);
        const double x = number / plastic, y = number / (plastic * plastic);
        const double u = 2 * (x - std::floor(x)) - 1, v = 2 * (y - std::floor(y)) - 1;
        if (u * u + v * v <= 1) return across * u + aside * v;
    }
}

// None where the source has no ids of its own.
std::optional<std::uint32_t> next_kept_id(const FluidRecord& fluid, const FluidSource& source) {
    if (source.ids.first == source.ids.last) return std::nullopt;
    const auto used = fluid.next_kept_ids.find(source.ids.first);
    return used == fluid.next_kept_ids.end() ? source.ids.first : used->second;
}

void pour(const FluidAccess& world, FluidPortRecord& record, const FluidSource& source) {
    record.waits = false;
    FluidRecord* fluid = world.fluids.records.find(source.fluid);
    const std::optional<PortFrame> frame = source.is_open ? frame_of(world, source.body) : std::nullopt;
    if (!frame || fluid == nullptr || fluid->is_frozen || source.rate == 0) return;
    const double dt = world.settings.time_step, volume = fluid->solver->properties().particle_volume;
    record.owed += source.rate * dt;
    const Vec3 flow = normalized(rotate(frame->pose.rotation, source.direction));
    const Vec3 across = any_perpendicular(flow), aside = cross(flow, across);
    const Vec3 middle = transform_point(frame->pose, source.position);
    const double area = std::numbers::pi * source.radius * source.radius;
    const double speed = source.speed > 0 ? source.speed : source.rate / area;
    std::vector<FluidParticle> poured;
    const std::optional<std::uint32_t> first = next_kept_id(*fluid, source);
    const std::size_t ids_left = first ? std::max(source.ids.last, *first) - *first : max_fluid_particles;
    for (; record.owed >= volume; record.owed -= volume) {
        if (fluid->positions.size() + poured.size() >= source.max_particles || poured.size() >= ids_left) {
            // What waits does not come at once when there is room again.
            record.owed = std::fmod(record.owed, volume);
            record.waits = true;
            world.report.limits |= static_cast<std::uint32_t>(StepLimit::fluid_source_waits);
            break;
        }
        // It left the disc when that was owed, in the step that has passed.
        const double since = std::min(dt, (record.owed - volume) / source.rate);
        const Vec3 place = middle + source.radius * next_in_disc(record.index, across, aside);
        const Vec3 velocity = frame->velocity_at(place) + flow * speed;
        const Vec3 at = place + flow * (speed * since) - fluid->solver->origin();
        FluidParticle particle;
        for (int axis = 0; axis < 3; ++axis) {
            particle.position[axis] = static_cast<float>(at[axis]);
            particle.velocity[axis] = static_cast<float>(velocity[axis]);
        }
        poured.push_back(particle);
    }
    if (poured.empty()) return;
    record.passed += poured.size();
    const FluidIds ids = fluid->solver->add_particles(std::move(poured), fluid->solver->origin(), first);
    if (first) fluid->next_kept_ids[source.ids.first] = ids.last;
    if (source.matter)
        fluid->solver->set_matter(ids, {.density = source.matter->density,
                                        .viscosity = source.matter->viscosity,
                                        .yield_stress = source.matter->yield_stress,
                                        .surface_tension = source.matter->surface_tension});
    wake(world, *fluid);
}

}  // namespace

void run_fluid_ports(const FluidAccess& world) {
    auto& ports = world.fluids.ports;
    for (std::uint32_t slot = 0; slot < ports.slot_count(); ++slot) {
        if (!ports.used(slot)) continue;
        if (const auto* drain = std::get_if<FluidDrain>(&ports.at(slot).port)) take(world, ports.at(slot), *drain);
    }
    for (std::uint32_t slot = 0; slot < ports.slot_count(); ++slot) {
        if (!ports.used(slot)) continue;
        if (const auto* source = std::get_if<FluidSource>(&ports.at(slot).port)) pour(world, ports.at(slot), *source);
    }
}

}  // namespace embody::physics::stages
