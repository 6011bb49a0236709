// SPDX-License-Identifier: MIT
// Results on words that the taxonomy does not have: every entry is hidden in turn, and its first word must lead through
// WordNet to an entry that is left. No measured masses are needed: the hidden entry's own mass is the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "attributes/check.h"
#include "attributes/classify.h"
#include "attributes/form.h"
#include "attributes/mass_estimate.h"
#include "attributes/noun_reading.h"
#include "attributes/sample_facts.h"
#include "attributes/taxonomy_data.h"

namespace embody::attributes {
namespace {

// The taxonomy without one entry; with `family` also without its category and all subcategories of that.
Taxonomy::Data without(const Taxonomy::Data& data, std::size_t entry, bool family) {
    const auto head = [&](std::size_t i) {
        const CategoryData& category = data.categories[i];
        return category.parent.empty() ? category.name : category.parent;
    };
    const auto hidden = [&](std::size_t i) { return i == entry || (family && head(i) == head(entry)); };
    Taxonomy::Data rest = data;
    std::erase_if(rest.category_phrases, [&](const auto& item) { return hidden(item.second.entry); });
    std::erase_if(rest.by_synset, [&](const auto& item) { return hidden(item.second); });
    std::erase_if(rest.by_catalogue, [&](const auto& item) { return hidden(item.second); });
    return rest;
}

// Mass that the category's law gives a thing of this size.
double mass_at(const CategoryData& category, Vec3 size) {
    const auto extent = [&](Vec3 s) {
        const Form form = form_of({.size = s}, s);
        return category.scaling == MassScaling::area ? form.face_area : form.box_volume;
    };
    return category.mass.typical * std::pow(extent(size) / extent(category.at_size), mass_exponent(category));
}

bool is_general(const CategoryData& category) { return category.domain == "general"; }

struct Score {
    int words = 0, right = 0, judged = 0, covered = 0;
    double error = 0, confidence = 0;

    void add(const Taxonomy::Data& rest, const CategoryData& hidden, const Classification& what) {
        ++words;
        const double miss = std::log(mass_at(*what.category, hidden.at_size) / hidden.mass.typical);
        error += std::fabs(miss);
        const Interval& mass = what.category->mass;
        const double low = std::log(mass.typical / mass.low), high = std::log(mass.high / mass.typical);
        const double more = 1.2816 * spread_of_steps(what.steps);
        covered += miss < 0 ? -miss <= std::hypot(high, more) : miss <= std::hypot(low, more);

        // A reading is right if its meaning is the hidden entry's own or related to it, or a category above it.
        const auto meant = rest.nouns->find_synset(hidden.synset);
        const auto read = rest.nouns->find_synset(what.synset);
        const auto above = rest.nouns->find_synset(what.category->synset);
        if (!meant || !read || !above) return;
        ++judged;
        confidence += what.confidence;
        right += is_kind_of(*rest.nouns, *meant, *above) || common_content(*rest.nouns, *meant, *read) > 0.45;
    }
};

// Score over entries whose word only WordNet knows once they are hidden.
Score score_of_hidden_entries(bool family, std::size_t every) {
    const Taxonomy::Data& data = shipped_taxonomy().data();
    Score score;
    for (std::size_t i = 0; i < data.categories.size(); i += every) {
        const CategoryData& hidden = data.categories[i];
        if (hidden.words.empty() || is_general(hidden)) continue;
        const Taxonomy::Data rest = without(data, i, family);
        const Classification what = classify(rest, named(hidden.words.front(), hidden.at_size));
        const bool by_wordnet = what.source.find("→") != std::string::npos;
        if (by_wordnet || what.level == AttributeLevel::standard) score.add(rest, hidden, what);
    }
    const double words = score.words, judged = score.judged;
    std::printf("%d words, mean |ln mass ratio| %.3f, in the interval %.0f %%; right %.0f %%, confidence %.0f %%\n",
                score.words, score.error / words, 100 * score.covered / words, 100 * score.right / judged,
                100 * score.confidence / judged);
    return score;
}

void expect_good(const Score& score, double error) {
    EXPECT_GT(score.words, 200);
    EXPECT_LT(score.error / score.words, error);
    // The interval holds 80 % of things; here the truth is the typical value of a category, so that the fraction is
    // larger.
    EXPECT_GT(score.covered, 0.75 * score.words);
    EXPECT_LT(score.covered, 0.92 * score.words);
    // The confidence is a probability, and rather too low than too high.
    EXPECT_GT(score.right, score.confidence);
    EXPECT_LT(score.right, score.confidence + 0.25 * score.judged);
}

TEST(UnseenWords, FindTheirMassWithinAFactorOfTwoOnAverage) { expect_good(score_of_hidden_entries(false, 1), 0.8); }
TEST(UnseenWords, AlsoWhereTheirWholeFamilyIsUnseen) { expect_good(score_of_hidden_entries(true, 3), 0.95); }

TEST(UnseenWords, ClassifyingIsFreeOfLuck) {
    // The same words, asked twice and in another taxonomy object, get bitwise the same answer.
    const Taxonomy::Data& data = shipped_taxonomy().data();
    const Taxonomy::Data copy = data;
    for (const char* name :
         {"samovar", "sextant", "soup tureen", "crane", "bassoon", "mandolin with case", "hourglass"}) {
        const Classification a = classify(data, named(name)), b = classify(copy, named(name));
        EXPECT_EQ(a.source, b.source);
        EXPECT_EQ(a.confidence, b.confidence);
        EXPECT_EQ(a.category->name, b.category->name);
    }
}

TEST(UnseenWords, EveryNounGivesASetThatHoldsTogether) {
    const wordnet::NounTable& nouns = *shipped_taxonomy().data().nouns;
    int above_default = 0, asked = 0;
    for (wordnet::LemmaIndex i = 0; i < nouns.lemma_count(); i += 97) {
        std::string name(nouns.text(i));
        std::ranges::replace(name, '_', ' ');
        const double size = 0.02 * std::pow(1.5, asked % 17);
        const ModelFacts facts =
            asked % 2 == 0 ? named(name, {size, size / 2, size}) : closed_box(name, {size, size, size});
        const AttributeSet set = resolve(shipped_taxonomy(), facts);
        for (const Issue& issue : check(set, facts))
            ADD_FAILURE() << name << ": " << issue.attribute << " " << issue.why;
        above_default += set.find("category")->level > AttributeLevel::standard;
        ++asked;
    }
    // About three in five nouns mean a physical thing.
    EXPECT_GT(above_default, asked / 2);
}

TEST(GeneralEntries, HoldWhatLiesBelowThem) {
    // An inner node with at least ten entries below it: most of them have a mass within its interval, and the typical
    // mass is at most a factor 2.5 off.
    const Taxonomy::Data& data = shipped_taxonomy().data();
    int checked = 0;
    for (const CategoryData& general : data.categories) {
        const auto node = data.nouns->find_synset(general.synset);
        if (!is_general(general) || !node || general.model_entry) continue;
        int below = 0, inside = 0;
        double bias = 0;
        for (const CategoryData& entry : data.categories) {
            const auto meaning = data.nouns->find_synset(entry.synset);
            if (is_general(entry) || !meaning || !is_kind_of(*data.nouns, *meaning, *node)) continue;
            if (entry.model_entry)
                continue;  // a model of beer is a bottle: the substance's own mass is not that of a model
            const double miss = std::log(entry.mass.typical / mass_at(general, entry.at_size));
            ++below;
            bias += miss;
            inside += miss < 0 ? -miss <= std::log(general.mass.typical / general.mass.low)
                               : miss <= std::log(general.mass.high / general.mass.typical);
        }
        if (below < 10) continue;
        ++checked;
        EXPECT_LT(std::fabs(bias / below), std::log(2.5)) << general.name << ": " << below << " entries below it";
        EXPECT_GT(inside, 0.55 * below) << general.name << ": " << below << " entries below it";
    }
    EXPECT_GT(checked, 10);
}

}  // namespace
}  // namespace embody::attributes
