// SPDX-License-Identifier: MIT
#include "foundation/result.h"

#include <gtest/gtest.h>

#include <memory>

namespace embody {
namespace {

Result<int> half_of(int number) {
    if (number % 2 != 0) return Error{"number", "must be even", "add one"};
    return number / 2;
}
Result<void> check(int number) {
    if (const auto half = half_of(number); !half) return half.error();
    return {};
}

TEST(Result, TellsWhereWhyAndRemedy) {
    const auto result = half_of(3);
    ASSERT_FALSE(result.ok());
    EXPECT_FALSE(result);
    EXPECT_EQ(result.error().message(), "number: must be even (add one)");
    EXPECT_EQ(check(3).error().where, "number");
}

TEST(Error, LeavesOutWhatIsEmpty) {
    EXPECT_EQ((Error{"", "broken"}).message(), "broken");
    EXPECT_EQ((Error{"a.obj", "broken"}).message(), "a.obj: broken");
}

TEST(Result, HoldsTheValue) {
    EXPECT_EQ(*half_of(8), 4);
    EXPECT_TRUE(check(8).ok());
}

TEST(Result, MovesWhatCannotBeCopied) {
    Result<std::unique_ptr<int>> result(std::make_unique<int>(7));
    const std::unique_ptr<int> taken = *std::move(result);
    EXPECT_EQ(*taken, 7);
}

}  // namespace
}  // namespace embody
