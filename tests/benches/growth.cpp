// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "benches/scaling/scaling.h"

namespace embody::scaling {
namespace {

TEST(scaling, scenes_end_as_they_must) {
    for (const Scene scene : scenes) {
        const auto cost = measure(scene, 40);
        ASSERT_TRUE(cost) << cost.error().message();
        EXPECT_EQ(cost->wrong, "") << name_of(scene);
        EXPECT_EQ(cost->bodies, 40);
        EXPECT_GT(cost->step_milliseconds, 0) << name_of(scene);
    }
}

TEST(scaling, only_what_is_awake_has_contacts) {
    // Ten columns of four: each cube rests on the one below or on the ground.
    EXPECT_EQ(measure(Scene::columns_awake, 40)->contacts, 40u);
    EXPECT_EQ(measure(Scene::columns_asleep, 40)->contacts, 0u);
    EXPECT_EQ(measure(Scene::one_awake, 40)->contacts, 1u);
    EXPECT_GT(measure(Scene::heap_falling, 40)->contacts, 0u);
}

TEST(scaling, growth_is_the_exponent) {
    const Cost small{.bodies = 1000, .step_milliseconds = 2};
    EXPECT_NEAR(growth(small, {.bodies = 10'000, .step_milliseconds = 20}), 1, 1e-12);
    EXPECT_NEAR(growth(small, {.bodies = 10'000, .step_milliseconds = 200}), 2, 1e-12);
    EXPECT_NEAR(growth(small, {.bodies = 2000, .step_milliseconds = 2}), 0, 1e-12);
}

}  // namespace
}  // namespace embody::scaling
