// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace embody::scene {

/// JSON for people: fields that name a thing first, short lists of numbers on one line. Ends with a newline.
std::string print_json(const nlohmann::json& json);

}  // namespace embody::scene
