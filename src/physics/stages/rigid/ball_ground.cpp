// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/ball_ground.h"

#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/state/contact_state.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

BallPath path_of_ball(const RollAccess& world, std::uint32_t body, std::span<const std::uint32_t> contacts,
                      BallSurroundings& surroundings) {
    std::vector<BallSurroundings::Ground>& grounds = surroundings.grounds;
    grounds.clear();
    for (const std::uint32_t index : contacts) {
        const Contact& contact = world.contacts.list[index];
        const std::uint32_t other = contact.a == body ? contact.b : contact.a;
        if (!grounds.empty() && grounds.back().body == other) continue;
        grounds.push_back({other,
                           world.rigid.record(other).shape,
                           world.rigid.pose(other),
                           {contact.friction_static, contact.friction_dynamic, contact.friction_rolling,
                            contact.friction_torsional}});
    }
    const BallInStep ball{body,
                          world.rigid.motion[body],
                          world.rigid.constants[body],
                          *world.rigid.record(body).shape,
                          world.rigid.record(body).reach,
                          world.contacts.list,
                          contacts,
                          world.settings.time_step,
                          world.settings.substeps,
                          world.settings.solver.constraint.rolling};
    return {ball, surroundings};
}

}  // namespace embody::physics::stages
