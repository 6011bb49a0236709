// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "foundation/result.h"

// How the cost of a step grows with the number of bodies: it must grow linearly.
namespace embody::scaling {

/// columns_awake: cubes at rest in columns of four, sleeping off. heap_falling: balls and boxes that fall in ten layers
/// and tumble. columns_asleep: the first, asleep. one_awake: the same, and a ball that rolls far from them.
enum class Scene : std::uint8_t { columns_awake, heap_falling, columns_asleep, one_awake };

inline constexpr Scene scenes[] = {Scene::columns_awake, Scene::heap_falling, Scene::columns_asleep, Scene::one_awake};
inline constexpr int sizes[] = {1'000, 10'000, 100'000, 1'000'000};

std::string_view name_of(Scene scene);
std::string_view what_of(Scene scene);  ///< description

struct Cost {
    int bodies = 0;
    std::uint32_t contacts = 0;    ///< at the end
    double step_milliseconds = 0;  ///< CPU time of the process, mean over the timed steps
    double memory_kilobytes = 0;   ///< growth of the resident set by the world, per body
    std::string wrong;             ///< empty: the end state is correct
};

/// Builds the scene, steps it into its state and times its steps on one thread.
Result<Cost> measure(Scene scene, int bodies);

/// Exponent p of cost ~ bodies^p between two sizes of a scene; 1 is linear.
double growth(const Cost& smaller, const Cost& larger);

}  // namespace embody::scaling
