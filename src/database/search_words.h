// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace embody::database {

/// What a person typed as an expression of the full-text index: every word must occur, as a whole or as the beginning
/// of a longer one, and whole words count more. Empty where there is no letter or digit. Any bytes are fine; only the
/// first 16 words of at most 64 bytes count.
std::string match_expression(std::string_view typed);

}  // namespace embody::database
