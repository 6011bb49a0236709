// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "foundation/result.h"

namespace embody::scene {

/// Reads a JSON text. Error: `where` (what the text is of, such as a file's name) with line, column and the field at
/// which it is no JSON, nests too deep, or has a number that no computer's number can hold.
Result<nlohmann::json> parse_json(const std::string& text, const std::string& where);

}  // namespace embody::scene
