// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "foundation/result.h"

// How the cost of a step grows with the number of bodies: it must grow linearly.
namespace embody::scaling {

/// columns_awake: cubes at rest in columns of four, sleep off. heap_falling: balls and boxes that fall ten deep, and
/// tumble. columns_asleep: the first, asleep. one_awake: the same, and one ball more that rolls far from them.
enum class Scene : std::uint8_t { columns_awake, heap_falling, columns_asleep, one_awake };

inline constexpr Scene scenes[] = {Scene::columns_awake, Scene::heap_falling, Scene::columns_asleep, Scene::one_awake};
inline constexpr int sizes[] = {1'000, 10'000, 100'000, 1'000'000};

std::string_view name_of(Scene scene);
std::string_view what_of(Scene scene);  ///< for people

struct Cost {
    int bodies = 0;
    std::uint32_t contacts = 0;    ///< at the end
    double step_milliseconds = 0;  ///< CPU time of the process, mean over the steps that count
    double memory_kilobytes = 0;   ///< that came into the resident set with the world, for each body
    std::string wrong;             ///< empty: the end state is as it must be
};

/// Builds the scene, brings it into its state and times its steps on one thread.
Result<Cost> measure(Scene scene, int bodies);

/// Exponent p of cost ~ bodies^p between two sizes of a scene; 1 is linear.
double growth(const Cost& smaller, const Cost& larger);

}  // namespace embody::scaling
