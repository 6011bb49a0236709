// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace embody::cli {

/// Runs embody-race, which lies beside this program, with these words; its output and exit code are handed through.
int run_race(const std::vector<std::string>& words);

}  // namespace embody::cli
