// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "physics/inter/world.h"

namespace embody::convergence {

/// Steps the world for this time.
void run(physics::World& world, double seconds);

/// Mean time from one upward crossing of the middle of the signal's range to the next, s; 0 with fewer than two
/// crossings. One value for each step of `time_step` s.
double period_of(const std::vector<double>& signal, double time_step);

/// The results of `read` after each step, for this time.
std::vector<double> record(physics::World& world, double seconds, const std::function<double()>& read);

}  // namespace embody::convergence
