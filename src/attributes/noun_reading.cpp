// SPDX-License-Identifier: MIT
// From a noun to the taxonomy through WordNet: choice of the sense, then the nearest hypernym that is a category.
// The similarity of meanings is the information content of their most specific common hypernym (P. Resnik, "Using
// information content to evaluate semantic similarity in a taxonomy", IJCAI 1995), computed here from the number of
// synsets below a node, without a corpus.
#include "attributes/noun_reading.h"

#include <algorithm>
#include <cmath>

#include "attributes/phrase_match.h"

namespace embody::attributes {
namespace {

using wordnet::LemmaIndex;
using wordnet::NounSense;
using wordnet::NounTable;
using wordnet::SynsetIndex;
using wordnet::Topic;

constexpr std::size_t max_collocation_words = 5;
constexpr std::size_t meanings_asked = 12;  // of a noun; the rarer meanings are hardly ever right
constexpr std::size_t words_asked = 24;     // of the surroundings

// Frequency of a meaning: its count in the tagged texts, plus a fraction that decreases with its place in the list, for
// meanings without a count.
double frequency(const NounSense& sense, std::size_t place) {
    return sense.tag_count + 1.0 / (1.0 + static_cast<double>(place));
}

double physical_fraction(const NounTable& nouns, LemmaIndex noun) {
    double all = 0, physical = 0;
    const auto senses = nouns.senses(noun);
    for (std::size_t i = 0; i < senses.size(); ++i) {
        const double weight = frequency(senses[i], i);
        all += weight;
        if (nouns.is_physical(senses[i].synset) && !nouns.is_instance(senses[i].synset)) physical += weight;
    }
    return all > 0 ? physical / all : 0;
}

// Prior for a topic: how likely somebody makes a 3D model of such a thing.
double topic_factor(Topic topic) {
    switch (topic) {
        case Topic::artifact:
            return 1;
        case Topic::food:
            return 0.75;
        case Topic::animal:
            return 0.6;
        case Topic::plant:
            return 0.4;
        case Topic::object:
        case Topic::substance:
            return 0.4;
        case Topic::body:
            return 0.3;
        case Topic::person:
            return 0.08;
        default:
            return 0.25;
    }
}

// The hypernyms of a meaning, nearest first, each with its number of steps; the meaning itself is the first.
struct Above {
    SynsetIndex synset;
    std::size_t steps;
};
std::vector<Above> all_above(const NounTable& nouns, SynsetIndex meaning) {
    std::vector<Above> above{{meaning, 0}};
    for (std::size_t i = 0; i < above.size(); ++i) {
        const Above current = above[i];
        for (const SynsetIndex hypernym : nouns.hypernyms(current.synset)) {
            if (std::ranges::find(above, hypernym, &Above::synset) == above.end()) {
                above.push_back({hypernym, current.steps + 1});
            }
        }
    }
    return above;
}

// The nearest category; of two at equal distance the more specific. An artifact that WordNet puts under places or signs
// still counts as an artifact.
std::optional<NounReading> nearest_category(const Taxonomy::Data& data, SynsetIndex meaning) {
    std::optional<NounReading> best;
    const std::vector<Above> above_meaning = all_above(*data.nouns, meaning);
    for (const Above& above : above_meaning) {
        if (best && above.steps > best->steps) break;
        const auto found = data.by_synset.find(above.synset);
        if (found == data.by_synset.end()) continue;
        if (best && data.nouns->count_of_kind(above.synset) >= data.nouns->count_of_kind(best->anchor)) continue;
        best = NounReading{found->second, meaning, above.synset, above.steps};
    }
    const auto made = data.nouns->find_synset("artifact.n.01");
    if (best || !made || data.nouns->topic(meaning) != Topic::artifact || !data.by_synset.contains(*made)) return best;
    return NounReading{data.by_synset.at(*made), meaning, *made, above_meaning.back().steps};
}

// Information content: 1 for a synset without hyponyms, 0 for the root.
double content_of(const NounTable& nouns, SynsetIndex synset) {
    return 1 - std::log(nouns.count_of_kind(synset)) / std::log(nouns.synset_count());
}

std::string joined(const std::vector<Token>& tokens, std::size_t first, std::size_t length, const char* between) {
    std::string text = tokens[first].text;
    for (std::size_t i = first + 1; i < first + length; ++i) text += between + tokens[i].text;
    return text;
}

bool can_be_noun(const Token& token) {
    return token.text.size() > 1 && token.text.front() > '9' && !is_separating_word(token.text);
}

// Two letters are mostly a size, a unit or a chemical element, unless their first meaning is an artifact: a TV, a PC.
std::optional<LemmaIndex> one_word(const NounTable& nouns, const Token& token) {
    if (!can_be_noun(token)) return std::nullopt;
    const auto lemma = nouns.find_inflected(token.text);
    if (!lemma || token.text.size() > 2) return lemma;
    return nouns.topic(nouns.senses(*lemma).front().synset) == Topic::artifact ? lemma : std::nullopt;
}

std::optional<LemmaIndex> lemma_at(const NounTable& nouns, const std::vector<Token>& tokens, std::size_t first,
                                   std::size_t length) {
    if (length == 1) return one_word(nouns, tokens[first]);
    for (std::size_t i = first; i < first + length; ++i) {
        if (tokens[i].text == ",") return std::nullopt;
    }
    if (const auto lemma = nouns.find_inflected(joined(tokens, first, length, "_"))) return lemma;
    // Two tokens that are one word in WordNet: "flower pot".
    const bool could_join = length == 2 && can_be_noun(tokens[first]) && can_be_noun(tokens[first + 1]);
    return could_join ? nouns.find_inflected(joined(tokens, first, length, "")) : std::nullopt;
}

}  // namespace

std::vector<NounOccurrence> nouns_of(const Taxonomy::Data& data, const std::vector<Token>& tokens) {
    std::vector<NounOccurrence> found;
    for (std::size_t first = 0; first < tokens.size(); ++first) {
        for (std::size_t length = 1; length <= max_collocation_words && first + length <= tokens.size(); ++length) {
            const auto lemma = lemma_at(*data.nouns, tokens, first, length);
            if (!lemma) continue;
            const double physical = physical_fraction(*data.nouns, *lemma);
            if (physical <= 0) continue;
            const bool is_material = data.material_phrases.contains(stems_of(joined(tokens, first, length, " ")));
            const bool is_plain = physical >= 0.5 && !is_material && !data.nouns->is_mostly_adjective(*lemma);
            found.push_back({*lemma, tokens[first].segment, first, first + length, physical, is_plain});
        }
    }
    return found;
}

Surroundings::Surroundings(const Taxonomy::Data& data, const ModelFacts& facts)
    : data_(data), size_is_stated_(facts.size_is_stated) {
    const Vec3 size = facts.geometry.size;
    const double largest = std::max({size.x, size.y, size.z});
    if (is_finite(size) && largest > 0) largest_ = largest;
    for (const std::string& tag : facts.tags) add_words(tokens_of(tag), nullptr);
    add_words(tokens_of(facts.folder), nullptr);

    // The catalogue's own category names a room or a trade, and so do the names of the taxonomy's files.
    const std::vector<Token> category = tokens_of(facts.catalogue_category);
    add_words(category, nullptr);
    for (const Token& token : category) domains_.insert(token.stem);
    const auto usual = data.by_catalogue.find(stems_of(facts.catalogue_category));
    if (usual != data.by_catalogue.end()) domains_.insert(data.categories[usual->second].domain);
}

Surroundings Surroundings::beside(const std::vector<Token>& name, const NounOccurrence& asked) const {
    Surroundings all = *this;
    all.add_words(name, &asked);
    return all;
}

void Surroundings::add_words(const std::vector<Token>& tokens, const NounOccurrence* without) {
    std::size_t asked = 0;
    for (const NounOccurrence& noun : nouns_of(data_, tokens)) {
        const bool overlaps = without != nullptr && noun.first < without->end && noun.end > without->first;
        if (overlaps || ++asked > words_asked) continue;
        const auto senses = data_.nouns->senses(noun.lemma);
        for (const NounSense& sense : senses.first(std::min<std::size_t>(senses.size(), 4))) {
            if (!data_.nouns->is_physical(sense.synset) || data_.nouns->is_instance(sense.synset)) continue;
            words_.insert(sense.synset);
            for (const Above& above : all_above(*data_.nouns, sense.synset)) above_words_.insert(above.synset);
        }
    }
}

// Information content of the most specific common hypernym of the meaning and of another word. Higher where the meaning
// is a kind of the other word's (a bat beside "animal"), unless that word says next to nothing ("object").
std::optional<double> Surroundings::similarity(SynsetIndex meaning) const {
    if (above_words_.empty()) return std::nullopt;
    constexpr double of_that_kind = 0.75;
    double max_content = 0;
    for (const Above& above : all_above(*data_.nouns, meaning)) {
        if (!above_words_.contains(above.synset)) continue;
        const double content = content_of(*data_.nouns, above.synset);
        const bool says_kind = content > 0.2 && words_.contains(above.synset);
        max_content = std::max(max_content, says_kind ? std::max(content, of_that_kind) : content);
    }
    return max_content;
}

// 1 within the usual size of the category; decreases with the factor by which the size is outside.
double Surroundings::size_fit(const CategoryData& category) const {
    if (largest_ <= 0) return 1;
    const double outside = outside_usual_size(category, largest_);
    // A size with a guessed unit counts less.
    const double strength = size_is_stated_ ? 1.5 : 0.4;
    return std::max(std::exp(-strength * outside), 0.05);
}

double Surroundings::support(std::optional<SynsetIndex> meaning, const CategoryData& category) const {
    // A hypernym of nearly everything, such as artifact.n.01, says nothing.
    const double common = meaning ? similarity(*meaning).value_or(0) : 0;
    const double related = std::exp(5 * std::max(common - 0.25, 0.0));
    const double at_home = domains_.contains(category.domain) ? 1.6 : 1;
    return related * at_home * size_fit(category);
}

std::vector<NounReading> readings_of(const Taxonomy::Data& data, LemmaIndex noun, const Surroundings& surroundings) {
    const NounTable& nouns = *data.nouns;
    const auto senses = nouns.senses(noun);
    std::vector<NounReading> readings;
    double priors = 0;
    for (std::size_t i = 0; i < senses.size() && i < meanings_asked; ++i) {
        const SynsetIndex meaning = senses[i].synset;
        if (!nouns.is_physical(meaning) || nouns.is_instance(meaning)) continue;
        auto reading = nearest_category(data, meaning);
        if (!reading) continue;
        // Counts from essays and news say little about a catalogue of things: only their square root is used.
        reading->prior = std::sqrt(frequency(senses[i], i)) * topic_factor(nouns.topic(meaning)) *
                         std::pow(0.85, static_cast<double>(reading->steps));
        reading->fit = reading->prior * surroundings.support(meaning, data.categories[reading->entry]);
        priors += reading->prior;
        readings.push_back(*reading);
    }
    for (NounReading& reading : readings) reading.prior /= priors;
    std::ranges::stable_sort(readings, std::greater{}, &NounReading::fit);

    // Meanings that lead to the same category are added.
    std::vector<NounReading> best;
    double sum = 0;
    for (const NounReading& reading : readings) {
        sum += reading.fit;
        const auto same = std::ranges::find(best, reading.entry, &NounReading::entry);
        if (same == best.end())
            best.push_back(reading);
        else
            same->fit += reading.fit;
    }
    std::ranges::stable_sort(best, std::greater{}, &NounReading::fit);
    for (NounReading& reading : best) reading.probability = reading.fit / sum;
    return best;
}

std::string path_text(const NounTable& nouns, const NounReading& reading) {
    if (reading.steps == 0) return nouns.name(reading.meaning);
    return nouns.name(reading.meaning) + " → " + nouns.name(reading.anchor) + " (" + std::to_string(reading.steps) +
           (reading.steps == 1 ? " step up)" : " steps up)");
}

double common_content(const NounTable& nouns, SynsetIndex a, SynsetIndex b) {
    const std::vector<Above> above_b = all_above(nouns, b);
    double max_content = 0;
    for (const Above& above : all_above(nouns, a)) {
        const bool shared = std::ranges::find(above_b, above.synset, &Above::synset) != above_b.end();
        if (shared) max_content = std::max(max_content, content_of(nouns, above.synset));
    }
    return max_content;
}

bool is_kind_of(const NounTable& nouns, SynsetIndex meaning, SynsetIndex other) {
    const std::vector<Above> above = all_above(nouns, meaning);
    return std::ranges::find(above, other, &Above::synset) != above.end();
}

}  // namespace embody::attributes
