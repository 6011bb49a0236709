// SPDX-License-Identifier: MIT
#include "physics/inter/debug_motion.h"

#include <algorithm>
#include <vector>

#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

constexpr double shown_time = 0.2;     // s: an arrow leads to where the centre would be then
constexpr double min_speed = 1e-3;     // m/s: slower motion has no arrow
constexpr double min_fraction = 1e-3;  // of the largest force: smaller ones have no arrow

struct DrawnForce {
    Vec3 at, force;
    std::uint16_t number;
};

}  // namespace

void draw_velocities(const WorldState& world, DebugCanvas& canvas) {
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.bodies.used(body)) continue;
        const BodyDefinition& definition = world.rigid.record(body).definition;
        const BodyState& motion = world.rigid.motion[body];
        if (definition.kind == BodyKind::static_body || !canvas.is_meant(definition.user_data)) continue;
        if (length(motion.linear_velocity) < min_speed) continue;
        canvas.arrow(motion.center, motion.center + shown_time * motion.linear_velocity,
                     {DebugMeaning::velocity, 0, world.activity.is_asleep(body)});
    }
}

void draw_forces(const WorldState& world, std::span<const ContactView> contacts, DebugCanvas& canvas) {
    std::vector<DrawnForce> forces;
    const auto is_meant = [&](std::uint32_t body) {
        return world.rigid.is_dynamic(body) && canvas.is_meant(world.rigid.record(body).definition.user_data);
    };
    for (std::uint32_t body = 0; body < world.rigid.bodies.slot_count(); ++body) {
        if (!world.rigid.bodies.used(body) || !is_meant(body)) continue;
        const BodyConstants& constants = world.rigid.constants[body];
        const Vec3 center = world.rigid.motion[body].center;
        const BodyDefinition& definition = world.rigid.record(body).definition;
        const Vec3 weight = constants.mass * definition.gravity_factor * world.settings.gravity;
        forces.push_back({center, weight, 0});
        forces.push_back({center, constants.mass * constants.acceleration - weight, 1});
    }
    // An impulse acts on b, and its opposite on a.
    for (const ContactView& contact : contacts) {
        const Vec3 force = contact.impulse / world.settings.time_step;
        if (is_meant(contact.b.index)) forces.push_back({contact.position, force, 2});
        if (is_meant(contact.a.index)) forces.push_back({contact.position, -force, 2});
    }
    double largest = 0;
    for (const DrawnForce& drawn : forces) largest = std::max(largest, length(drawn.force));
    for (const DrawnForce& drawn : forces) {
        if (!(length(drawn.force) > min_fraction * largest)) continue;
        canvas.arrow(drawn.at, drawn.at + canvas.options.longest_arrow / largest * drawn.force,
                     {DebugMeaning::force, drawn.number});
    }
}

}  // namespace embody::physics
