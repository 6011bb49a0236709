// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "foundation/result.h"

namespace embody::attributes {

/// Levels of lists and objects that a JSON text may have; a real one needs less than ten.
inline constexpr int deepest_nesting = 64;

/// Whether lists and objects of a JSON text nest deeper than that. To be asked before the text is parsed: copying,
/// printing and freeing a value of a million brackets would exhaust the stack. The text need not be valid.
bool nests_too_deep(std::string_view text);

/// Reads a JSON text that a person or another program wrote. Error: `where` (what the text is of, such as a file's
/// name) with line, column and the field at which it is no JSON, nests too deep, has a number that no computer's number
/// can hold, or names a field of an object a second time.
Result<nlohmann::json> parse_json(const std::string& text, const std::string& where);
/// The JSON document of a file, read as parse_json() does; the error names the file, and the place where it is broken.
Result<nlohmann::json> read_json(const std::filesystem::path& file);

}  // namespace embody::attributes
