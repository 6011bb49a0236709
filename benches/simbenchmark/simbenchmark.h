// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "foundation/result.h"

// Four of the accuracy tests of SimBenchmark: Hwangbo, Kang et al., github.com/leggedrobotics/SimBenchmark, 2018,
// commit 3fd1764. Its z axis is our y axis. A smaller error is better.
namespace embody::simbenchmark {

/// The smallest error that they published for this time step, of RaiSim, Bullet, ODE, MuJoCo and DART.
struct Published {
    double time_step = 0;  ///< s
    double error = 0;
    std::string_view engine;
};

/// A test's world and bodies.
struct Scene;

struct AccuracyTest {
    std::string_view name;
    std::string_view what;          ///< description of the scene
    std::string_view error;         ///< description of the error
    std::string_view unit;          ///< unit of the error
    double seconds = 0;             ///< simulated time
    std::vector<Published> best{};  ///< time steps without a published error are left out
    Result<Scene> (*make)(double time_step) = nullptr;
    double (*measure)(const Scene& scene, double time) = nullptr;  ///< called before the step at `time`, s

    /// Null where none was published.
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

/// Runs a test with this time step, s, for its own duration or for `seconds`; sleeping is off, all other settings are
/// the defaults. An error that is not a number is a valid result, though a wrong one.
Result<Accuracy> run_accuracy_test(const AccuracyTest& test, double time_step,
                                   std::optional<double> seconds = std::nullopt);

}  // namespace embody::simbenchmark
