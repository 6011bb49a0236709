// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benches/race/race.h"

namespace embody::race {

/// Prints a table with a row for each engine; `stages` adds the times of Embody's stages.
void print_race(const RaceResult& result, const RaceOptions& options, bool stages);

/// The same as JSON.
nlohmann::json to_json(const RaceResult& result);

/// Whether Embody's end state was correct; those of other engines are not judged.
bool embody_is_right(const RaceResult& result);

}  // namespace embody::race
