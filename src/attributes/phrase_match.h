// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attributes/taxonomy_data.h"

namespace embody::attributes {

struct PhraseMatch {
    std::size_t entry = 0;
    std::string phrase;               ///< the words that decided
    int segment = 0;                  ///< index of the part of the text that they are in, counted by separators
    std::size_t first = 0, end = 0;   ///< indices of their tokens: from first to before end
    std::vector<std::string> others;  ///< phrases of other entries in the same text, which did not decide
};

/// Adds the phrase to the index; false where the same words are in it already.
bool add_phrase(PhraseIndex& index, std::string_view words, std::size_t entry);

/// The phrase that says what a thing is: in the first part of the name that has one ("chair with cushion"), the last
/// noun ("bedside lamp"), and of those the longest ("coffee table").
std::optional<PhraseMatch> match_phrase(const PhraseIndex& index, std::size_t longest_phrase, std::string_view text);

/// The text without the words of the phrase (words in lower case, separators as they were).
std::string without_phrase(std::string_view text, std::string_view phrase);

/// Stems of all words of the text, joined by one space.
std::string stems_of(std::string_view text);

}  // namespace embody::attributes
