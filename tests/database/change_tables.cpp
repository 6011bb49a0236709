// SPDX-License-Identifier: MIT
// The tables of persons' changes and of the models' origins: rows are read as they were written, in order and by
// search, and every call reports a database without these tables.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "database/attribute_table.h"
#include "database/change_table.h"
#include "database/import_table.h"
#include "database/model_schema.h"
#include "database/model_table.h"
#include "database/temporary_folder.h"

namespace embody::database {
namespace {

class ChangeTables : public testing::Test {
protected:
    test::TemporaryFolder folder_;
    Result<std::unique_ptr<Connection>> connection_ = open_model_database(folder_ / "models.sqlite");
    ManualAttributeTable attributes_{**connection_};
    ChangeTable changes_{**connection_};
    ImportTable imports_{**connection_};
    SettingTable settings_{**connection_};

    std::int64_t add_model(const std::string& key) {
        ModelRow row;
        row.key = row.name = key;
        const std::vector<std::uint8_t> bytes{1};
        return *ModelTable(**connection_).put(row, {"{}", "[]"}, {bytes, bytes, bytes});
    }
    std::int64_t begin(const std::string& person, std::int64_t undoes = 0) {
        return *changes_.begin_batch(
            {.person = person, .session = "s", .command = "set", .asked = "{}", .undoes = undoes});
    }
};

TEST_F(ChangeTables, AttributesAreReplacedRestoredAndErasedByName) {
    EXPECT_TRUE(attributes_.of("chair")->empty());
    EXPECT_FALSE(attributes_.find("chair", "mass")->has_value());
    ASSERT_TRUE(attributes_.put("chair", {"mass", "3", "ann"}));
    ASSERT_TRUE(attributes_.put("chair", {"mass", "4", "bob"}));
    ASSERT_TRUE(attributes_.restore("chair", {"friction", "0.5", "ann", 1234}));
    ASSERT_TRUE(attributes_.put("table", {"mass", "9", "ann"}));
    const auto all = attributes_.of("chair");
    ASSERT_EQ(all->size(), 2u);
    EXPECT_EQ((*all)[0].name, "friction") << "by name";
    EXPECT_EQ((*all)[0].set_at, 1234) << "restored with its own time";
    EXPECT_EQ((*all)[1].value, "4");
    EXPECT_EQ((*all)[1].set_by, "bob");
    EXPECT_GT((*all)[1].set_at, 1'600'000'000) << "set now";
    ASSERT_TRUE(attributes_.erase("chair", "mass"));
    EXPECT_FALSE(attributes_.find("chair", "mass")->has_value());
    EXPECT_EQ((*attributes_.find("table", "mass"))->value, "9") << "of another model it stays";
}

TEST_F(ChangeTables, ABatchIsFoundByPersonUntilItIsUndone) {
    EXPECT_EQ(*changes_.newest_batch(), 0);
    EXPECT_FALSE(changes_.last_batch("ann")->has_value());
    const std::int64_t first = begin("ann"), second = begin("bob"), third = begin("ann");
    EXPECT_LT(first, second);
    EXPECT_EQ(*changes_.newest_batch(), third);
    EXPECT_EQ((*changes_.last_batch("ann"))->id, third);
    EXPECT_EQ((*changes_.last_batch("bob"))->id, second);
    const std::int64_t undo = begin("ann", third);
    ASSERT_TRUE(changes_.mark_undone(third, undo));
    EXPECT_EQ((*changes_.find_batch(third))->undone_by, undo);
    EXPECT_EQ((*changes_.find_batch(undo))->undoes, third);
    EXPECT_EQ((*changes_.last_batch("ann"))->id, first) << "neither the undo nor what it undid";
    ASSERT_TRUE(changes_.mark_undone(third, 0));
    EXPECT_EQ((*changes_.last_batch("ann"))->id, third) << "it acts again";
    EXPECT_FALSE(changes_.find_batch(999)->has_value());
}

TEST_F(ChangeTables, ChangesTellWhatWasAndIsAndWhoChangedItSince) {
    add_model("chair");
    const std::int64_t first = begin("ann"), second = begin("bob");
    ASSERT_TRUE(changes_.add(first, {0, "chair", "mass", {}, "3"}));
    ASSERT_TRUE(changes_.add(first, {0, "lamp", "mass", {}, "1"}));
    ASSERT_TRUE(changes_.add(second, {0, "chair", "mass", ManualAttribute{"mass", "3", "ann", 77}, {}}));
    const auto of_first = changes_.changes_of(first);
    ASSERT_EQ(of_first->size(), 2u);
    EXPECT_FALSE((*of_first)[0].before.has_value());
    EXPECT_EQ((*of_first)[0].value, "3");
    const auto of_second = changes_.changes_of(second);
    ASSERT_EQ(of_second->size(), 1u);
    EXPECT_EQ((*of_second)[0].before->set_by, "ann");
    EXPECT_EQ((*of_second)[0].before->set_at, 77);
    EXPECT_FALSE((*of_second)[0].value.has_value()) << "taken away";

    EXPECT_EQ((*changes_.changed_since((*of_first)[0]))->id, second);
    EXPECT_FALSE(changes_.changed_since((*of_first)[1])->has_value()) << "of the lamp nothing has changed since";
    ASSERT_TRUE(changes_.mark_undone(second, begin("bob", second)));
    EXPECT_FALSE(changes_.changed_since((*of_first)[0])->has_value()) << "what was undone is not in force";

    const auto found = changes_.search({});
    ASSERT_EQ(found->size(), 3u);
    EXPECT_EQ((*found)[0].batch.id, second) << "newest first";
    EXPECT_EQ((*found)[0].model_name, "chair");
    EXPECT_EQ((*found)[1].model_name, "") << "the lamp is no model now";
    EXPECT_EQ(changes_.search({.model_key = "lamp"})->size(), 1u);
    EXPECT_EQ(changes_.search({.batch = first})->size(), 2u);
    EXPECT_EQ(changes_.search({.limit = 1})->size(), 1u);
    EXPECT_TRUE(changes_.search({.since = 9'000'000'000})->empty());
    const auto batches = changes_.batches({.model_key = "chair"});
    ASSERT_EQ(batches->size(), 2u);
    EXPECT_EQ((*batches)[1].values, 2);
    EXPECT_EQ((*batches)[1].models, 2);
    EXPECT_EQ(changes_.batches({.before = second})->size(), 1u);
    EXPECT_EQ(changes_.batches({.after = second})->size(), 1u);
}

TEST_F(ChangeTables, ImportsAreFoundByPlaceArchiveAndPreparation) {
    const std::int64_t chair = add_model("chair"), lamp = add_model("lamp");
    constexpr std::uint64_t high_bit = 0x8000'0000'0000'0001u;
    ASSERT_TRUE(imports_.put({"/a.zip!chair.obj", chair, "12 34", high_bit, 2, 3}));
    ASSERT_TRUE(imports_.put({"/b/chair.obj", chair, "5 6", 1, 9, 3}));
    ASSERT_TRUE(imports_.put({"/a.zip2!lamp.obj", lamp, "7 8", 1, 2, 3}));
    EXPECT_EQ((*imports_.find("/a.zip!chair.obj"))->file_hash, high_bit);
    EXPECT_FALSE(imports_.find("/a.zip!Chair.obj")->has_value());
    EXPECT_EQ((*imports_.find_in_archive("/a.zip"))->model, chair);
    EXPECT_FALSE(imports_.find_in_archive("/a")->has_value()) << "no archive, though names begin so";
    EXPECT_EQ(*imports_.locations_of(chair), (std::vector<std::string>{"/a.zip!chair.obj", "/b/chair.obj"}));
    EXPECT_TRUE(*imports_.has_preparation(chair, 9));
    EXPECT_FALSE(*imports_.has_preparation(lamp, 9));
    ASSERT_TRUE(imports_.forget_other_preparations(chair, 9));
    EXPECT_EQ(*imports_.locations_of(chair), std::vector<std::string>{"/b/chair.obj"});
    EXPECT_EQ(imports_.locations_of(lamp)->size(), 1u) << "those of others stay";
    EXPECT_EQ(*settings_.get("colour"), "");
    ASSERT_TRUE(settings_.put("colour", "red"));
    ASSERT_TRUE(settings_.put("colour", "blue"));
    EXPECT_EQ(*settings_.get("colour"), "blue");
}

TEST_F(ChangeTables, EveryCallReportsADatabaseWithoutThem) {
    for (const char* table : {"manual_attribute", "manual_change", "manual_batch", "import_source", "setting"})
        ASSERT_TRUE((*connection_)->execute(std::string("DROP TABLE ") + table)) << table;
    EXPECT_FALSE(attributes_.of("a").ok());
    EXPECT_FALSE(attributes_.find("a", "b").ok());
    EXPECT_FALSE(attributes_.put("a", {}).ok());
    EXPECT_FALSE(attributes_.restore("a", {}).ok());
    EXPECT_FALSE(attributes_.erase("a", "b").ok());
    EXPECT_FALSE(changes_.begin_batch({}).ok());
    EXPECT_FALSE(changes_.add(1, {}).ok());
    EXPECT_FALSE(changes_.mark_undone(1, 2).ok());
    EXPECT_FALSE(changes_.find_batch(1).ok());
    EXPECT_FALSE(changes_.last_batch("a").ok());
    EXPECT_FALSE(changes_.changes_of(1).ok());
    EXPECT_FALSE(changes_.changed_since({}).ok());
    EXPECT_FALSE(changes_.search({}).ok());
    EXPECT_FALSE(changes_.batches({}).ok());
    EXPECT_FALSE(changes_.newest_batch().ok());
    EXPECT_FALSE(imports_.find("a").ok());
    EXPECT_FALSE(imports_.find_in_archive("a").ok());
    EXPECT_FALSE(imports_.put({}).ok());
    EXPECT_FALSE(imports_.locations_of(1).ok());
    EXPECT_FALSE(imports_.has_preparation(1, 2).ok());
    EXPECT_FALSE(imports_.forget_other_preparations(1, 2).ok());
    EXPECT_FALSE(settings_.get("a").ok());
    const auto told = settings_.put("a", "b");
    ASSERT_FALSE(told.ok());
    EXPECT_NE(told.error().message().find("setting"), std::string::npos) << told.error().message();
}

}  // namespace
}  // namespace embody::database
