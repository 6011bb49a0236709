// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "benches/simbenchmark/simbenchmark.h"

namespace embody::simbenchmark {
namespace {

double error_of(std::string_view name, double time_step, double seconds) {
    const auto result = run_accuracy_test(*find_accuracy_test(name), time_step, seconds);
    if (!result) {
        ADD_FAILURE() << result.error().message();
        return -1;
    }
    EXPECT_EQ(result->steps, std::lround(seconds / time_step));
    return result->error;
}

TEST(simbenchmark, unknown_tests_and_time_steps_have_no_figures) {
    EXPECT_EQ(find_accuracy_test("777"), nullptr);
    EXPECT_EQ(find_accuracy_test("bouncing")->published(0.002), nullptr);
    EXPECT_EQ(find_accuracy_test("rolling")->published(0.01), nullptr);
    EXPECT_DOUBLE_EQ(find_accuracy_test("bouncing")->published(0.01)->error, 185.953);
}

TEST(simbenchmark, gives_the_same_bits_again) {
    for (const AccuracyTest& test : accuracy_tests())
        EXPECT_EQ(error_of(test.name, 0.01, 0.8), error_of(test.name, 0.01, 0.8)) << test.name;
}

// The published errors are those of whole runs; a part of a run must have a much smaller error.
TEST(simbenchmark, balls_on_a_pushed_box_keep_to_the_analytic_velocities) {
    EXPECT_LT(error_of("rolling", 0.01, 0.5), 4.93e-9);
    // The best published result is Bullet's, 4.93e-9: here eight iterations leave speed from pushing out the first
    // overlap of 20 µm.
    EXPECT_LT(error_of("rolling", 0.001, 0.1), 1e-5);
}
TEST(simbenchmark, bouncing_balls_keep_their_energy) { EXPECT_LT(error_of("bouncing", 0.01, 4), 1e-6 * 185.953); }
TEST(simbenchmark, a_cube_of_balls_falls_apart_without_overlap) {
    EXPECT_LT(error_of("666", 0.01, 1), 1e-3 * 0.0152745);
}
TEST(simbenchmark, a_cube_of_elastic_balls_keeps_its_energy) {
    EXPECT_LT(error_of("elastic_666", 0.01, 1.5), 0.2 * 5.18417e6);
    EXPECT_LT(error_of("elastic_666", 0.001, 0.7), 1e-3 * 8.36835);
}

}  // namespace
}  // namespace embody::simbenchmark
