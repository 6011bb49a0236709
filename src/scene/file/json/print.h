// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace embody::scene {

/// The JSON as people like to read it: what names a thing first, short lists of numbers on one line. Ends with a
/// newline.
std::string print_json(const nlohmann::json& json);

}  // namespace embody::scene
