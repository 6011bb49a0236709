// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace embody::database {

/// What a person typed as expressions of the full-text index: every word must occur, as a whole or as the beginning of
/// a longer one. Empty where there is no letter or digit.
struct MatchExpressions {
    std::string ranked;              ///< in any column; whole words count more than beginnings
    std::string anywhere;            ///< matches the same, in half the time, but ranks worse
    std::string in_name;             ///< whole words in the name
    std::string beginnings_in_name;  ///< words or beginnings in the name
};
/// Any bytes are fine; only the first 16 words of at most 64 bytes count.
MatchExpressions match_expressions(std::string_view typed);

}  // namespace embody::database
