// SPDX-License-Identifier: MIT
#include "attributes/phrase_match.h"

#include <algorithm>
#include <span>

#include "attributes/words.h"

namespace embody::attributes {
namespace {

std::string join(std::span<const Token> tokens, std::string Token::*member) {
    std::string joined;
    for (const Token& token : tokens) {
        if (!joined.empty()) joined += ' ';
        joined += token.*member;
    }
    return joined;
}

// Of phrases with equal stems ("glass", "glasses") the one that is written as in the text is chosen, then the singular.
const Phrase* best_spelling(const PhraseIndex& index, std::span<const Token> tokens) {
    const std::string stems = join(tokens, &Token::stem);
    const std::string written = join(tokens, &Token::text);
    const auto [first, last] = index.equal_range(stems);
    const Phrase* best = nullptr;
    for (auto it = first; it != last; ++it) {
        if (it->second.text == written) return &it->second;
        if (best == nullptr || it->second.text == stems) best = &it->second;
    }
    return best;
}

struct Occurrence {
    const Phrase* phrase;
    int segment;
    std::size_t end;
};

bool is_preferred(const Occurrence& a, const Occurrence& b) {
    if (a.segment != b.segment) return a.segment < b.segment;
    if (a.end != b.end) return a.end > b.end;
    return a.phrase->length > b.phrase->length;
}

std::vector<Occurrence> occurrences(const PhraseIndex& index, std::size_t longest, const std::vector<Token>& tokens) {
    std::vector<Occurrence> found;
    for (std::size_t first = 0; first < tokens.size(); ++first) {
        for (std::size_t length = 1; length <= longest && first + length <= tokens.size(); ++length) {
            const Phrase* phrase = best_spelling(index, std::span(tokens).subspan(first, length));
            if (phrase != nullptr) found.push_back({phrase, tokens[first].segment, first + length});
        }
    }
    return found;
}

}  // namespace

bool add_phrase(PhraseIndex& index, std::string_view words, std::size_t entry) {
    const std::vector<Token> tokens = tokens_of(words);
    const std::string text = join(tokens, &Token::text);
    const std::string stems = join(tokens, &Token::stem);
    const auto [first, last] = index.equal_range(stems);
    if (tokens.empty() || std::any_of(first, last, [&](const auto& item) { return item.second.text == text; }))
        return false;
    index.emplace(stems, Phrase{text, tokens.size(), entry});
    return true;
}

std::optional<PhraseMatch> match_phrase(const PhraseIndex& index, std::size_t longest_phrase, std::string_view text) {
    const std::vector<Token> tokens = tokens_of(text);
    const std::vector<Occurrence> found = occurrences(index, longest_phrase, tokens);
    if (found.empty()) return std::nullopt;
    const Occurrence& best = *std::min_element(found.begin(), found.end(), is_preferred);

    // Other phrases of the text, for the reader; parts of the deciding phrase are left out.
    PhraseMatch match{
        best.phrase->entry, best.phrase->text, best.segment, best.end - best.phrase->length, best.end, {}};
    for (const Occurrence& other : found) {
        const bool inside = other.end <= best.end && other.end + best.phrase->length > best.end;
        const bool told = std::ranges::find(match.others, other.phrase->text) != match.others.end();
        if (other.phrase->entry != match.entry && !inside && !told) match.others.push_back(other.phrase->text);
    }
    return match;
}

std::string without_phrase(std::string_view text, std::string_view phrase) {
    const std::vector<Token> tokens = tokens_of(text);
    const std::vector<Token> cut = tokens_of(phrase);
    const auto found = std::search(tokens.begin(), tokens.end(), cut.begin(), cut.end(),
                                   [](const Token& a, const Token& b) { return a.stem == b.stem; });
    if (found == tokens.end() || cut.empty()) return std::string(text);
    const auto before = static_cast<std::size_t>(found - tokens.begin());
    const std::span all(tokens);
    return join(all.first(before), &Token::text) + " " + join(all.subspan(before + cut.size()), &Token::text);
}

std::string stems_of(std::string_view text) { return join(tokens_of(text), &Token::stem); }

}  // namespace embody::attributes
