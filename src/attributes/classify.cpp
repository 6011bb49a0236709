// SPDX-License-Identifier: MIT
#include "attributes/classify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "attributes/as_model.h"
#include "attributes/form.h"
#include "attributes/noun_reading.h"
#include "attributes/phrase_match.h"
#include "attributes/words.h"

namespace embody::attributes {
namespace {

using wordnet::NounTable;

// Confidence in each source: in the taxonomy's own phrases, and in nouns that only WordNet knows.
// docs/decisions/0009-wordnet.md says how the numbers were found.
struct Trust {
    const char* where;
    double phrase;
    double noun;
};
constexpr Trust name_trust{"name", 0.95, 0.9};
constexpr Trust collection_trust{"collection", 0.97, 0.92};
constexpr Trust tag_trust{"tag", 0.65, 0.55};
constexpr Trust folder_trust{"folder", 0.5, 0.4};
constexpr Trust category_trust{"catalogue category", 0.3, 0.15};
constexpr Trust part_trust{"part material", 0.25, 0.15};
constexpr double usual_of_catalogue = 0.35;  // "Lights" → lamp
constexpr double a_step = 0.93;              // factor for each hypernym
constexpr double own_word = 3;               // weight of the taxonomy's reading of a word against WordNet's others
constexpr double overruled = 0.5;            // factor for a phrase of the name that is not the thing itself
constexpr double trust_in_compound = 0.9;    // "deskchair"
constexpr double trust_in_ending = 0.65;     // "Kaffeetisch"
constexpr double nothing_known = 0.05;
constexpr std::size_t long_name = 6;     // words; from here on it is a sales text, whose last noun says less than a tag
constexpr double trust_in_long = 0.55;   // factor on the confidence of a short name
constexpr double close_runner_up = 0.6;  // of the winner's confidence

AttributeLevel level_of(const CategoryData& category) {
    return category.parent.empty() ? AttributeLevel::category : AttributeLevel::subcategory;
}

// Source of an answer: name says "lamp" (it also says "table").
std::string because(std::string_view where, const PhraseMatch& match) {
    std::string text = std::string(where) + " says \"" + match.phrase + "\"";
    for (std::size_t i = 0; i < match.others.size() && i < 3; ++i) {
        text += (i == 0 ? "; it also says \"" : "\", \"") + match.others[i];
    }
    return match.others.empty() ? text : text + "\", which a name's last noun or first part overrules";
}

Candidate candidate_of(const Taxonomy::Data& data, const Trust& trust, const PhraseMatch& match) {
    const CategoryData& category = data.categories[match.entry];
    return {.category = &category,
            .confidence = trust.phrase,
            .where = trust.where,
            .source = because(trust.where, match),
            .phrase = match.phrase,
            .synset = category.synset,
            .reckoning = "the taxonomy's own word in the " + std::string(trust.where),
            .level = level_of(category)};
}

bool are_of_one_family(const CategoryData& a, const CategoryData& b) {
    const std::string& of_a = a.parent.empty() ? a.name : a.parent;
    return of_a == (b.parent.empty() ? b.name : b.parent);
}

// A noun as it stands in the text, with its readings.
struct ReadNoun {
    NounOccurrence noun;
    std::string text;
    std::vector<NounReading> readings;
};

// A noun that is hardly related to the tags may be a brand or an ornament.
double trust_beside(const Surroundings& surroundings, const NounReading& reading) {
    const auto common = surroundings.similarity(reading.meaning);
    return common ? std::clamp(0.75 + 0.6 * (*common - 0.15), 0.75, 1.05) : 1;
}

Candidate candidate_of(const Taxonomy::Data& data, const Trust& trust, const ReadNoun& read, std::size_t choice) {
    const NounReading& reading = read.readings[choice];
    const CategoryData& category = data.categories[reading.entry];
    // Only half of the doubt between readings counts, since the losing readings are often close in meaning to the
    // winner. A word that seldom means a physical thing is seldom the name of one.
    const double confidence = trust.noun * std::pow(a_step, static_cast<double>(reading.steps)) *
                              (0.5 + 0.5 * reading.probability) * (0.6 + 0.4 * std::min(1.0, 2 * read.noun.physical));
    return {.category = &category,
            .confidence = choice == 0 ? confidence : confidence * reading.probability,
            .where = trust.where,
            .source = std::string(trust.where) + " says \"" + read.text + "\" → " + path_text(*data.nouns, reading),
            .phrase = read.text,
            .synset = data.nouns->name(reading.meaning),
            .steps = reading.steps,
            .reckoning = "noun of WordNet in the " + std::string(trust.where) + ", " + std::to_string(reading.steps) +
                         " steps up, " + short_number(100 * reading.probability) + " % of what it can mean here",
            .level = level_of(category)};
}

std::string text_of(const std::vector<Token>& tokens, const NounOccurrence& noun) {
    std::string text = tokens[noun.first].text;
    for (std::size_t i = noun.first + 1; i < noun.end; ++i) text += " " + tokens[i].text;
    return text;
}

// The same order as for phrases: plain nouns first, then the first part of the name, in it the last noun, of these the
// longest.
bool is_preferred(const NounOccurrence& a, const NounOccurrence& b) {
    if (a.is_plain != b.is_plain) return a.is_plain;
    if (a.segment != b.segment) return a.segment < b.segment;
    if (a.end != b.end) return a.end > b.end;
    return a.end - a.first > b.end - b.first;
}

// The first noun of the text, in the order of is_preferred(), that leads to a category.
std::optional<ReadNoun> read_noun(const Taxonomy::Data& data, const std::vector<Token>& tokens,
                                  const Surroundings& surroundings, bool is_name) {
    std::vector<NounOccurrence> nouns = nouns_of(data, tokens);
    std::ranges::stable_sort(nouns, is_preferred);
    for (const NounOccurrence& noun : nouns) {
        auto readings = is_name ? readings_of(data, noun.lemma, surroundings.beside(tokens, noun))
                                : readings_of(data, noun.lemma, surroundings);
        if (!readings.empty()) return ReadNoun{noun, text_of(tokens, noun), std::move(readings)};
    }
    return std::nullopt;
}

bool is_kind_of_any(const NounTable& nouns, wordnet::SynsetIndex meaning, std::optional<wordnet::LemmaIndex> noun) {
    if (!noun) return false;
    return std::ranges::any_of(
        nouns.senses(*noun), [&](const wordnet::NounSense& sense) { return is_kind_of(nouns, meaning, sense.synset); });
}

// Whether the name is about a noun that only WordNet knows, and not about the taxonomy's phrase: a "guinea pig" is no
// pig, a "wine decanter" no wine; but a "coffee mug" is a mug, and a "sofa classic" a sofa.
bool noun_overrules(const Taxonomy::Data& data, const std::vector<Token>& tokens, const PhraseMatch& phrase,
                    const ReadNoun& read) {
    const NounOccurrence& noun = read.noun;
    const NounReading& reading = read.readings.front();
    const CategoryData& category = data.categories[phrase.entry];
    if (reading.entry == phrase.entry) return false;
    // A "waffle maker" is no person.
    if (data.nouns->topic(reading.meaning) == wordnet::Topic::person) return false;

    // The phrase means a kind of what the noun means: the phrase says more.
    const auto meant = data.nouns->find_synset(category.synset);
    if (meant && is_kind_of(*data.nouns, *meant, reading.meaning)) return false;

    // Several words with one entry in WordNet, the phrase among them.
    const bool covers = noun.first <= phrase.first && noun.end >= phrase.end;
    if (covers && noun.end - noun.first > phrase.end - phrase.first) {
        if (noun.physical < 0.4) return false;
        if (noun.end > phrase.end) return true;
        if (meant && is_kind_of(*data.nouns, reading.meaning, *meant)) return false;
        return !is_kind_of_any(*data.nouns, reading.meaning, data.nouns->find_inflected(tokens[noun.end - 1].text));
    }
    if (covers || !noun.is_plain || noun.physical < 0.6 || reading.probability < 0.4) return false;
    // Either the last noun of the same part, or a noun of an earlier part.
    return noun.segment == phrase.segment ? noun.first >= phrase.end : noun.segment < phrase.segment;
}

// Other meanings of the taxonomy's word that are not related to the taxonomy's meaning: readings with their odds
// against the taxonomy's own reading, the likeliest first.
struct OtherMeanings {
    ReadNoun read;
    std::vector<double> odds;  ///< one for each of read.readings
};
OtherMeanings other_meanings(const Taxonomy::Data& data, const std::vector<Token>& tokens, const PhraseMatch& phrase,
                             const Surroundings& surroundings) {
    const auto noun = data.nouns->find_inflected(tokens[phrase.end - 1].text);
    const CategoryData& category = data.categories[phrase.entry];
    const auto meant = data.nouns->find_synset(category.synset);
    if (phrase.end - phrase.first != 1 || !noun || !meant) return {};
    OtherMeanings others;
    others.read = {{.lemma = *noun, .first = phrase.first, .end = phrase.end, .physical = 1}, phrase.phrase, {}};
    const double here = own_word * surroundings.support(meant, category);
    for (const NounReading& reading : readings_of(data, *noun, surroundings)) {
        const CategoryData& other = data.categories[reading.entry];
        if (reading.entry == phrase.entry || are_of_one_family(category, other) ||
            common_content(*data.nouns, *meant, reading.meaning) > 0.3)
            continue;
        others.read.readings.push_back(reading);
        others.odds.push_back(reading.prior * surroundings.support(reading.meaning, other) / here);
    }
    return others;
}

// Adds meanings that a person should know of, with less confidence than the taxonomy's; the source of the first
// candidate names them.
void add_other_meanings(const Taxonomy::Data& data, const OtherMeanings& others, std::vector<Candidate>& found) {
    constexpr double min_odds = 0.05;
    for (std::size_t i = 0; i < others.odds.size() && i < 3; ++i) {
        if (others.odds[i] < min_odds) continue;
        Candidate other = candidate_of(data, name_trust, others.read, i);
        other.confidence = name_trust.phrase * others.odds[i] / (1 + others.odds[i]);
        other.reckoning = "another meaning of the word, less usual for a model";
        found.front().source += "; it may also mean " + std::string(data.nouns->name(others.read.readings[i].meaning)) +
                                " (" + other.category->name + ")";
        found.push_back(std::move(other));
    }
}

// A "toy lawn mower" is a toy, unless the taxonomy has a phrase for exactly that.
std::optional<Candidate> find_toy(const Taxonomy::Data& data, const std::vector<Token>& tokens,
                                  const PhraseMatch& phrase) {
    const CategoryData* toy = data.category("toy");
    const CategoryData& category = data.categories[phrase.entry];
    if (toy == nullptr || category.domain == toy->domain) return std::nullopt;
    const auto before = std::span(tokens).first(phrase.first);
    const bool says_toy = std::ranges::any_of(before, [&](const Token& token) {
        return token.segment == phrase.segment && (token.stem == "toy" || token.stem == "pretend");
    });
    if (!says_toy || phrase.phrase.find("toy") != std::string::npos) return std::nullopt;
    return Candidate{.category = toy,
                     .confidence = name_trust.phrase,
                     .where = name_trust.where,
                     .source = "name says that it is a toy \"" + phrase.phrase + "\"",
                     .phrase = "toy",
                     .synset = toy->synset,
                     .reckoning = "the word before says that it is a toy",
                     .level = level_of(*toy)};
}

// Candidates from the name: the taxonomy's phrase, or a noun that the taxonomy does not have; the other one follows
// with less confidence.
std::vector<Candidate> candidates_from_name(const Taxonomy::Data& data, std::string_view name,
                                            const Surroundings& surroundings) {
    const std::vector<Token> tokens = tokens_of(name);
    const auto phrase = match_phrase(data.category_phrases, data.longest_phrase, name);
    const auto read = read_noun(data, tokens, surroundings, true);
    std::vector<Candidate> found;
    if (!phrase) {
        for (std::size_t i = 0; read && i < read->readings.size() && i < 4; ++i) {
            found.push_back(candidate_of(data, name_trust, *read, i));
            found.back().confidence *= trust_beside(surroundings, read->readings[i]);
        }
        return found;
    }
    if (auto toy = find_toy(data, tokens, *phrase)) return {std::move(*toy)};

    found.push_back(candidate_of(data, name_trust, *phrase));
    const auto overrule_by = [&](const ReadNoun& other, const char* why) {
        found.front().confidence *= overruled;
        found.front().reckoning += why;
        found.push_back(candidate_of(data, name_trust, other, 0));
    };
    if (read && noun_overrules(data, tokens, *phrase, *read)) {
        overrule_by(*read, ", which another noun of the name overrules");
        return found;
    }
    // A "bat" beside the tag "animal", a "crane" as large as a house: tags and size may show that the other meaning is
    // right.
    const OtherMeanings others = other_meanings(data, tokens, *phrase, surroundings);
    if (surroundings.tell() && !others.odds.empty() && others.odds.front() > 1) {
        overrule_by(others.read, ", which what else is known speaks against");
    } else {
        add_other_meanings(data, others, found);
    }
    return found;
}

// Words that turn the name of a thing into the name of its imitation.
constexpr std::array<std::string_view, 6> imitations{"toy", "artificial", "fake", "dummy", "miniature", "imitation"};

bool is_imitation(const std::string& phrase) {
    return std::ranges::any_of(imitations, [&](std::string_view word) {
        return phrase.starts_with(word) && phrase.size() > word.size() && phrase[word.size()] == ' ';
    });
}

// A tag that has the name's own phrase with more words before it ("toy cup" beside the name "cup"), or that says that
// the thing is an imitation ("toy fruit" beside "banana"), says more exactly what the name means.
void prefer_more_exact_tags(const Taxonomy::Data& data, const ModelFacts& facts, std::vector<Candidate>& found) {
    if (found.empty() || found.front().phrase.empty()) return;
    const Candidate named = found.front();
    for (const std::string& tag : facts.tags) {
        const auto match = match_phrase(data.category_phrases, data.longest_phrase, tag);
        if (!match || &data.categories[match->entry] == named.category) continue;
        const bool has_more = match->phrase.ends_with(" " + named.phrase);
        if (!has_more && !(is_imitation(match->phrase) && !is_imitation(named.phrase))) continue;
        Candidate exact = candidate_of(data, tag_trust, *match);
        exact.confidence = named.confidence;
        exact.source += ", more exactly than the name's \"" + named.phrase + "\"";
        found.insert(found.begin(), std::move(exact));
        return;
    }
}

// A stated size that such things never have speaks against the words: a man of 7 cm, a swimming pool in a box. Up to a
// factor 2 outside the usual size changes nothing. Only candidates from `first` on are changed.
void penalize_unusual_sizes(const Taxonomy::Data& data, const ModelFacts& facts, std::vector<Candidate>& found,
                            std::size_t first) {
    constexpr double tolerated = 0.7, strength = 1.5, min_factor = 0.05;
    const double largest = largest_extent(facts);
    if (!facts.size_is_stated || largest <= 0) return;
    for (Candidate& candidate : std::span(found).subspan(first)) {
        const auto model = candidate.category->model_entry;
        const double outside = outside_usual_size(model ? data.categories[*model] : *candidate.category, largest);
        if (outside <= tolerated) continue;
        candidate.confidence *= std::max(std::exp(-strength * (outside - tolerated)), min_factor);
        candidate.reckoning += "; such things have another size";
    }
}

void penalize_long_name(std::vector<Candidate>& found) {
    for (Candidate& candidate : found) {
        candidate.confidence *= trust_in_long;
        candidate.reckoning += "; the name is long, a sales text perhaps";
    }
}

void add_candidate_from_text(const Taxonomy::Data& data, const Trust& trust, std::string_view text,
                             const Surroundings& surroundings, std::vector<Candidate>& found) {
    const std::vector<Token> tokens = tokens_of(text);
    const auto phrase = match_phrase(data.category_phrases, data.longest_phrase, text);
    const bool is_all = phrase && phrase->first == 0 && phrase->end == tokens.size();
    const auto read = is_all ? std::nullopt : read_noun(data, tokens, surroundings, false);
    if (read && (!phrase || noun_overrules(data, tokens, *phrase, *read))) {
        found.push_back(candidate_of(data, trust, *read, 0));
    } else if (phrase) {
        found.push_back(candidate_of(data, trust, *phrase));
    }
}

// Names of the parts' materials say what the parts are made of, and sometimes what they are parts of: "lamp_shade".
void add_candidates_from_parts(const Taxonomy::Data& data, const ModelFacts& facts, const Surroundings& surroundings,
                               std::vector<Candidate>& found) {
    constexpr std::size_t parts_asked = 6;
    for (std::size_t i = 0; i < facts.material_names.size() && i < parts_asked; ++i) {
        const std::string& name = facts.material_names[i];
        if (match_phrase(data.material_phrases, data.longest_phrase, name)) continue;
        add_candidate_from_text(data, part_trust, name, surroundings, found);
    }
}

void add_candidate_from_catalogue(const Taxonomy::Data& data, const std::string& name, std::vector<Candidate>& found) {
    const auto usual = data.by_catalogue.find(stems_of(name));
    if (usual == data.by_catalogue.end()) return;
    const CategoryData& category = data.categories[usual->second];
    found.push_back({.category = &category,
                     .confidence = usual_of_catalogue,
                     .where = category_trust.where,
                     .source = "the catalogue files it under \"" + name + "\"",
                     .synset = category.synset,
                     .reckoning = "only the catalogue's own category tells",
                     .level = level_of(category)});
}

// "deskchair" → "desk chair": splits an unknown word into two known ones, the second as long as possible. With
// `only_end` only the second must be known, and be one of our own words, as in German compounds: "Kaffeetisch" →
// "kaffee tisch". Empty where no word can be split.
std::string with_compounds_split(const Taxonomy::Data& data, const std::vector<Token>& tokens, bool only_end) {
    const auto is_ours = [&](const std::string& word) { return data.category_phrases.contains(singular_of(word)); };
    const auto is_known = [&](const std::string& word) {
        return is_ours(word) || data.nouns->find_inflected(word).has_value();
    };
    const auto can_split = [&](const std::string& begin, const std::string& end) {
        if (only_end) return end.size() >= 4 && is_ours(end);
        // Three letters form a word by chance, so that they must be one of ours: "katana" is no "kat ana".
        return is_known(begin) && is_known(end) && (end.size() >= 4 || is_ours(end));
    };
    std::string text;
    bool any = false;
    for (const Token& token : tokens) {
        text += (text.empty() ? "" : " ") + token.text;
        if (token.text.size() < 6 || is_known(token.text)) continue;
        for (std::size_t cut = 3; cut + 3 <= token.text.size(); ++cut) {
            if (!can_split(token.text.substr(0, cut), token.text.substr(cut))) continue;
            text.insert(text.size() - token.text.size() + cut, " ");
            any = true;
            break;
        }
    }
    return any ? text : std::string();
}

// The name without the words that modelling programs append: "Car_root_node", "chair_mesh", "untitled". These words
// describe the file, not the thing. Unchanged where there are none of them.
std::string without_words_of_tools(const std::string& name) {
    constexpr std::array<std::string_view, 7> tools{"mesh", "scene", "temp", "geo", "untitled", "node", "poly"};
    constexpr std::array<std::string_view, 3> before_them{"root", "low", "high"};  // "root node", "low poly"
    std::vector<Token> tokens = tokens_of(name);
    const std::size_t all = tokens.size();
    const auto ends_in = [&](std::span<const std::string_view> words) {
        return !tokens.empty() && std::ranges::find(words, tokens.back().text) != words.end();
    };
    while (ends_in(tools)) {
        const bool is_second = tokens.back().text == "node" || tokens.back().text == "poly";
        tokens.pop_back();
        if (is_second && ends_in(before_them)) tokens.pop_back();
    }
    if (tokens.size() == all) return name;
    std::string text;
    for (const Token& token : tokens) text += (text.empty() ? "" : " ") + token.text;
    return text;
}

// Candidates from the name, else from the name with its compounds split, with less confidence since the split is a
// guess.
std::vector<Candidate> candidates_from_name_or_compounds(const Taxonomy::Data& data, const std::string& name,
                                                         const Surroundings& surroundings) {
    std::vector<Candidate> found = candidates_from_name(data, name, surroundings);
    for (const bool only_end : {false, true}) {
        if (!found.empty()) break;
        found = candidates_from_name(data, with_compounds_split(data, tokens_of(name), only_end), surroundings);
        for (Candidate& candidate : found) {
            candidate.confidence *= only_end ? trust_in_ending : trust_in_compound;
            candidate.reckoning += only_end ? "; the end of an unknown word" : "; a word taken apart";
        }
    }
    return found;
}

// Whether answer `a` is more exact than `b`: a subcategory of it, or a kind of what it means.
bool is_more_exact(const Taxonomy::Data& data, const Candidate& a, const Candidate& b) {
    if (a.category == b.category) return false;
    if (!a.category->parent.empty() && a.category->parent == b.category->name) return true;
    const auto exact = data.nouns->find_synset(a.category->synset);
    const auto general = data.nouns->find_synset(b.category->synset);
    return exact && general && is_kind_of(*data.nouns, *exact, *general);
}

// Where two sources agree and one is more exact, the more exact answer gets at least the confidence of the other.
void support_each_other(const Taxonomy::Data& data, std::vector<Candidate>& found) {
    constexpr double a_little_more = 1.02;
    for (Candidate& exact : found) {
        for (const Candidate& general : found) {
            const double supported = a_little_more * general.confidence;
            if (exact.where == general.where && exact.where == name_trust.where) continue;
            if (supported <= exact.confidence || supported > 1 || !is_more_exact(data, exact, general)) continue;
            exact.confidence = supported;
            exact.reckoning += "; " + general.where + " agrees (" + general.category->name + ")";
        }
    }
}

// The likeliest candidate first, each category once; the source of the first names the second where its confidence is
// close.
Classification decide(std::vector<Candidate> found) {
    std::ranges::stable_sort(found, std::greater{}, &Candidate::confidence);
    Classification result;
    static_cast<Candidate&>(result) = found.front();
    for (const Candidate& other : found) {
        const auto same = [&](const Candidate& c) { return c.category == other.category; };
        if (!same(result) && std::ranges::none_of(result.others, same)) result.others.push_back(other);
    }
    if (result.others.empty()) return result;
    const Candidate& next = result.others.front();
    if (next.confidence < close_runner_up * result.confidence || are_of_one_family(*next.category, *result.category))
        return result;
    result.source += "; or " + next.category->name + ": " + next.source;
    return result;
}

bool is_said_to_be_made_of(const std::vector<Token>& tokens, std::size_t material) {
    return material > 0 && (tokens[material - 1].text == "aus" || tokens[material - 1].text == "en");
}

bool material_by_words(const Taxonomy::Data& data, const std::string& where, std::string_view text,
                       MaterialChoice& result) {
    // A "door with panes" is not made of glass: only the first part of a name says the material, or the word after one
    // such as "aus": "Tisch aus Holz".
    const auto match = match_phrase(data.material_phrases, data.longest_phrase, text);
    if (!match || (match->segment > 0 && !is_said_to_be_made_of(tokens_of(text), match->first))) return false;
    result = {&data.materials[match->entry], where + " says \"" + match->phrase + "\"", AttributeLevel::model};
    return true;
}

}  // namespace

Classification classify(const Taxonomy::Data& data, const ModelFacts& facts) {
    const Surroundings surroundings(data, facts);
    std::vector<Candidate> found =
        candidates_from_name_or_compounds(data, without_words_of_tools(facts.name), surroundings);
    if (tokens_of(facts.name).size() >= long_name) penalize_long_name(found);

    prefer_more_exact_tags(data, facts, found);
    const std::size_t from_name = found.size();
    penalize_unusual_sizes(data, facts, found, 0);

    // A collection's description was written by somebody who knew what its names mean; the name may still be more
    // exact.
    if (!facts.stated_thing.empty()) {
        add_candidate_from_text(data, collection_trust, facts.stated_thing, surroundings, found);
        support_each_other(data, found);
    } else if (found.empty() || found.front().confidence < name_trust.phrase) {
        for (const std::string& tag : facts.tags) add_candidate_from_text(data, tag_trust, tag, surroundings, found);
        add_candidate_from_text(data, folder_trust, facts.folder, surroundings, found);
        add_candidate_from_catalogue(data, facts.catalogue_category, found);
        add_candidate_from_text(data, category_trust, facts.catalogue_category, surroundings, found);
        if (found.empty()) add_candidates_from_parts(data, facts, surroundings, found);
        penalize_unusual_sizes(data, facts, found, from_name);
        support_each_other(data, found);
    }
    if (found.empty())
        found.push_back({.category = &data.categories[data.unknown],
                         .confidence = nothing_known,
                         .source = "no word of its name, tags or folder is known",
                         .reckoning = "nothing tells"});
    return as_model(data, facts, decide(std::move(found)));
}

double spread_of_steps(std::size_t steps) { return 0.25 * std::sqrt(static_cast<double>(steps)); }

MaterialChoice choose_material(const Taxonomy::Data& data, const ModelFacts& facts, const Classification& what) {
    const MaterialData* usual = data.material(what.category->material);
    MaterialChoice result{usual, "usual for " + what.category->name, what.level};
    const auto& set_by_file = what.category->set_by_file;
    if (const auto file = set_by_file.find("material"); file != set_by_file.end())
        result.source += ", says your " + file->second;
    // Words that name the thing do not say its material: a "paper towel holder" is not made of paper.
    if (material_by_words(data, "name", without_phrase(facts.name, what.phrase), result)) return result;
    for (const std::string& part : facts.material_names) {
        if (material_by_words(data, "part material \"" + part.substr(0, 60) + "\"", part, result)) return result;
    }
    return result;
}

const MaterialData* material_of_part(const Taxonomy::Data& data, const std::string& part) {
    MaterialChoice choice;
    return material_by_words(data, "part material", part, choice) ? choice.material : nullptr;
}

}  // namespace embody::attributes
