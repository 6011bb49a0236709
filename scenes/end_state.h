// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scene/simulation/simulation.h"

namespace embody::scenes {

/// Empty where every entity is finite, above `floor` (m) and within `reach` (m) of the Y axis; else what is wrong.
std::string check_all_within(const scene::Simulation& simulation, double floor, double reach);

/// Number of movable entities whose centre of mass is at least `height` high.
int count_above(const scene::Simulation& simulation, double height);

/// Number of movable entities whose centre of mass is farther than `distance` (m) from the plane z = 0.
int count_out_of_plane(const scene::Simulation& simulation, double distance);

/// Greatest speed of a movable entity's centre of mass, m/s.
double greatest_speed(const scene::Simulation& simulation);

}  // namespace embody::scenes
