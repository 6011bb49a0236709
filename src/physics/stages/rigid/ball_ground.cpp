// SPDX-License-Identifier: MIT
#include "physics/stages/rigid/ball_ground.h"

namespace embody::physics::stages {

BallPath path_of_ball(const WorldState& world, std::uint32_t body, std::span<const std::uint32_t> contacts,
                      BallSurroundings& surroundings) {
    std::vector<BallSurroundings::Ground>& grounds = surroundings.grounds;
    grounds.clear();
    for (const std::uint32_t index : contacts) {
        const Contact& contact = world.contacts[index];
        const std::uint32_t other = contact.a == body ? contact.b : contact.a;
        if (!grounds.empty() && grounds.back().body == other) continue;
        grounds.push_back({other,
                           world.record(other).shape,
                           world.pose(other),
                           {contact.friction_static, contact.friction_dynamic, contact.friction_rolling,
                            contact.friction_torsional}});
    }
    const BallInStep ball{body,
                          world.motion[body],
                          world.constants[body],
                          *world.record(body).shape,
                          world.record(body).reach,
                          world.contacts,
                          contacts,
                          world.settings.time_step,
                          world.settings.substeps};
    return {ball, surroundings};
}

}  // namespace embody::physics::stages
