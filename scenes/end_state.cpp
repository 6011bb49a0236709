// SPDX-License-Identifier: MIT
#include "scenes/end_state.h"

#include <algorithm>
#include <cmath>

namespace embody::scenes {
namespace {

template <class Visit>
void for_each_movable(const scene::Simulation& simulation, const Visit& visit) {
    for (const scene::EntityIndex entity : simulation.entities()) {
        const physics::BodyHandle body = simulation.body(entity);
        if (std::isfinite(simulation.world().mass(body))) visit(entity, body);
    }
}

}  // namespace

std::string check_all_within(const scene::Simulation& simulation, double floor, double reach) {
    std::string wrong;
    for_each_movable(simulation, [&](scene::EntityIndex entity, physics::BodyHandle body) {
        const Vec3 center = simulation.world().center_of_mass(body);
        const double distance = std::hypot(center.x, center.z);
        if (wrong.empty() && !(is_finite(center) && center.y > floor && distance < reach))
            wrong = "entity " + std::to_string(entity) + " is at height " + std::to_string(center.y) + " m, " +
                    std::to_string(distance) + " m from the axis";
    });
    return wrong;
}

int count_above(const scene::Simulation& simulation, double height) {
    int count = 0;
    for_each_movable(simulation, [&](scene::EntityIndex, physics::BodyHandle body) {
        count += simulation.world().center_of_mass(body).y >= height;
    });
    return count;
}

int count_out_of_plane(const scene::Simulation& simulation, double distance) {
    int count = 0;
    for_each_movable(simulation, [&](scene::EntityIndex, physics::BodyHandle body) {
        count += std::fabs(simulation.world().center_of_mass(body).z) > distance;
    });
    return count;
}

double greatest_speed(const scene::Simulation& simulation) {
    double greatest = 0;
    for_each_movable(simulation, [&](scene::EntityIndex, physics::BodyHandle body) {
        greatest = std::max(greatest, length(simulation.world().linear_velocity(body)));
    });
    return greatest;
}

}  // namespace embody::scenes
