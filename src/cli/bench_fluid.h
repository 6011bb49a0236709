// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Times a tank of sloshing water with floating bodies beside other rigid bodies, for several numbers of particles and
/// workers. Fails where the liquid's volume or a body's draft is wrong at the end.
int run_fluid(const BenchArguments& arguments);

}  // namespace embody::cli
