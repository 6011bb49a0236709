// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "database/model_schema.h"
#include "database/model_table.h"
#include "database/search_words.h"
#include "database/temporary_folder.h"
#include "database/transaction.h"
#include "foundation/random.h"

namespace embody::database {
namespace {

class ModelSearchTest : public testing::Test {
protected:
    void SetUp() override {
        auto opened = open_model_database(folder_ / "models.sqlite");
        ASSERT_TRUE(opened) << opened.error().message();
        connection_ = std::move(*opened);
        models_ = std::make_unique<ModelTable>(*connection_);
        add("a", "Armchair", "seating", {"wood", "leather"});
        add("b", "Office chair", "seating", {"wheels"});
        add("c", "Table", "tables", {"for a chair"});
        add("d", "Café lamp", "lamps", {"Ölbild"});
        add("e", "Chairlift cabin", "vehicles", {});
        add("f", "Bookcase with shelves", "storage", {});
    }

    std::int64_t add(const std::string& key, const std::string& name, const std::string& category,
                     const std::vector<std::string>& tags) {
        ModelRow row;
        row.key = key;
        row.name = name;
        row.category = category;
        row.tags = tags;
        row.source = "Test";
        auto transaction = Transaction::begin(*connection_);
        EXPECT_TRUE(transaction);
        const std::vector<std::uint8_t> bytes{1, 2, 3};
        const auto id = models_->put(row, {"{}", "[]"}, {bytes, bytes, bytes});
        EXPECT_TRUE(id) << id.error().message();
        EXPECT_TRUE(transaction->commit());
        return id ? *id : 0;
    }

    std::string find(const std::string& words, const std::string& category = {}) {
        const auto found = models_->search({.words = words, .category = category});
        if (!found) return found.error().message();
        std::string keys;
        for (const ModelRow& row : found->models) keys += row.key;
        EXPECT_EQ(found->total, static_cast<std::int64_t>(found->models.size()));
        return keys;
    }

    test::TemporaryFolder folder_;
    std::unique_ptr<Connection> connection_;
    std::unique_ptr<ModelTable> models_;
};

TEST_F(ModelSearchTest, SignsOfTheSearchLanguageMeanNothing) {
    for (const char* words : {"\"", "'", "*", "chair\"", "(chair", "chair)", "AND", "OR OR", "NOT chair", "NEAR(a b)",
                              "name:chair", "chair*", "^chair", "-chair", "chair AND", "{name}: x", "a\\", "%", "?1"}) {
        const auto found = models_->search({.words = words});
        EXPECT_TRUE(found) << words << ": " << found.error().message();
    }
    EXPECT_EQ(find("\"chair*\""), find("chair"));
    EXPECT_EQ(find("chair) OR (table"), "");  // "or" is a word that no model has
}

TEST_F(ModelSearchTest, AnyBytesAreAValidSearch) {
    Random random(7);
    const std::string alphabet = "chair \"'*()^:-{}\\%\n\t\xc3\xa9\xf0\x9f\xaa\x91\xff\xfe\x80\xe2";
    for (int round = 0; round < 2000; ++round) {
        std::string words;
        for (std::uint64_t i = random.below(40); i > 0; --i) {
            words +=
                random.below(4) == 0 ? static_cast<char>(random.below(256)) : alphabet[random.below(alphabet.size())];
        }
        const auto found = models_->search({.words = words});
        ASSERT_TRUE(found) << found.error().message() << " for " << testing::PrintToString(words);
    }
    EXPECT_TRUE(models_->search({.words = std::string("chair\0table", 11)}));
    EXPECT_TRUE(models_->search({.words = std::string(10'000, 'x')}));
    std::string many;
    for (int i = 0; i < 2000; ++i) many += "word" + std::to_string(i) + " ";
    EXPECT_TRUE(models_->search({.words = many}));
}

TEST_F(ModelSearchTest, WordsWithoutALetterFindNothingAndNoWordsFindAll) {
    EXPECT_EQ(find("🪑"), "");
    EXPECT_EQ(find("***"), "");
    EXPECT_EQ(find(""), "afdebc");
    EXPECT_EQ(find("  \n"), "afdebc");
    EXPECT_EQ(find("chair 🪑"), find("chair"));
}

TEST_F(ModelSearchTest, WholeWordsInTheNameComeFirst) {
    const std::string keys = find("chair");
    EXPECT_EQ(keys.front(), 'b');  // a whole word of the name
    EXPECT_EQ(keys.size(), 3u);    // not "Armchair": its beginning is "arm"
    EXPECT_NE(keys.find('e'), std::string::npos);
}

TEST_F(ModelSearchTest, PrefixesPluralsAndAccentsMatch) {
    EXPECT_EQ(find("armch"), "a");
    EXPECT_EQ(find("chairs").front(), 'b');
    EXPECT_EQ(find("shelf"), "");  // the stemmer does not know irregular plurals
    EXPECT_EQ(find("shelve"), "f");
    EXPECT_EQ(find("cafe"), "d");
    EXPECT_EQ(find("CAFÉ"), "d");
    EXPECT_EQ(find("olbild"), "d");
}

TEST_F(ModelSearchTest, EveryWordMustOccur) {
    EXPECT_EQ(find("office chair"), "b");
    EXPECT_EQ(find("office lamp"), "");
    EXPECT_EQ(find("leather seating"), "a");
}

TEST_F(ModelSearchTest, ACategoryNarrows) {
    EXPECT_EQ(find("chair", "tables"), "c");
    EXPECT_EQ(find("", "seating"), "ab");
    EXPECT_EQ(find("", "no such"), "");
}

TEST_F(ModelSearchTest, PagesJoinToTheWholeInOrder) {
    std::string joined;
    for (int offset = 0; offset < 6; offset += 2) {
        const auto page = models_->search({.limit = 2, .offset = offset});
        ASSERT_TRUE(page);
        EXPECT_EQ(page->total, 6);
        for (const ModelRow& row : page->models) joined += row.key;
    }
    EXPECT_EQ(joined, "afdebc");
    EXPECT_TRUE(models_->search({.limit = 2, .offset = 100})->models.empty());
}

TEST_F(ModelSearchTest, AmongVeryManyTheNameThatFitsBestComesFirst) {
    // Enough rows to be ordered by name: 2,000 that only the tag finds, and five whose names match better, added later.
    auto transaction = Transaction::begin(*connection_);
    ASSERT_TRUE(transaction);
    const std::vector<std::uint8_t> bytes{1};
    const auto put = [&](const std::string& key, const std::string& name, const std::string& category) {
        ModelRow row;
        row.key = key;
        row.name = name;
        row.category = category;
        row.tags = {"wardrobes"};
        EXPECT_TRUE(models_->put(row, {"{}", "[]"}, {bytes, bytes, bytes}));
    };
    for (int i = 0; i < 2000; ++i) put("k" + std::to_string(i), "thing " + std::to_string(1000 + i), "even");
    put("v", "Wardrobelike B", "odd");
    put("w", "wardrobelike a", "odd");
    put("x", "Old wardrobe", "odd");
    put("y", "Large wardrobe", "even");
    put("z", "Wardrobe", "even");
    ASSERT_TRUE(transaction->commit());

    const auto keys = [&](const ModelSearch& search, std::int64_t total) {
        const auto found = models_->search(search);
        if (!found) return found.error().message();
        EXPECT_EQ(found->total, total);
        std::string joined;
        for (const ModelRow& row : found->models) joined += row.key + " ";
        return joined;
    };
    EXPECT_EQ(keys({.words = " wardrobe ", .limit = 7}, 2005), "z y x w v k0 k1 ");
    EXPECT_EQ(keys({.words = "wardrobe", .limit = 3, .offset = 1}, 2005), "y x w ");
    EXPECT_EQ(keys({.words = "wardrobe", .limit = 3, .offset = 2003}, 2005), "k1998 k1999 ");
    EXPECT_EQ(keys({.words = "wardrobe", .limit = 3, .offset = 2005}, 2005), "");
    EXPECT_EQ(keys({.words = "wardrobe", .category = "even", .limit = 4}, 2002), "z y k0 k1 ");
    EXPECT_EQ(keys({.words = "wardrobe", .category = "odd", .limit = 4}, 3), "x w v ");
    EXPECT_EQ(keys({.words = "w", .limit = 4}, 2008), "f y x z ");  // "with"; wood and wheels come later
}

TEST_F(ModelSearchTest, TheSameBytesAreStoredOnceAndGoWithTheLastModel) {
    const auto stored = [&](const char* table) {
        return *connection_->query_integer(std::string("SELECT count(*) FROM ") + table);
    };
    EXPECT_EQ(stored("stored_geometry"), 1);  // of six models
    EXPECT_EQ(stored("stored_picture"), 1);
    ModelRow row;
    row.key = "a";
    const std::vector<std::uint8_t> same{1, 2, 3}, other{4, 5};
    const auto armchair = models_->put(row, {"{}", "[]"}, {other, same, same});
    ASSERT_TRUE(armchair);
    EXPECT_EQ(stored("stored_geometry"), 2);
    EXPECT_EQ(stored("stored_picture"), 1);
    EXPECT_EQ(*models_->geometry(*armchair), other);

    // A model with the same geometry keeps it when the other model is removed.
    row.key = "like a";
    {
        auto undone = Transaction::begin(*connection_);
        EXPECT_FALSE(models_->put_like(1000, row, {"{}", "[]"}));
    }
    const auto like = models_->put_like(*armchair, row, {"{}", "[]"});
    ASSERT_TRUE(like);
    EXPECT_EQ(stored("stored_geometry"), 2);
    ASSERT_TRUE(models_->remove(*armchair));
    EXPECT_EQ(*models_->geometry(*like), other);
    ASSERT_TRUE(models_->remove(*like));
    EXPECT_EQ(stored("stored_geometry"), 1);
    EXPECT_TRUE(connection_->check_integrity());
}

TEST_F(ModelSearchTest, TheIndexFollowsChangesAndRemoval) {
    const std::int64_t id = add("b", "Stool", "seating", {});
    EXPECT_EQ(find("office"), "");
    EXPECT_EQ(find("stool"), "b");
    ASSERT_TRUE(models_->remove(id));
    EXPECT_EQ(find("stool"), "");
    EXPECT_FALSE(models_->remove(id));
    EXPECT_FALSE(models_->geometry(id));
    EXPECT_TRUE(connection_->check_integrity());
}

// Version 5 did this at the end of each import, until SQLite 3.40 takes the index for damaged (later versions do not).
TEST_F(ModelSearchTest, AnIndexThatWasMergedTooOftenIsRebuilt) {
    const std::string merge = "INSERT INTO model_words (model_words) VALUES ('optimize')";
    std::vector<std::string> words;  // a small index does not grow in levels
    for (int i = 0; i < 3000; ++i) words.push_back("tag" + std::to_string(i));
    add("h", "Many", "seating", words);
    for (int i = 0; i < 2200; ++i) {
        const std::string name = "word" + std::to_string(i);
        if (!connection_->execute("UPDATE model SET name = '" + name + "' WHERE key = 'b'; " + merge)) break;
    }
    ASSERT_TRUE(connection_->execute("PRAGMA user_version = 5"));
    models_.reset();
    connection_.reset();

    auto opened = open_model_database(folder_ / "models.sqlite");
    ASSERT_TRUE(opened) << opened.error().message();
    connection_ = std::move(*opened);
    models_ = std::make_unique<ModelTable>(*connection_);
    EXPECT_EQ(find("armchair"), "a");
    EXPECT_EQ(find("tag2999"), "h");
    add("g", "Hammock", "seating", {});
    EXPECT_EQ(find("hammock"), "g");
    EXPECT_TRUE(connection_->check_integrity());
}

TEST_F(ModelSearchTest, AModelKeepsItsIdWhenItIsReplaced) {
    const auto before = models_->find_key("a");
    ASSERT_TRUE(before && *before);
    EXPECT_EQ(add("a", "Armchair, new", "seating", {}), (*before)->id);
}

TEST(SearchWords, AreQuotedAndLimited) {
    EXPECT_EQ(match_expressions("").ranked, "");
    EXPECT_EQ(match_expressions("\"*()").ranked, "");
    EXPECT_EQ(match_expressions("oak").ranked, "(\"oak\" OR \"oak\" *)");
    EXPECT_EQ(match_expressions("oak, oak").ranked, match_expressions("oak").ranked);
    EXPECT_LT(match_expressions(std::string(100'000, 'x')).ranked.size(), 200u);
    std::string many;
    for (int i = 0; i < 1000; ++i) many += std::to_string(i) + " ";
    EXPECT_LT(match_expressions(many).ranked.size(), 1000u);
}

}  // namespace
}  // namespace embody::database
