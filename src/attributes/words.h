// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace embody::attributes {

/// One word of a name, and the number of separators ("with", "of", a number, a comma, a bracket …) before it. The words
/// before the first separator name the thing: a "chair with cushion" is a chair.
struct Token {
    std::string text;  ///< lower case, accents folded
    std::string stem;  ///< singular
    int segment = 0;
};

/// Words of a name: split at every character that is neither letter nor digit, between letters and digits, and inside
/// camelCase. Punctuation that separates stays as a token ",", so that no phrase crosses it.
std::vector<Token> tokens_of(std::string_view text);

/// Whether the word ("with", "of" …) ends the part of a name that says what the thing is.
bool is_separating_word(std::string_view word);

/// Singular of an English noun, good enough to compare two words that both went through it.
std::string singular_of(std::string_view word);

}  // namespace embody::attributes
