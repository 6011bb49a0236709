// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Prints energy and momenta of water in closed tanks over a minute; fails where a particle is lost or energy comes
/// from nothing.
int run_tanks(const BenchArguments& arguments);

}  // namespace embody::cli
