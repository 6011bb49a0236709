// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments.h"

namespace embody::cli {

/// Times a tank of sloshing water with things afloat beside other rigid bodies, at several numbers of particles and
/// workers. Fails where volume or drafts at the end are wrong.
int run_fluid(const BenchArguments& arguments);

}  // namespace embody::cli
