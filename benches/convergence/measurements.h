// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "physics/inter/world.h"

namespace embody::convergence {

/// Steps the world for so many seconds.
void run(physics::World& world, double seconds);

/// Time from one upward crossing of the middle of its range to the next, mean over all, s; 0 with fewer than two. One
/// value a step of `time_step` s.
double period_of(const std::vector<double>& signal, double time_step);

/// What `read` gives after each step, for so many seconds.
std::vector<double> record(physics::World& world, double seconds, const std::function<double()>& read);

}  // namespace embody::convergence
