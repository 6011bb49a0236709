// SPDX-License-Identifier: MIT
#if !defined(EMBODY_VALIDATION)
#define EMBODY_VALIDATION  // as in Debug builds
#endif
#include "foundation/validate.h"

#include <gtest/gtest.h>

#include "foundation/result.h"

namespace embody {
namespace {

TEST(Validate, GoesOnWhereAllIsInOrder) {
    int checks = 0;
    const auto check = [&] {
        ++checks;
        return Result<void>();
    };
    EMBODY_VALIDATE(check());
    EXPECT_EQ(checks, 1);
}

TEST(ValidateDeathTest, SaysWhatIsBrokenAndEnds) {
    EXPECT_DEATH(EMBODY_VALIDATE(Result<void>(Error{"bodies[3].center", "is not finite"})),
                 "broken state: bodies.3..center: is not finite");
}

}  // namespace
}  // namespace embody
