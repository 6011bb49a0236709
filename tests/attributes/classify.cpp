// SPDX-License-Identifier: MIT
#include "attributes/classify.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "attributes/check.h"
#include "attributes/noun_reading.h"
#include "attributes/physical_kind.h"
#include "attributes/sample_facts.h"

namespace embody::attributes {
namespace {

// A taxonomy of a few meanings, so that the path through WordNet is tested and not the table of categories.
const Taxonomy& small_taxonomy() {
    static const std::unique_ptr<Taxonomy> taxonomy = [] {
        const auto folder = std::filesystem::temp_directory_path() / ("embody_classify_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder / "categories");
        std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
        std::ofstream(folder / "materials.json") << R"({"materials": [
            {"name": "generic", "words": [], "density": [500, 1000, 3000], "friction_static": [0.1, 0.2, 0.3],
             "friction_dynamic": [0.1, 0.2, 0.3], "friction_rolling": 0, "restitution": [0, 0.1, 0.2], "source": "s"},
            {"name": "wood", "words": ["oak"], "density": [400, 600, 800], "friction_static": [0.1, 0.2, 0.3],
             "friction_dynamic": [0.1, 0.2, 0.3], "friction_rolling": 0, "restitution": [0, 0.1, 0.2], "source": "s"}]})";
        std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
        const auto entry = [](const std::string& name, const std::string& synset, const std::string& words, double low,
                              double high) {
            const std::string size = std::to_string(std::sqrt(low * high));
            return R"({"name": ")" + name + R"(", "synset": ")" + synset + R"(", "words": [)" + words +
                   R"(], "kind": "rigid", "placement": "floor", "movable": true, "mass": [1, 2, 3], "at_size": [)" +
                   size + "," + size + "," + size + R"(], "usual_size": [)" + std::to_string(low) + "," +
                   std::to_string(high) + R"(], "material": "generic", "source": "s"})";
        };
        std::ofstream(folder / "categories" / "kitchen.json")
            << R"({"categories": [)" + entry("container", "container.n.01", "", 0.05, 2) + "," +
                   entry("dish", "dish.n.01", R"("dish")", 0.05, 0.6) + "," +
                   entry("wine", "wine.n.01", R"("wine")", 0.05, 0.5) + "]}";
        std::ofstream(folder / "categories" / "music.json")
            << R"({"categories": [)" + entry("instrument", "musical_instrument.n.01", "", 0.1, 3) + "," +
                   entry("bird", "bird.n.01", R"("bird")", 0.05, 1.5) + "," +
                   entry("machine", "device.n.01", "", 3, 60) + "," + entry("pig", "swine.n.01", R"("pig")", 0.5, 2) +
                   "," + entry("rodent", "rodent.n.01", "", 0.05, 0.5) + "," +
                   entry("seat", "seat.n.03", R"("seat", "sofa")", 0.3, 3) + "," +
                   entry("object", "object.n.01", "", 0.01, 30) +
                   R"(, {"name": "beer", "synset": "beer.n.01", "words": ["beer"], "kind": "fluid", "placement": "free",
                         "movable": true, "mass": [0.9, 1, 1.1], "at_size": [0.1, 0.1, 0.1], "usual_size": [0.01, 5],
                         "material": "generic", "modelled_as": "container", "source": "s"}]})";
        auto loaded = Taxonomy::load(folder);
        std::filesystem::remove_all(folder);
        EXPECT_TRUE(loaded.ok()) << loaded.error().message();
        return std::move(*loaded);
    }();
    return *taxonomy;
}

ModelFacts unsized(std::string name) {
    ModelFacts facts;
    facts.name = std::move(name);
    return facts;
}
Classification taken(const ModelFacts& facts) { return classify(small_taxonomy().data(), facts); }
std::string category_of(std::string name) { return taken(unsized(std::move(name))).category->name; }

TEST(Classify, AnUnknownWordClimbsToTheNearestCategory) {
    const Classification what = taken(unsized("Tureen"));
    EXPECT_EQ(what.category->name, "dish");
    EXPECT_EQ(what.synset, "tureen.n.01");
    EXPECT_EQ(what.steps, 2u);
    EXPECT_EQ(what.source, "name says \"tureen\" → tureen.n.01 → dish.n.01 (2 steps up)");
    EXPECT_LT(what.confidence, taken(unsized("dish")).confidence);
    // More steps, less confidence.
    EXPECT_GT(what.confidence, taken(unsized("sarcophagus")).confidence);
    EXPECT_EQ(category_of("sarcophagus"), "container");
}

TEST(Classify, TheTaxonomysOwnWordNeedsNoWordNet) {
    const Classification what = taken(unsized("dish"));
    EXPECT_EQ(what.steps, 0u);
    EXPECT_EQ(what.source, "name says \"dish\"");
    EXPECT_EQ(what.confidence, 0.95);
}

TEST(Classify, WordsOfNoMeaningStayUnknown) {
    for (const char* name : {"", "qwzx", "12345", "of with", "idea", "X", "Z80"}) {
        const Classification what = taken(unsized(name));
        EXPECT_EQ(what.category->name, "object") << name;
        EXPECT_EQ(what.level, AttributeLevel::standard) << name;
        EXPECT_LT(what.confidence, 0.1) << name;
    }
}

TEST(Classify, PluralsCompoundsAndHyphensAreFound) {
    EXPECT_EQ(category_of("Tureens"), "dish");
    EXPECT_EQ(category_of("geese"), "bird");
    EXPECT_EQ(category_of("soup-tureen"), "dish");
    EXPECT_EQ(category_of("jew's harp"), "instrument");
    EXPECT_EQ(category_of("winetureen"), "dish");
}

TEST(Classify, TheLastNounOfTheFirstPartIsWhatTheNameIsAbout) {
    // A modifier that the taxonomy knows does not decide …
    EXPECT_EQ(category_of("wine decanter"), "container");
    EXPECT_EQ(category_of("guinea pig"), "rodent");
    EXPECT_EQ(category_of("trombone with seat"), "instrument");
    // … nor does a following adjective, material, name or separated part.
    EXPECT_EQ(category_of("sofa classic"), "seat");
    EXPECT_EQ(category_of("sofa oak"), "seat");
    EXPECT_EQ(category_of("sofa Oslo"), "seat");
    EXPECT_EQ(category_of("seat with trombone"), "seat");
    // A noun that says less than the phrase.
    EXPECT_EQ(category_of("bird animal"), "bird");
}

TEST(Classify, WhatElseIsKnownChoosesTheSense) {
    ModelFacts facts = unsized("crane");
    facts.tags = {"animal"};
    EXPECT_EQ(taken(facts).category->name, "bird");
    facts.tags = {"engine"};
    EXPECT_EQ(taken(facts).category->name, "machine");

    // The size: no bird stands twenty metres high, and no crane for loads a metre.
    facts.tags.clear();
    facts.size_is_stated = true;
    facts.geometry.size = {12, 20, 3};
    EXPECT_EQ(taken(facts).category->name, "machine");
    facts.geometry.size = {0.3, 0.9, 0.4};
    EXPECT_EQ(taken(facts).category->name, "bird");
}

TEST(Classify, AmbiguityIsReported) {
    const Classification crane = taken(unsized("crane"));
    ASSERT_FALSE(crane.others.empty());
    EXPECT_LT(crane.confidence, 0.9 * std::pow(0.93, crane.steps));
    for (const Candidate& other : crane.others) EXPECT_LE(other.confidence, crane.confidence);
    // A word with only one meaning leaves no doubt.
    EXPECT_TRUE(taken(unsized("tureen")).others.empty());
    // The source names a runner-up that is close.
    ModelFacts facts = unsized("tureen");
    facts.tags = {"seat"};
    EXPECT_NE(taken(facts).source.find("; or dish: name says \"tureen\" → "), std::string::npos) << taken(facts).source;
}

TEST(Classify, ATagMakesAGeneralAnswerMoreExactAndOverrulesWhatSharesNothingWithIt) {
    // Sarcophagus is three steps below container; a dish is a container, so the tag only makes that more exact.
    ModelFacts facts = unsized("sarcophagus");
    facts.tags = {"dish"};
    EXPECT_EQ(taken(facts).category->name, "dish");
    EXPECT_NE(taken(facts).reckoning.find("name agrees (container)"), std::string::npos);
    // A name may be a brand: "Trombone" in the catalogue's category of seats is a seat; in that of instruments it is a
    // trombone.
    facts.name = "Trombone";
    facts.tags = {"seat"};
    EXPECT_EQ(taken(facts).category->name, "seat");
    facts.tags = {"instrument"};
    EXPECT_EQ(taken(facts).category->name, "instrument");
}

TEST(Classify, PartsAreAskedLast) {
    ModelFacts facts = unsized("qwzx 17");
    facts.material_names = {"Oak", "Oak tureen"};
    EXPECT_EQ(taken(facts).category->name, "object");  // the name of a material is no thing
    facts.material_names = {"Oak", "tureen_2"};
    EXPECT_EQ(taken(facts).category->name, "dish");
    EXPECT_LT(taken(facts).confidence, 0.3);
    facts.folder = "music/trombones";
    EXPECT_EQ(taken(facts).category->name, "instrument");
}

TEST(Classify, ASalesTextIsTrustedLessThanATag) {
    ModelFacts facts = named("Shiny blue dish");
    facts.tags = {"seat"};
    EXPECT_EQ(taken(facts).category->name, "dish");
    facts.name = "Shiny large blue extra strong washable kitchen family dish";
    EXPECT_EQ(taken(facts).category->name, "seat");
    facts.tags.clear();
    EXPECT_EQ(taken(facts).category->name, "dish");
}

TEST(Classify, AToyOfSomethingIsAToy) {
    const auto name_of = [](const char* name) {
        return classify(shipped_taxonomy().data(), named(name, {0.3, 0.4, 0.2})).category->name;
    };
    EXPECT_EQ(name_of("toy lawn mower"), "toy");
    EXPECT_EQ(name_of("pretend vacuum cleaner"), "toy");
    EXPECT_EQ(name_of("toy car"), "toy car");
    EXPECT_EQ(name_of("lawn mower"), "lawn mower");
}

TEST(Classify, StepsWidenTheMassAndLowerTheConfidence) {
    const auto ratio = [](const AttributeSet& set) {
        const AttributeEntry* mass = set.find("mass");
        return *mass->high / *mass->low;
    };
    const AttributeSet near = resolve(small_taxonomy(), named("dish"));
    const AttributeSet far = resolve(small_taxonomy(), named("tureen"));
    // Independent spreads add as squares, like errors; the entry's own interval is asymmetric: [1, 2, 3] around 2, and
    // the taxonomy's spread is 0.1.
    const double expected = std::hypot(std::log(2), 1.2816 * 0.1) + std::hypot(std::log(1.5), 1.2816 * 0.1);
    EXPECT_NEAR(std::log(ratio(near)), expected, 1e-9);
    EXPECT_GT(ratio(far), 1.2 * ratio(near));
    EXPECT_EQ(far.word("synset", ""), "tureen.n.01");
    EXPECT_LT(far.number("category_confidence", 1), near.number("category_confidence", 0));
    EXPECT_FALSE(far.find("category_confidence")->source.empty());
    EXPECT_TRUE(check(far, named("tureen")).empty());
}

TEST(Classify, AccentsAndOtherLanguagesWordsOfTheTaxonomyAreFound) {
    const Taxonomy::Data& data = shipped_taxonomy().data();
    const auto category = [&](const char* name) { return classify(data, unsized(name)).category->name; };
    EXPECT_EQ(category("Po\xC3\xAAle"), category("frying pan"));
    EXPECT_NE(classify(data, unsized("Cuill\xC3\xA8re")).level, AttributeLevel::standard);
    EXPECT_EQ(category("Stuhl"), category("chair"));
    // The words before the preposition, and the end of a compound, name the thing.
    EXPECT_EQ(category("Table en verre"), category("table"));
    EXPECT_EQ(category("Chaise d'angle"), category("chair"));
    EXPECT_EQ(category("Tisch mit Lampe"), category("table"));
    EXPECT_EQ(category("Kaffeetisch"), category("table"));
    EXPECT_EQ(category("Gie\xC3\x9F"
                       "kanne"),
              category("watering can"));
    EXPECT_EQ(category("pomme de terre"), category("potato"));
    EXPECT_EQ(category("Zange"), category("pliers"));
    EXPECT_LT(classify(data, unsized("Kaffeetisch")).confidence, classify(data, unsized("Tisch")).confidence);
    // The material follows "aus" and "en".
    EXPECT_EQ(resolve(shipped_taxonomy(), named("Table en verre")).word("surface_material", ""), "glass");
}

TEST(Classify, AWordOfASubstanceIsTheSubstanceAndAModelOfItWhatItComesIn) {
    const auto found = [](const ModelFacts& facts) { return classify(small_taxonomy().data(), facts); };
    const auto model = [](const std::string& name, Vec3 size) {
        ModelFacts facts = unsized(name);
        facts.geometry.size = size;
        return facts;
    };
    constexpr Vec3 of_a_bottle{0.07, 0.25, 0.07};
    EXPECT_EQ(found(unsized("beer")).category->name, "beer");
    EXPECT_EQ(kind_of(resolve(small_taxonomy(), unsized("beer"))), PhysicalKind::fluid);

    const Classification as_model = found(model("beer", of_a_bottle));
    EXPECT_EQ(as_model.category->name, "container");
    EXPECT_EQ(as_model.source, "name says \"beer\"; a model of beer is usually \"container\"");
    EXPECT_EQ(kind_of(resolve(small_taxonomy(), model("beer", of_a_bottle))), PhysicalKind::rigid);
    // The same for a word that only WordNet knows; and the word keeps its own meaning.
    EXPECT_EQ(found(unsized("lager")).category->name, "beer");
    EXPECT_EQ(found(model("lager", of_a_bottle)).category->name, "container");
    EXPECT_EQ(found(model("lager", of_a_bottle)).synset, "lager.n.02");

    // In bulk it stays the substance: by its name, or by a stated size that no bottle has.
    for (const char* name : {"spilled beer", "beer, poured"})
        EXPECT_EQ(found(model(name, of_a_bottle)).category->name, "beer") << name;
    ModelFacts lake = model("beer", {9, 0.2, 9});
    EXPECT_EQ(found(lake).category->name, "container");  // 9 mm?
    lake.size_is_stated = true;
    EXPECT_EQ(found(lake).category->name, "beer");
}

TEST(NounReading, KinshipIsThatOfMeanings) {
    const wordnet::NounTable& nouns = *small_taxonomy().data().nouns;
    const auto synset = [&](const char* name) { return *nouns.find_synset(name); };
    const double cups = common_content(nouns, synset("cup.n.01"), synset("mug.n.04"));
    EXPECT_GT(cups, common_content(nouns, synset("cup.n.01"), synset("chair.n.01")));
    EXPECT_EQ(cups, common_content(nouns, synset("mug.n.04"), synset("cup.n.01")));
    EXPECT_NEAR(common_content(nouns, synset("cup.n.01"), synset("idea.n.01")), 0, 1e-12);
    EXPECT_EQ(common_content(nouns, synset("tureen.n.01"), synset("tureen.n.01")), 1);
    EXPECT_TRUE(is_kind_of(nouns, synset("tureen.n.01"), synset("container.n.01")));
    EXPECT_FALSE(is_kind_of(nouns, synset("container.n.01"), synset("tureen.n.01")));
}

TEST(Classify, AnotherMeaningOfAWordOfTheTaxonomyIsToldWithIt) {
    const auto answers = [](std::string name) {
        const Classification what = classify(shipped_taxonomy().data(), named(std::move(name)));
        std::vector<std::string> synsets;
        for (const Candidate& other : what.others) {
            synsets.push_back(other.synset);
            EXPECT_LT(other.confidence, what.confidence);
        }
        return std::pair(what, synsets);
    };
    const auto [bat, others] = answers("bat");
    EXPECT_EQ(bat.category->name, "baseball bat");
    EXPECT_TRUE(std::ranges::find(others, "bat.n.01") != others.end()) << "the animal";
    EXPECT_NE(bat.source.find("it may also mean bat.n.01"), std::string::npos) << bat.source;
    const auto of_mouse = answers("mouse").second;
    EXPECT_TRUE(std::ranges::find(of_mouse, "mouse.n.01") != of_mouse.end());
    // A word with only one meaning adds nothing.
    EXPECT_TRUE(answers("sofa").second.empty());
}

TEST(Classify, WordsOfModellingProgramsSayNothingOfTheThing) {
    const auto category = [](const char* name) {
        return classify(shipped_taxonomy().data(), named(name)).category->name;
    };
    for (const char* name : {"root_node", "mesh", "low_poly", "temp", "untitled", "Scene"})
        EXPECT_EQ(category(name), "object") << name;
    EXPECT_EQ(category("Car_root_node"), category("car"));
    EXPECT_EQ(category("chair_low_poly_mesh"), category("chair"));
    EXPECT_EQ(category("mesh chair"), "office chair") << "what it is made of, not how";
}

}  // namespace
}  // namespace embody::attributes
