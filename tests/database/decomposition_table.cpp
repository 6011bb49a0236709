// SPDX-License-Identifier: MIT
#include "database/decomposition_table.h"

#include <gtest/gtest.h>

#include "database/model_schema.h"
#include "database/model_table.h"
#include "database/temporary_folder.h"

namespace embody::database {
namespace {

TEST(DecompositionTable, KeepsOneForEachPairOfLimitsAndLosesThemWithTheModel) {
    test::TemporaryFolder folder;
    auto connection = open_model_database(folder / "models.sqlite");
    ASSERT_TRUE(connection) << connection.error().message();
    ModelTable models(**connection);
    DecompositionTable table(**connection);
    const StoredDecomposition parts{16, 10'000, 0.004, 0.3, {1, 2, 3}};
    EXPECT_FALSE(table.put(77, parts).ok()) << "of a model that is not there";

    ModelRow row;
    row.key = row.name = "chair";
    const std::vector<std::uint8_t> bytes{1};
    const auto id = models.put(row, {"{}", "[]"}, {bytes, bytes, bytes});
    ASSERT_TRUE(id) << id.error().message();
    EXPECT_FALSE(table.find(*id, 16, 10'000)->has_value());
    ASSERT_TRUE(table.put(*id, parts));
    ASSERT_TRUE(table.put(*id, {16, 10'000, 0.005, 0.3, {4}}));
    ASSERT_TRUE(table.put(*id, {8, 10'000, 0.02, 0.3, {5, 6}}));
    const auto found = table.find(*id, 16, 10'000);
    ASSERT_TRUE(found && *found);
    EXPECT_EQ((*found)->hulls, std::vector<std::uint8_t>{4});
    EXPECT_EQ((*found)->concavity, 0.005);
    EXPECT_EQ((*table.find(*id, 8, 10'000))->hulls.size(), 2u);
    EXPECT_FALSE(table.find(*id, 8, 9'999)->has_value());

    ASSERT_TRUE(table.forget(*id));
    EXPECT_FALSE(table.find(*id, 8, 10'000)->has_value());
    ASSERT_TRUE(table.put(*id, parts));
    ASSERT_TRUE(models.remove(*id));
    EXPECT_EQ(*(*connection)->query_integer("SELECT count(*) FROM model_decomposition"), 0);
}

}  // namespace
}  // namespace embody::database
