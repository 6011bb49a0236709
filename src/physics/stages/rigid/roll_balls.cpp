// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/roll_balls.h"

#include <algorithm>
#include <cmath>

#include "physics/stages/rigid/ball_path.h"
#include "physics/stages/rigid/roll.h"
#include "physics/state/share_awake.h"

namespace embody::physics::stages {

namespace {

bool is_still(const BodyState& state) {
    return state.inverse_mass == 0 && state.linear_velocity == Vec3{} && state.angular_velocity == Vec3{};
}

bool may_roll(const WorldState& world, std::uint32_t body) {
    const TouchBody& touch = world.touch_memory.bodies[body];
    if (!touch.is_ball || !touch.yields) return false;
    const BodyConstants& constants = world.constants[body];
    return constants.is_isotropic && constants.torque == Vec3{} && constants.linear_damping == 0 &&
           constants.angular_damping == 0;
}

void list_candidates(const WorldState& world, BallMemory& memory) {
    memory.count = 0;
    for (const std::uint32_t body : world.awake) {
        if (!may_roll(world, body)) continue;
        if (memory.count == 0) memory.of_body.assign(world.motion.size(), 0);
        if (memory.count == memory.candidates.size()) memory.candidates.emplace_back();
        BallMemory::Candidate& candidate = memory.candidates[memory.count++];
        candidate.body = body;
        candidate.is_alone = true;
        candidate.has_rolled = false;
        candidate.contacts.clear();
        memory.of_body[body] = static_cast<std::uint32_t>(memory.count);
    }
}

void give_contacts(const WorldState& world, BallMemory& memory) {
    const auto give = [&](std::uint32_t body, std::uint32_t other, std::uint32_t contact) {
        if (memory.of_body[body] == 0) return;
        BallMemory::Candidate& candidate = memory.candidates[memory.of_body[body] - 1];
        candidate.is_alone = candidate.is_alone && is_still(world.motion[other]);
        if (candidate.is_alone) candidate.contacts.push_back(contact);
    };
    for (std::uint32_t i = 0; i < world.contact_glances.size(); ++i) {
        const ContactGlance& glance = world.contact_glances[i];
        give(glance.a, glance.b, i);
        give(glance.b, glance.a, i);
    }
    const auto leave_out = [&](std::uint32_t body) {
        if (memory.of_body[body] > 0) memory.candidates[memory.of_body[body] - 1].is_alone = false;
    };
    for (std::uint32_t slot = 0; slot < world.joints.slot_count(); ++slot) {
        if (!world.joints.used(slot)) continue;
        const JointDefinition& joint = world.joints.at(slot).definition;
        leave_out(joint.body_b.index);
        if (!joint.body_a.is_null()) leave_out(joint.body_a.index);
    }
}

}  // namespace

void roll_balls(WorldState& world) {
    BallMemory& memory = world.ball_memory;
    memory.rolled.clear();
    list_candidates(world, memory);
    if (memory.count == 0) return;
    give_contacts(world, memory);
    constexpr std::size_t fewest_shared = 64;
    memory.surroundings.resize(static_cast<std::size_t>(world.workers->workers()));
    share_among(*world.workers, memory.count, memory.count >= fewest_shared, [&](int worker, Share share) {
        BallMemory::Surroundings& own = memory.surroundings[static_cast<std::size_t>(worker)];
        for (std::size_t i = share.first; i < share.last; ++i) {
            BallMemory::Candidate& candidate = memory.candidates[i];
            if (!candidate.is_alone || candidate.contacts.empty()) continue;
            candidate.has_rolled = roll_ball(world, candidate.body, candidate.contacts, own, candidate.rolled);
        }
    });
    for (std::size_t i = 0; i < memory.count; ++i) {
        const BallMemory::Candidate& candidate = memory.candidates[i];
        if (!candidate.has_rolled) continue;
        memory.rolled.push_back(candidate.rolled);

        // What touches already and does not bounce is no impact.
        for (const std::uint32_t contact : candidate.contacts) {
            world.contact_glances[contact].was_touching = true;
            world.contact_glances[contact].bounces = false;
        }
    }
}

bool take_rolled_ball(WorldState& world, const Island& island) {
    const std::vector<RolledBall>& list = world.ball_memory.rolled;
    if (list.empty() || island.body_count != 1 || island.joint_count > 0) return false;
    const std::uint32_t body = world.islands.bodies[island.first_body];
    const auto found = std::lower_bound(list.begin(), list.end(), body,
                                        [](const RolledBall& ball, std::uint32_t slot) { return ball.body < slot; });
    if (found == list.end() || found->body != body) return false;
    world.motion[body] = found->state;
    const auto contacts = std::span(world.islands.contacts).subspan(island.first_contact, island.contact_count);
    note_load(world, contacts, {found->contact, 0}, found->impulse);
    return true;
}

}  // namespace embody::physics::stages
