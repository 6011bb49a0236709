// SPDX-License-Identifier: MIT
#include "world_promises.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "../target.h"
#include "foundation/state_hash.h"
#include "physics/state/validate.h"
#include "physics/state/world_state.h"

namespace embody::physics {

// World::state_ is private. An explicit instantiation may name private members, and passes this one on by a friend.
const state::WorldState& state_of(const World& world);
template <std::unique_ptr<state::WorldState> World::*member>
struct OpenedWorld {
    friend const state::WorldState& state_of(const World& world) { return *(world.*member); }
};
template struct OpenedWorld<&World::state_>;

}  // namespace embody::physics

namespace embody::fuzz {

using namespace physics;

namespace {

void require_finite(Vec3 value, const char* promise) { require(is_finite(value), promise); }

void require_sound_bodies(const World& world) {
    constexpr double tolerance = 1e-6;
    for (const BodyHandle body : world.bodies()) {
        const Transform pose = world.pose(body);
        require(is_finite(pose), "poses are finite");
        require(std::fabs(dot(pose.rotation, pose.rotation) - 1) < tolerance, "rotations have length one");
        require_finite(world.linear_velocity(body), "velocities are finite");
        require_finite(world.angular_velocity(body), "angular velocities are finite");
        require(world.mass(body) > 0, "masses are above zero");
        const FluidForce force = world.fluid_force(body);
        require(is_finite(force.force) && is_finite(force.torque), "forces of fluids are finite");
        require(world.body(body).has_value(), "a body has a definition");
    }
    for (const JointHandle joint : world.joints()) {
        const std::optional<JointDefinition> definition = world.joint(joint);
        require(definition && world.contains(definition->body_b), "a joint holds a body");
        require(std::isfinite(world.joint_coordinate(joint)), "coordinates of joints are finite");
        // The reaction of a joint at a disabled body stays what it was, which may be infinite.
        const bool is_solved = world.body(definition->body_b)->enabled &&
                               (definition->body_a.is_null() ||
                                (world.contains(definition->body_a) && world.body(definition->body_a)->enabled));
        const World::JointReaction reaction = world.joint_reaction(joint);
        require(!is_solved || (is_finite(reaction.force) && is_finite(reaction.torque)), "reactions are finite");
    }
}

void require_sound_matter(const World& world) {
    for (const DeformableHandle deformable : world.deformables()) {
        const auto positions = world.node_positions(deformable), velocities = world.node_velocities(deformable);
        require(positions.size() == world.deformable(deformable)->nodes.size(), "nodes stay as many as they are");
        require(std::ranges::all_of(positions, [](Vec3 v) { return is_finite(v); }), "nodes are at finite places");
        require(std::ranges::all_of(velocities, [](Vec3 v) { return is_finite(v); }), "nodes have finite velocities");
        require(world.mass(deformable) > 0, "deformables have mass");
        require(world.broken_segments(deformable).size() <= world.rope_tensions(deformable).size(),
                "what is broken is a segment");
    }
    for (const FluidHandle fluid : world.fluids()) {
        const FluidParticles particles = world.fluid_particles(fluid);
        require(particles.positions.size() == particles.velocities.size() &&
                    particles.positions.size() == particles.ids.size(),
                "a particle has place, velocity and id");
        require(particles.particle_volume > 0, "particles have volume");
        for (const Vec3 place : particles.positions) require_finite(place, "particles are at finite places");
        for (const Vec3 velocity : particles.velocities) require_finite(velocity, "particles have finite velocities");
    }
}

void require_sound_report(const World& world) {
    const StepReport& report = world.last_report();
    require(report.bodies_active + report.bodies_wanting_to_sleep + report.bodies_asleep <= world.bodies().size(),
            "the report counts bodies once");
    for (const ContactView& contact : world.contacts()) {
        require(world.contains(contact.a) && world.contains(contact.b), "contacts are of bodies");
        require(is_finite(contact.position) && is_finite(contact.impulse) && std::isfinite(contact.separation),
                "contacts are finite");
        constexpr double tolerance = 1e-4;  // of normals, which are stored as floats
        require(std::fabs(length(contact.normal) - 1) < tolerance, "normals have length one");
    }
    for (const ContactEvent& event : world.contact_events()) {
        if (event.kind == ContactEvent::Kind::begin)
            require(world.contains(event.a) && world.contains(event.b), "what begins to touch is there");
    }
}

}  // namespace

std::uint64_t fingerprint(const World& world) {
    StateHash hash;
    hash.add(world.state_hash());
    for (const std::size_t count :
         {world.bodies().size(), world.joints().size(), world.deformables().size(), world.fluids().size()})
        hash.add(std::uint64_t{count});
    hash.add(world.settings().time_step);
    return hash.value();
}

void require_sound(const World& world) {
    const Result<void> valid = state::validate(state_of(world));
    if (!valid) std::fprintf(stderr, "%s\n", valid.error().message().c_str());
    require(valid.ok(), "the state is valid");
    require_sound_bodies(world);
    require_sound_matter(world);
    require_sound_report(world);
}

}  // namespace embody::fuzz
