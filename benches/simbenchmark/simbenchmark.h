// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "foundation/result.h"

// Four of the accuracy tests of SimBenchmark: Hwangbo, Kang et al., github.com/leggedrobotics/SimBenchmark, 2018,
// commit 3fd1764. Their z is our y. The smaller the error, the better.
namespace embody::simbenchmark {

/// The least error that they published for this time step, of RaiSim, Bullet, ODE, MuJoCo and DART.
struct Published {
    double time_step = 0;  ///< s
    double error = 0;
    std::string_view engine;
};

/// A test's world and bodies.
struct Scene;

struct AccuracyTest {
    std::string_view name;
    std::string_view what;          ///< the scene, for people
    std::string_view error;         ///< what is measured, for people
    std::string_view unit;          ///< of the error
    double seconds = 0;             ///< simulated
    std::vector<Published> best{};  ///< time steps without a published error are left out
    Result<Scene> (*make)(double time_step) = nullptr;
    double (*measure)(const Scene& scene, double time) = nullptr;  ///< before the step at `time`, s

    /// Null where they published none.
    [[nodiscard]] const Published* published(double time_step) const;
};

struct Accuracy {
    double error = 0;
    int steps = 0;
    double step_milliseconds = 0;  ///< wall time, mean
};

inline constexpr double accuracy_time_steps[] = {0.01, 0.001};  ///< s

/// All tests, in their order.
std::span<const AccuracyTest> accuracy_tests();
/// Null for an unknown name.
const AccuracyTest* find_accuracy_test(std::string_view name);

/// Runs a test with this time step, s, for its own time or for `seconds`; sleep is off, all else as Embody comes. An
/// error that is no number is an answer, too: a wrong one.
Result<Accuracy> run_accuracy_test(const AccuracyTest& test, double time_step,
                                   std::optional<double> seconds = std::nullopt);

}  // namespace embody::simbenchmark
