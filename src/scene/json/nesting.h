// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace embody::scene {

/// Levels of lists and objects that a scene or a command may have; a real one needs less than ten.
inline constexpr int deepest_nesting = 64;

/// Whether lists and objects of a JSON text nest deeper than that. To be asked before the text is parsed: copying,
/// printing and freeing a value of a million brackets would exhaust the stack. The text need not be valid.
bool nests_too_deep(std::string_view text);

}  // namespace embody::scene
