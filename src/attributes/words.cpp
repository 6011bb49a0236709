// SPDX-License-Identifier: MIT
#include "attributes/words.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace embody::attributes {
namespace {

// English separators, then the same words in German, French, Spanish and Italian that are no English nouns.
constexpr auto separators = std::to_array<std::string_view>(
    {"with", "and",     "for",  "of",  "in",  "on",   "by",   "under", "from", "to",   "at", "over",
     "or",   "without", "plus", "mit", "und", "aus",  "ohne", "avec",  "sans", "et",   "en", "au",
     "de",   "des",     "du",   "con", "sin", "para", "del",  "di",    "da",   "della"});

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_letter(char c) { return is_lower(c) || is_upper(c); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_separating(char c) { return std::string_view(",;:()[]{}&+/|").find(c) != std::string_view::npos; }

// Plain letters for the accented ones of Latin-1, which in UTF-8 are 0xC3 and this second byte; 0 for anything else.
char plain_letter(std::uint8_t second) {
    constexpr std::string_view plain = "AAAAAAACEEEEIIIIDNOOOOO OUUUUY saaaaaaaceeeeiiiidnooooo ouuuuy y";
    const std::size_t index = static_cast<std::size_t>(second) - 0x80;
    return index < plain.size() && plain[index] != ' ' ? plain[index] : '\0';
}

// Whether the text so far ends in a single d or l.
bool is_elided(std::string_view text) {
    if (text.empty()) return false;
    const bool is_alone = text.size() == 1 || (text.size() > 1 && !is_letter(text[text.size() - 2]));
    return is_alone && std::string_view("dDlL").find(text.back()) != std::string_view::npos;
}

// ASCII text of the same words; other scripts become spaces.
std::string without_accents(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<std::uint8_t>(text[i]);
        if (byte < 0x80) {
            // An apostrophe joins, "captain's" is one word; but not an article or "de" that lost its vowel: "table
            // d'angle".
            if (text[i] == '\'' && is_elided(plain))
                plain.back() = plain.back() == 'd' || plain.back() == 'D' ? ',' : ' ';
            if (text[i] != '\'') plain += text[i];
        } else if (byte == 0xC3 && i + 1 < text.size()) {
            constexpr char sharp_s = '\x9F';
            const char letter = plain_letter(static_cast<std::uint8_t>(text[++i]));
            if (text[i] == sharp_s) plain += letter;  // written "ss" without it
            plain += letter != '\0' ? letter : ' ';
        } else if (byte >= 0xC0) {
            plain += ' ';
        }
    }
    return plain;
}

// Whether a new word begins between two characters: bed|140, bedside|Table, but iPhone stays whole.
bool begins_word(std::string_view word, char next) {
    const char last = word.back();
    if (is_digit(last) != is_digit(next)) return true;
    return is_lower(last) && is_upper(next) && word.size() >= 2;
}

class TokenList {
public:
    void add_character(char c) {
        if (!is_letter(c) && !is_digit(c)) {
            finish_word();
            if (is_separating(c)) separate();
            return;
        }
        if (!word_.empty() && begins_word(word_, c)) finish_word();
        word_ += c;
    }
    void finish_word() {
        if (word_.empty()) return;
        std::ranges::transform(word_, word_.begin(),
                               [](char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; });
        // A number after the noun counts parts: a "sofa 2 seats" is a sofa.
        const bool is_count = is_digit(word_.front()) && !tokens_.empty();
        if (is_count || is_separating_word(word_)) ++segment_;
        tokens_.push_back({word_, singular_of(word_), segment_});
        word_.clear();
    }
    std::vector<Token> take() { return std::move(tokens_); }

private:
    void separate() {
        ++segment_;
        tokens_.push_back({",", ",", segment_});
    }

    std::vector<Token> tokens_;
    std::string word_;
    int segment_ = 0;
};

bool ends_with_any(std::string_view word, std::initializer_list<std::string_view> endings) {
    return std::ranges::any_of(endings, [&](std::string_view ending) { return word.ends_with(ending); });
}

}  // namespace

bool is_separating_word(std::string_view word) { return std::ranges::find(separators, word) != separators.end(); }

std::string singular_of(std::string_view word) {
    const std::string_view shorter = word.substr(0, word.empty() ? 0 : word.size() - 1);
    if (word.size() <= 3 || !word.ends_with('s') || ends_with_any(word, {"ss", "us", "is", "as"}))
        return std::string(word);
    if (word.size() > 4 && word.ends_with("ies")) return std::string(word.substr(0, word.size() - 3)) + "y";
    if (ends_with_any(word, {"sses", "shes", "ches", "xes"})) return std::string(word.substr(0, word.size() - 2));
    return std::string(shorter);
}

std::vector<Token> tokens_of(std::string_view text) {
    TokenList list;
    for (const char c : without_accents(text.substr(0, 1000))) list.add_character(c);
    list.finish_word();
    return list.take();
}

}  // namespace embody::attributes
