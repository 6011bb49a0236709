// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "attributes/check.h"
#include "attributes/phrase_match.h"
#include "attributes/sample_facts.h"
#include "attributes/taxonomy_data.h"
#include "attributes/words.h"

namespace embody::attributes {
namespace {

constexpr const char* materials = R"({"materials": [{"name": "generic", "words": [], "density": [1, 2, 3],
    "friction_static": [0.1, 0.2, 0.3], "friction_dynamic": [0.1, 0.2, 0.3], "friction_rolling": 0,
    "restitution": [0, 0.1, 0.2], "source": "s"}]})";

std::string category(const std::string& name, const std::string& words, const std::string& more = "") {
    return R"({"name": ")" + name + R"(", "words": )" + words +
           R"(, "kind": "rigid", "placement": "floor", "movable": true, "mass": [1, 2, 3], "at_size": [1, 1, 1],
              "usual_size": [0.1, 2], "material": "generic", "source": "s")" +
           more + "}";
}

// Loads the two texts from a folder of their own; returns the message of the error, or "".
std::string load_error(const std::string& materials_text, const std::string& taxonomy_text) {
    const auto folder = std::filesystem::temp_directory_path() / ("embody_taxonomy_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "categories");
    std::ofstream(folder / "materials.json") << materials_text;
    std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
    std::ofstream(folder / "categories" / "things.json") << taxonomy_text;
    const auto loaded = Taxonomy::load(folder);
    std::filesystem::remove_all(folder);
    return loaded ? "" : loaded.error().message();
}
std::string load_error(const std::string& categories) {
    return load_error(materials, R"({"categories": [)" + category("object", "[]") + ", " + categories + "]}");
}

TEST(TaxonomyLoad, NamesFileEntryAndField) {
    EXPECT_FALSE(Taxonomy::load("/nowhere").ok());
    EXPECT_NE(load_error("{", "{}").find("materials.json"), std::string::npos);
    EXPECT_NE(load_error(materials, "[1").find("things.json"), std::string::npos);
    EXPECT_EQ(load_error(materials, "{}"), "things.json.categories: is missing");
    EXPECT_EQ(load_error(R"({"name": "a"})"), "things.json: categories[1].words: is missing");
    EXPECT_EQ(load_error("7"), "things.json: categories[1]: must be an object {…}, got a number");
    const std::string unknown = load_error(category("a", R"(["a"])", R"(, "movble": true)"));
    EXPECT_EQ(unknown, "things.json: categories[1].movble: is not a field here (did you mean \"movable\"?)");
}

TEST(TaxonomyLoad, RefusesImpossibleValues) {
    const auto with = [](const std::string& field, const std::string& value) {
        return load_error(category("a", R"(["a"])",
                                   ", \"subcategories\": [{\"name\": \"b\", \"words\": [], \"source\": \"s\", "
                                   "\"at_size\": [1, 1, 1], \"" +
                                       field + "\": " + value + "}]"));
    };
    EXPECT_NE(with("mass", "[3, 2, 1]").find("ascending"), std::string::npos);
    EXPECT_NE(with("mass", "[0, 1, 2]").find("mass[0]: must be from 1e-05 to 1000000.0, got 0"), std::string::npos);
    EXPECT_NE(with("mass", "[1, 2]").find("must be 3 numbers"), std::string::npos);
    EXPECT_NE(with("kind", "\"solid\"").find("must be one of"), std::string::npos);
    EXPECT_NE(with("kind", "\"static\"").find("movable"), std::string::npos);
    EXPECT_NE(with("placement", "\"moon\"").find("must be one of"), std::string::npos);
    EXPECT_NE(with("material", "\"cheese\"").find("materials.json has no"), std::string::npos);
    EXPECT_NE(with("mass_grows_with", "\"age\"").find("volume or area"), std::string::npos);
    EXPECT_NE(with("solid", "true").find("fill_fraction"), std::string::npos);
    EXPECT_EQ(with("exponent", "1"), "");
}

TEST(TaxonomyLoad, EveryPhraseBelongsToOneEntry) {
    EXPECT_NE(load_error(category("a", R"(["x y"])") + "," + category("b", R"(["X-Y"])")).find("belongs to another"),
              std::string::npos);
    EXPECT_NE(load_error(category("a", R"(["x"])") + "," + category("a", R"(["y"])")).find("is there already"),
              std::string::npos);
    EXPECT_NE(load_error(category("a", R"(["--"])")).find("is empty"), std::string::npos);
}

TEST(TaxonomyLoad, SynsetsAreThoseOfWordNet) {
    EXPECT_EQ(load_error(category("a", R"(["a"])", R"(, "synset": "chair.n.01")")), "");
    const std::string why = load_error(category("a", R"(["a"])", R"(, "synset": "chiar.n.01")"));
    EXPECT_NE(why.find("things.json: categories[1].synset: WordNet 3.0 has no noun \"chiar.n.01\""), std::string::npos);
    EXPECT_NE(why.find("or leave it out"), std::string::npos);
}

TEST(TaxonomyLoad, ABrokenTableOfWordNetBesideTheTaxonomyIsNamed) {
    const auto folder = std::filesystem::temp_directory_path() / ("embody_words_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "categories");
    std::ofstream(folder / "materials.json") << materials;
    std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
    std::ofstream(folder / "categories" / "a.json") << R"({"categories": [)" + category("object", "[]") + "]}";
    std::ofstream(folder / "wordnet-nouns.table") << "cut off";
    const auto loaded = Taxonomy::load(folder);
    std::filesystem::remove_all(folder);
    ASSERT_FALSE(loaded.ok());
    EXPECT_NE(loaded.error().where.find("wordnet-nouns.table"), std::string::npos);
    EXPECT_FALSE(loaded.error().remedy.empty());
}

TEST(TaxonomyLoad, OfTwoEntriesWithOneMeaningTheMoreGeneralIsFound) {
    const auto folder = std::filesystem::temp_directory_path() / ("embody_twice_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "categories");
    std::ofstream(folder / "materials.json") << materials;
    std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
    const std::string sub = R"(, "subcategories": [{"name": "stool", "synset": "chair.n.01", "words": []}])";
    std::ofstream(folder / "categories" / "a.json")
        << R"({"categories": [)" + category("object", "[]") + "," + category("first", "[]", sub) + "," +
               category("general", "[]", R"(, "synset": "chair.n.01")") + "," +
               category("later", "[]", R"(, "synset": "chair.n.01")") + "]}";
    const auto loaded = Taxonomy::load(folder);
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message();
    const Taxonomy::Data& data = (*loaded)->data();
    const auto found = data.by_synset.find(*data.nouns->find_synset("chair.n.01"));
    ASSERT_NE(found, data.by_synset.end());
    EXPECT_EQ(data.categories[found->second].name, "general");
    EXPECT_EQ(data.categories[found->second].domain, "a");
}

TEST(TaxonomyLoad, OnlyASubstanceIsModelledAsSomethingElseThatIsThere) {
    const auto substance = [](const std::string& kind, const std::string& modelled_as) {
        std::string entry = category("beer", R"(["beer"])", R"(, "modelled_as": ")" + modelled_as + "\"");
        return load_error(entry.replace(entry.find("\"rigid\""), 7, "\"" + kind + "\"") + ", " +
                          category("bottle", R"(["bottle"])"));
    };
    EXPECT_EQ(substance("fluid", "bottle"), "");
    EXPECT_EQ(substance("granular", "bottle"), "");
    EXPECT_EQ(substance("cloth", "bottle"), "");
    EXPECT_EQ(substance("soft", "bottle"),
              "things.json: categories[1].modelled_as: is for the kinds fluid, granular, cloth and rope; this is soft");
    EXPECT_EQ(
        substance("fluid", "jug"),
        "things.json: \"beer\".modelled_as: there is no entry \"jug\" (give the name of a category or subcategory)");
    EXPECT_NE(substance("fluid", "beer").find("\"beer\" has no form of its own either"), std::string::npos);
}

TEST(TaxonomyLoad, NumbersNeedASource) {
    const std::string sub =
        R"(, "subcategories": [{"name": "b", "words": [], "mass": [1, 2, 3], "at_size": [1, 1, 1]}])";
    // The source of the category does not hold for the subcategory's numbers.
    EXPECT_EQ(load_error(category("a", R"(["a"])", sub)),
              "things.json: categories[1].subcategories[0].source: is missing");
}

TEST(TaxonomyLoad, AttributesAreNumbersOfTheRegistryThatTheKindHas) {
    const auto with = [](const std::string& kind, const std::string& attributes) {
        return load_error(category("a", R"(["a"])",
                                   ", \"subcategories\": [{\"name\": \"b\", \"words\": [], \"kind\": \"" + kind +
                                       "\", \"attributes\": {" + attributes + "}}]"));
    };
    EXPECT_EQ(with("soft", R"("youngs_modulus": {"value": [1e4, 2e4, 3e4], "source": "s"})"), "");
    EXPECT_NE(with("rigid", R"("youngs_modulus": {"value": [1e4, 2e4, 3e4], "source": "s"})").find("the kind rigid"),
              std::string::npos);
    EXPECT_NE(with("soft", R"("stiffness": {"value": [1, 2, 3], "source": "s"})").find("no number of this name"),
              std::string::npos);
    EXPECT_NE(with("soft", R"("collision_shape": {"value": [1, 2, 3], "source": "s"})").find("no number of this name"),
              std::string::npos);
    EXPECT_NE(with("soft", R"("youngs_modulus": {"value": [1, 2e4, 3e4], "source": "s"})")
                  .find("youngs_modulus.value[0]: must be from"),
              std::string::npos);
    EXPECT_NE(with("soft", R"("youngs_modulus": {"value": [1e4, 2e4, 3e4]})").find("source: is missing"),
              std::string::npos);
    EXPECT_NE(with("soft", R"("youngs_modulus": 7)").find("must be an object"), std::string::npos);
}

TEST(TaxonomyLoad, WhatACategorySaysReachesTheSetWithItsSource) {
    const auto folder = std::filesystem::temp_directory_path() / ("embody_usual_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder / "categories");
    std::ofstream(folder / "materials.json") << materials;
    std::ofstream(folder / "material_pairs.json") << R"({"families": [], "pairs": []})";
    std::ofstream(folder / "categories" / "a.json") << R"({"categories": [)" + category("object", "[]") + "]}";
    std::ofstream(folder / "categories" / "b.json")
        << R"({"categories": [{"name": "cushion", "synset": "cushion.n.03", "words": ["cushion"], "kind": "soft",
               "placement": "floor", "movable": true, "mass": [1, 2, 3], "at_size": [1, 1, 1], "usual_size": [0.1, 2],
               "material": "generic", "source": "s",
               "attributes": {"youngs_modulus": {"value": [1e4, 2e4, 3e4], "source": "a handbook"}}}]})";
    const auto taxonomy = Taxonomy::load(folder);
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(taxonomy) << taxonomy.error().message();
    const AttributeSet set = resolve(**taxonomy, named("red cushion", {0.4, 0.1, 0.4}));
    EXPECT_EQ(set.word("synset", ""), "cushion.n.03");
    const AttributeEntry* modulus = set.find("youngs_modulus");
    ASSERT_NE(modulus, nullptr);
    EXPECT_EQ(std::get<double>(modulus->value), 2e4);
    EXPECT_EQ(modulus->low, 1e4);
    EXPECT_EQ(modulus->high, 3e4);
    EXPECT_EQ(modulus->source, "cushion: a handbook");
    EXPECT_EQ(modulus->level, AttributeLevel::category);
}

TEST(ShippedTaxonomy, EveryEntryGivesASetThatHoldsTogether) {
    const Taxonomy::Data& data = shipped_taxonomy().data();
    EXPECT_GE(data.categories.size(), 128u);
    EXPECT_GE(data.materials.size(), 25u);
    for (const CategoryData& category : data.categories) {
        EXPECT_FALSE(category.source.empty()) << category.name;
        // A typical piece is in the category's usual range, and no solid is denser than its material.
        const Vec3 s = category.at_size;
        const double largest = std::max({s.x, s.y, s.z});
        EXPECT_GE(largest, category.usual_low) << category.name;
        EXPECT_LE(largest, category.usual_high) << category.name;
        if (category.words.empty()) continue;
        const auto found = [](const AttributeSet& of) {
            const std::string subcategory = of.word("subcategory", "");
            return subcategory.empty() ? of.word("category", "") : subcategory;
        };
        ModelFacts word;
        word.name = category.words.front();
        EXPECT_EQ(found(resolve(shipped_taxonomy(), word)), category.name);
        const ModelFacts facts = named(category.words.front(), s);
        const AttributeSet set = resolve(shipped_taxonomy(), facts);
        // The first word may say bulk ("milk liquid"): then a model is the substance too.
        const bool is_other = category.model_entry && found(set) != category.name;
        EXPECT_EQ(found(set), is_other ? data.categories[*category.model_entry].name : category.name);
        for (const Issue& issue : check(set, facts))
            ADD_FAILURE() << category.name << " " << issue.attribute << " " << issue.why;
        if (const AttributeEntry* mass = set.find("mass"); mass != nullptr && !is_other) {
            EXPECT_NEAR(std::get<double>(mass->value), category.mass.typical, 1e-9 * category.mass.typical)
                << category.name;
        }
    }
}

TEST(Words, SplitsNamesAsPeopleWriteThem) {
    const auto joined = [](std::string_view text) {
        std::string all;
        for (const Token& token : tokens_of(text)) all += token.stem + std::to_string(token.segment) + " ";
        return all;
    };
    EXPECT_EQ(joined("bedsideTable_140x190"), "bedside0 table0 1401 x1 1902 ");
    EXPECT_EQ(joined("Chairs with Cushions"), "chair0 with1 cushion1 ");
    EXPECT_EQ(joined("Frame H\xC3\xB4i An (captain's)"), "frame0 hoi0 an0 ,1 captain1 ,2 ");
    EXPECT_EQ(joined("iPhone"), "iphone0 ");
    EXPECT_EQ(joined(""), "");
    EXPECT_EQ(joined("\xC3"), "");
    EXPECT_EQ(joined("\xE6\xA4\x85\xE5\xAD\x90"), "");
}

TEST(Words, SingularOfCommonNouns) {
    EXPECT_EQ(singular_of("chairs"), "chair");
    EXPECT_EQ(singular_of("boxes"), "box");
    EXPECT_EQ(singular_of("glasses"), "glass");
    EXPECT_EQ(singular_of("cherries"), "cherry");
    EXPECT_EQ(singular_of("bus"), "bus");
    EXPECT_EQ(singular_of("cactus"), "cactus");
    EXPECT_EQ(singular_of("dress"), "dress");
    EXPECT_EQ(singular_of("s"), "s");
}

}  // namespace
}  // namespace embody::attributes
