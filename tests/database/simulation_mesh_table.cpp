// SPDX-License-Identifier: MIT
#include "database/simulation_mesh_table.h"

#include <gtest/gtest.h>

#include "database/model_schema.h"
#include "database/model_table.h"
#include "database/temporary_folder.h"

namespace embody::database {
namespace {

TEST(SimulationMeshTable, KeepsOneForEachKindAndLosesThemWithTheModel) {
    test::TemporaryFolder folder;
    auto connection = open_model_database(folder / "models.sqlite");
    ASSERT_TRUE(connection) << connection.error().message();
    ModelTable models(**connection);
    SimulationMeshTable table(**connection);
    EXPECT_FALSE(table.put(77, {"soft", 1, "", {1}}).ok()) << "of a model that is not there";

    ModelRow row;
    row.key = row.name = "cushion";
    const std::vector<std::uint8_t> bytes{1};
    const auto id = models.put(row, {"{}", "[]"}, {bytes, bytes, bytes});
    ASSERT_TRUE(id) << id.error().message();
    EXPECT_FALSE(table.find(*id, "soft")->has_value());
    ASSERT_TRUE(table.put(*id, {"soft", 1, "", {1, 2, 3}}));
    ASSERT_TRUE(table.put(*id, {"cloth", 4, "is no sheet", {}}));
    ASSERT_TRUE(table.put(*id, {"soft", 2, "", {4}}));
    const auto soft = table.find(*id, "soft");
    ASSERT_TRUE(soft && *soft);
    EXPECT_EQ((*soft)->revision, 2);
    EXPECT_EQ((*soft)->mesh, std::vector<std::uint8_t>{4});
    const auto cloth = table.find(*id, "cloth");
    ASSERT_TRUE(cloth && *cloth);
    EXPECT_EQ((*cloth)->problem, "is no sheet");
    EXPECT_TRUE((*cloth)->mesh.empty());

    ASSERT_TRUE(table.forget(*id));
    EXPECT_FALSE(table.find(*id, "soft")->has_value());
    ASSERT_TRUE(table.put(*id, {"soft", 1, "", {1}}));
    ASSERT_TRUE(models.remove(*id));
    EXPECT_EQ(*(*connection)->query_integer("SELECT count(*) FROM model_simulation_mesh"), 0);
}

}  // namespace
}  // namespace embody::database
