// SPDX-License-Identifier: MIT
#include "attributes/wordnet/noun_table.h"
#include "folders.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace embody::attributes::wordnet {
namespace {

const std::filesystem::path built_table = build_folder() / "data/wordnet-nouns.table";

const NounTable& nouns() {
    static const NounTable table = [] {
        auto loaded = NounTable::load(built_table);
        EXPECT_TRUE(loaded.ok()) << loaded.error().message();
        return std::move(*loaded);
    }();
    return table;
}

// The base form under which the inflected word is found, or "".
std::string base_of(std::string_view word) {
    const auto lemma = nouns().find_inflected(word);
    return lemma ? std::string(nouns().text(*lemma)) : "";
}

// A folder that is deleted after the test.
struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("embody_wordnet_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    void write(const char* name, std::string_view text) const { std::ofstream(path / name) << text; }
};

TEST(NounTableFile, MissingCutOrChangedIsRefusedWithARemedy) {
    const Folder folder;
    const auto missing = NounTable::load(folder.path / "none.table");
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message().find("none.table"), std::string::npos);
    EXPECT_NE(missing.error().remedy.find("wordnet-base"), std::string::npos);

    std::ifstream stream(built_table, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    const auto why = [&](std::string content) {
        folder.write("broken.table", content);
        const auto loaded = NounTable::load(folder.path / "broken.table");
        return loaded ? "" : loaded.error().why;
    };
    EXPECT_EQ(why(whole), "");
    EXPECT_EQ(why(""), "is cut off");
    EXPECT_EQ(why(whole.substr(0, 20)), "is cut off");
    EXPECT_EQ(why(whole.substr(0, 4003)), "is cut off");
    EXPECT_NE(why(whole.substr(0, 4000)).find("checksum"), std::string::npos);
    EXPECT_NE(why(whole + "more").find("checksum"), std::string::npos);
    EXPECT_NE(why("text" + whole.substr(4)).find("is no table"), std::string::npos);
    std::string changed = whole;
    changed[4] = 77;
    EXPECT_NE(why(changed).find("version 77"), std::string::npos);
    changed = whole;
    changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 1);
    EXPECT_NE(why(changed).find("was changed"), std::string::npos);
    // Counts so large that their sum would overflow.
    changed = whole;
    std::fill(changed.begin() + 8, changed.begin() + 32, '\xff');
    EXPECT_NE(why(changed).find("checksum"), std::string::npos);
}

TEST(NounDatabase, BrokenTextFilesAreRefusedByFileAndLine) {
    const Folder folder;
    const auto why = [&] {
        const auto read = read_noun_database(folder.path);
        return read ? "" : read.error().message();
    };
    EXPECT_NE(why().find("data.noun: cannot be read"), std::string::npos);
    const std::string entity = "00001740 03 n 01 entity 0 000 | that which is  \n";
    folder.write("data.noun", "  1 licence\n" + entity + "00001930 03 n zz thing 0 000 | a thing  \n");
    EXPECT_NE(why().find("data.noun: line 3"), std::string::npos);
    folder.write("data.noun", entity + "00001930 03 n 01 thing 0 001 @ 00009999 n 0000 | a thing  \n");
    EXPECT_NE(why().find("thing points to a synset that is not there"), std::string::npos);
    folder.write("data.noun", entity + "00001930 03 n 01 thing 0 001 @ 00001740 n 0000 | a thing  \n");
    folder.write("index.noun", "entity n 1 1 ~ 1 0 00001740  \nthing n 1 1 @ 1 0 00001931  \n");
    EXPECT_NE(why().find("index.noun: line 2"), std::string::npos);
    folder.write("index.noun", "entity n 1 1 ~ 1 0 00001740  \nthing n 1 1 @ 1 0 00001930  \n");
    folder.write("noun.exc", "thingies\n");
    EXPECT_NE(why().find("noun.exc: line 1"), std::string::npos);
    folder.write("noun.exc", "thingies thing\n");
    EXPECT_EQ(why(), "");

    // A database that was read can be written and read again; here nothing is physical.
    const auto read = read_noun_database(folder.path);
    ASSERT_TRUE(write_noun_table(*read, folder.path / "small.table").ok());
    EXPECT_FALSE(write_noun_table(*read, folder.path / "none" / "small.table").ok());
    const auto small = NounTable::load(folder.path / "small.table");
    ASSERT_TRUE(small.ok()) << small.error().message();
    const auto thing = small->find_synset("thing.n.01");
    ASSERT_TRUE(thing.has_value());
    EXPECT_EQ(small->name(small->hypernyms(*thing)[0]), "entity.n.01");
    EXPECT_EQ(small->count_of_kind(small->hypernyms(*thing)[0]), 2u);
    EXPECT_FALSE(small->is_physical(*thing));
    EXPECT_EQ(small->text(*small->find_inflected("thingies")), "thing");
}

TEST(NounTable, HoldsAllOfWordNet) {
    // The statistics that WordNet 3.0 publishes about itself, wnstats(7WN): 117,798 nouns, 82,115 synsets.
    EXPECT_EQ(nouns().synset_count(), 82115u);
    EXPECT_GE(nouns().lemma_count(), 117798u);
    std::uint32_t wrong_names = 0;
    for (SynsetIndex i = 0; i < nouns().synset_count(); ++i) wrong_names += nouns().find_synset(nouns().name(i)) != i;
    EXPECT_EQ(wrong_names, 0u);
}

TEST(NounTable, SensesComeTheUsualOneFirstWithTheirCounts) {
    const auto chair = nouns().find_lemma("chair");
    ASSERT_TRUE(chair.has_value());
    const auto senses = nouns().senses(*chair);
    ASSERT_GE(senses.size(), 4u);
    EXPECT_EQ(nouns().name(senses[0].synset), "chair.n.01");
    EXPECT_EQ(senses[0].tag_count, 35u);
    EXPECT_EQ(nouns().topic(senses[0].synset), Topic::artifact);
    EXPECT_EQ(nouns().name(senses[2].synset), "president.n.04");
    EXPECT_EQ(nouns().topic(senses[2].synset), Topic::person);
    EXPECT_TRUE(nouns().is_mostly_adjective(*nouns().find_lemma("modern")));
    EXPECT_FALSE(nouns().is_mostly_adjective(*chair));
}

TEST(NounTable, HypernymsLeadUp) {
    const auto tureen = nouns().find_synset("tureen.n.01");
    ASSERT_TRUE(tureen.has_value());
    ASSERT_EQ(nouns().hypernyms(*tureen).size(), 1u);
    EXPECT_EQ(nouns().name(nouns().hypernyms(*tureen)[0]), "serving_dish.n.01");
    EXPECT_TRUE(nouns().is_physical(*tureen));
    EXPECT_FALSE(nouns().is_physical(*nouns().find_synset("idea.n.01")));
    EXPECT_TRUE(nouns().is_physical(*nouns().find_synset("bleachers.n.01")));  // under room.n.02, which is abstract
    EXPECT_EQ(nouns().count_of_kind(*nouns().find_synset("entity.n.01")), nouns().synset_count());
    EXPECT_EQ(nouns().count_of_kind(*tureen), 1u);
    const auto tower = nouns().find_synset("eiffel_tower.n.01");
    ASSERT_TRUE(tower.has_value());
    EXPECT_TRUE(nouns().is_instance(*tower));
    EXPECT_EQ(nouns().name(nouns().hypernyms(*tower)[0]), "tower.n.01");
}

TEST(NounTable, RefusesNamesThatMeanNothing) {
    for (const char* name : {"", "chair", "chair.n.", "chair.n.00", "chair.n.06", "chair.n.1x", "chair.n.001",
                             "chair.v.01", ".n.01", "chiar.n.01", "Chair.n.01"}) {
        EXPECT_FALSE(nouns().find_synset(name).has_value()) << name;
    }
    EXPECT_FALSE(nouns().find_lemma("").has_value());
    EXPECT_FALSE(nouns().find_inflected("").has_value());
}

TEST(NounTable, InflectedWordsLeadToTheirBase) {
    EXPECT_EQ(base_of("chairs"), "chair");
    EXPECT_EQ(base_of("boxes"), "box");
    EXPECT_EQ(base_of("dishes"), "dish");
    EXPECT_EQ(base_of("berries"), "berry");
    EXPECT_EQ(base_of("geese"), "goose");
    EXPECT_EQ(base_of("knives"), "knife");
    EXPECT_EQ(base_of("bread_knives"), "bread_knife");
    EXPECT_EQ(base_of("firemen"), "fireman");
    // Words that only look like plurals.
    EXPECT_EQ(base_of("scissors"), "scissors");
    EXPECT_EQ(base_of("glass"), "glass");
    EXPECT_EQ(base_of("bus"), "bus");
    EXPECT_EQ(base_of("zzgrass"), "");
    // Hyphens and apostrophes are left out of names.
    EXPECT_EQ(base_of("t_shirts"), "t_shirt");
    EXPECT_EQ(nouns().name(nouns().senses(*nouns().find_lemma("t_shirt"))[0].synset), "jersey.n.03");
    EXPECT_TRUE(nouns().find_inflected("jews_harp").has_value());
}

}  // namespace
}  // namespace embody::attributes::wordnet
