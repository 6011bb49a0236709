// SPDX-License-Identifier: MIT
#include "foundation/handle_table.h"

#include <gtest/gtest.h>

#include <string>

namespace embody {
namespace {

struct Tag;
using Table = HandleTable<Tag, std::string>;

TEST(HandleTable, NullAndForeignHandlesFindNothing) {
    Table table;
    EXPECT_TRUE(Table::HandleType{}.is_null());
    EXPECT_EQ(table.find({}), nullptr);
    EXPECT_EQ(table.find({7, 1}), nullptr);
    EXPECT_FALSE(table.remove({}));
}

TEST(HandleTable, HandleOfARemovedElementIsStaleForEver) {
    Table table;
    const auto first = table.insert("first");
    EXPECT_TRUE(table.remove(first));
    EXPECT_FALSE(table.remove(first));
    const auto second = table.insert("second");
    EXPECT_EQ(second.index, first.index);
    EXPECT_NE(second, first);
    EXPECT_EQ(table.find(first), nullptr);
    EXPECT_EQ(*table.find(second), "second");
}

TEST(HandleTable, IterationByIndexSkipsGapsAndCounts) {
    Table table;
    const auto a = table.insert("a"), b = table.insert("b"), c = table.insert("c");
    table.remove(b);
    EXPECT_EQ(table.count(), 2u);
    std::string all;
    for (std::uint32_t i = 0; i < table.slot_count(); ++i) {
        if (table.used(i)) all += table.at(i);
    }
    EXPECT_EQ(all, "ac");
    EXPECT_EQ(table.handle_at(0), a);
    EXPECT_EQ(table.handle_at(2), c);
    EXPECT_FALSE(table.used(99));
}

}  // namespace
}  // namespace embody
