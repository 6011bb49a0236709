// SPDX-License-Identifier: MIT
#include "foundation/heap_optional.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace embody {
namespace {

using Text = HeapOptional<std::string>;

TEST(HeapOptional, IsAValueOfItsOwn) {
    Text text(std::string("one"));
    Text copy = text;
    *copy += " two";
    EXPECT_EQ(*text, "one");
    EXPECT_EQ(*copy, "one two");
    copy = text;
    EXPECT_EQ(*copy, "one");
    const Text& same = copy;
    copy = same;
    EXPECT_EQ(copy->size(), 3U);
    std::swap(text, copy);
    text = std::nullopt;
    EXPECT_FALSE(text.has_value());
    EXPECT_TRUE(copy.has_value());
    const Text none = text;
    EXPECT_FALSE(none);
}

TEST(HeapOptional, TakesAPointerWhereThereIsNothing) {
    EXPECT_EQ(sizeof(HeapOptional<std::vector<std::string>>), sizeof(void*));
}

}  // namespace
}  // namespace embody
