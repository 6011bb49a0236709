// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace embody::cli {

/// Runs embody-race, which lies beside this program, with these arguments; passes on its output and exit code.
int run_race(const std::vector<std::string>& words);

}  // namespace embody::cli
