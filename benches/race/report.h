// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benches/race/race.h"

namespace embody::race {

/// A table on standard output: a row an engine, `stages` adds where Embody's time went.
void print_race(const RaceResult& result, const RaceOptions& options, bool stages);

/// The same for programs.
nlohmann::json to_json(const RaceResult& result);

/// Embody's answer was as it must be; the peers' are their own affair.
bool embody_is_right(const RaceResult& result);

}  // namespace embody::race
