// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "foundation/result.h"

namespace embody::attributes {

/// Levels of lists and objects that a JSON text may have; a real one needs less than ten.
inline constexpr int max_nesting_depth = 64;

/// Whether lists and objects of a JSON text nest deeper than that. Call it before the text is parsed: copying, printing
/// and freeing a value of a million brackets would overflow the stack. The text need not be valid.
bool nests_too_deep(std::string_view text);

/// Parses a JSON text that a person or another program wrote. Error: `where` (the origin of the text, such as a file's
/// name) with line, column and field where the text is no JSON, nests too deep, has a number that no double can hold,
/// or repeats a field of an object.
Result<nlohmann::json> parse_json(const std::string& text, const std::string& where);
/// The JSON document of a file, parsed by parse_json(); the error names the file, and the place where it is broken.
Result<nlohmann::json> read_json(const std::filesystem::path& file);

}  // namespace embody::attributes
