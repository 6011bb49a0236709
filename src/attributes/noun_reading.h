// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "attributes/model_facts.h"
#include "attributes/taxonomy_data.h"
#include "attributes/wordnet/noun_table.h"
#include "attributes/words.h"

namespace embody::attributes {

/// A noun of WordNet in a text: one word, or several with one entry in WordNet ("pepper mill").
struct NounOccurrence {
    wordnet::LemmaIndex lemma = 0;
    int segment = 0;        ///< of its first word, as in Token
    std::size_t first = 0;  ///< index of its first token
    std::size_t end = 0;    ///< one past its last token
    double physical = 0;    ///< fraction of its uses in which it means a physical thing, 0 to 1
    bool is_plain = false;  ///< usable as the name of a thing: mostly a thing, no adjective, no material
};

/// All nouns of the text that can mean a thing.
std::vector<NounOccurrence> nouns_of(const Taxonomy::Data& data, const std::vector<Token>& tokens);

/// Evidence for one meaning of a noun or another: the other words, and the size.
class Surroundings {
public:
    Surroundings(const Taxonomy::Data& data, const ModelFacts& facts);
    /// The same with the words of the name added, except the noun that is asked about.
    [[nodiscard]] Surroundings beside(const std::vector<Token>& name, const NounOccurrence& asked) const;

    /// Factor, about 0.02 to 20, by which the evidence makes the meaning more or less likely.
    [[nodiscard]] double support(std::optional<wordnet::SynsetIndex> meaning, const CategoryData& category) const;
    /// Factor, 0.05 to 1, by which the size makes the category less likely; 1 within its usual size.
    [[nodiscard]] double size_fit(const CategoryData& category) const;
    /// Whether there is any evidence.
    [[nodiscard]] bool tell() const { return !words_.empty() || !domains_.empty() || size_is_stated_; }
    /// Similarity of the meaning to the closest meaning of another word, 0 (none) to 1 (the same); empty where no
    /// other word means a physical thing.
    [[nodiscard]] std::optional<double> similarity(wordnet::SynsetIndex meaning) const;

private:
    void add_words(const std::vector<Token>& tokens, const NounOccurrence* without);

    const Taxonomy::Data& data_;
    std::unordered_set<wordnet::SynsetIndex> words_;        ///< meanings of the other words
    std::unordered_set<wordnet::SynsetIndex> above_words_;  ///< these meanings and their hypernyms
    std::unordered_set<std::string> domains_;               ///< of the taxonomy, named by the other words
    double largest_ = 0;                                    ///< extent, m; 0: unknown
    bool size_is_stated_ = false;
};

/// One reading of a noun: one of its meanings, and the nearest category at or above it.
struct NounReading {
    std::size_t entry = 0;  ///< of Data::categories
    wordnet::SynsetIndex meaning = 0, anchor = 0;
    std::size_t steps = 0;   ///< hypernyms from the meaning up to the anchor, which is the category's meaning
    double probability = 0;  ///< probability of this reading among all of the noun, 0 to 1
    double prior = 0;        ///< fraction of the noun's uses that have this meaning, before other evidence
    double fit = 0;          ///< weight of this reading with all evidence, not normalised
};

/// The likely readings, the likeliest first, and only the best of each category. Empty where no meaning leads to one.
std::vector<NounReading> readings_of(const Taxonomy::Data& data, wordnet::LemmaIndex noun,
                                     const Surroundings& surroundings);

/// "tureen.n.01 → bowl.n.01 (1 step up)".
std::string path_text(const wordnet::NounTable& nouns, const NounReading& reading);

/// Information content of the most specific common hypernym of two meanings: 0 where it is the root, 1 where they are
/// the same synset and it has no hyponyms.
double common_content(const wordnet::NounTable& nouns, wordnet::SynsetIndex a, wordnet::SynsetIndex b);

/// Whether one meaning is the other or a kind of it.
bool is_kind_of(const wordnet::NounTable& nouns, wordnet::SynsetIndex meaning, wordnet::SynsetIndex other);

}  // namespace embody::attributes
