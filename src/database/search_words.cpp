// SPDX-License-Identifier: MIT
#include "database/search_words.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace embody::database {
namespace {

constexpr std::size_t max_words = 16;
constexpr std::size_t max_word_bytes = 64;

struct CodePoint {
    std::uint32_t value = 0;  ///< 0 where the bytes are not UTF-8
    std::size_t bytes = 1;
};

CodePoint read_code_point(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xF0 && lead < 0xF5   ? 4
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                                                             : 0;
    if (length == 0 || text.size() < length) return {};
    std::uint32_t value = lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        value = value << 6 | (byte(i) & 0x3Fu);
    }
    return {value, length};
}

// Letters and digits of any script, close to the index's own definition: a character that passes wrongly only finds
// nothing.
bool is_part_of_word(std::uint32_t c) {
    if (c < 0x80) return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    const bool latin_sign = c < 0xC0 && c != 0xAA && c != 0xB5 && c != 0xBA;
    const bool sign = (c >= 0x2000 && c < 0x2C00) || (c >= 0x3000 && c < 0x3005) || (c >= 0x3008 && c < 0x3021);
    const bool picture = (c >= 0xE000 && c < 0xF900) || (c >= 0xFE00 && c < 0xFE70) || c == 0xFFFD || c >= 0x1F000;
    return !latin_sign && !sign && !picture && c != 0xD7 && c != 0xF7;
}

std::vector<std::string> split_words(std::string_view typed) {
    std::vector<std::string> words;
    std::string word;
    const auto end_word = [&] {
        if (!word.empty() && std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
        word.clear();
    };
    while (!typed.empty() && words.size() < max_words) {
        const CodePoint c = read_code_point(typed);
        if (!is_part_of_word(c.value)) {
            end_word();
        } else if (word.size() + c.bytes <= max_word_bytes) {
            word += typed.substr(0, c.bytes);
        }
        typed.remove_prefix(c.bytes);
    }
    if (words.size() < max_words) end_word();
    return words;
}

}  // namespace

MatchExpressions match_expressions(std::string_view typed) {
    // In double quotes nothing is an operator, and no quote is part of a word. A whole word matches both sides of its
    // OR, so "chair" puts a chair before a chairlift.
    MatchExpressions expressions;
    std::string whole;
    for (const std::string& word : split_words(typed)) {
        for (std::string* expression : {&expressions.ranked, &expressions.anywhere, &whole}) {
            if (!expression->empty()) *expression += " AND ";
        }
        expressions.ranked.append("(\"").append(word).append("\" OR \"").append(word).append("\" *)");
        expressions.anywhere.append("\"").append(word).append("\" *");
        whole.append("\"").append(word).append("\"");
    }
    if (whole.empty()) return expressions;
    expressions.in_name = "name : (" + whole + ")";
    expressions.beginnings_in_name = "name : (" + expressions.anywhere + ")";
    return expressions;
}

}  // namespace embody::database
