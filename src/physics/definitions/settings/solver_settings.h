// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "foundation/result.h"
#include "physics/definitions/settings/collision_settings.h"
#include "physics/definitions/settings/constraint_settings.h"
#include "physics/definitions/settings/deformable_settings.h"
#include "physics/definitions/settings/fluid_settings.h"
#include "physics/definitions/settings/optimization_settings.h"

namespace embody::physics {

/// The numbers that steer the solvers, a group a module (docs/physics/settings.md). They are good for things from a
/// millimetre to a hundred metres on Earth; worlds of another scale, and experiments, may set others. Each says where
/// it comes from: a source, or the test that fails with ten times or a tenth of it.
struct SolverSettings {
    CollisionSettings collision;
    ConstraintSettings constraint;
    DeformableSettings deformable;
    FluidSettings fluid;
    OptimizationSettings optimization;
};

template <>
inline constexpr auto settings_of<SolverSettings> = std::tuple{
    Setting{"collision", &SolverSettings::collision},       Setting{"constraint", &SolverSettings::constraint},
    Setting{"deformable", &SolverSettings::deformable},     Setting{"fluid", &SolverSettings::fluid},
    Setting{"optimization", &SolverSettings::optimization},
};
static_assert(setting_count<SolverSettings> == member_count<SolverSettings>(), "a group is in no list");

/// The error's `where` is the field with its groups: `solver.optimization.shock_fraction`.
Result<void> validate(const SolverSettings& settings);

/// One number of SolverSettings as text and tools see it.
struct SettingNumber {
    std::string path;  ///< with its groups: `optimization.shock_fraction`
    double value = 0, low = 0, high = 0;
    const char* unit = "";  ///< "" where it is a count or a ratio
    bool is_integer = false;
};

/// All numbers in the order of their structs.
std::vector<SettingNumber> list_settings(const SolverSettings& settings);
/// Sets the number of that path; one that must be whole is rounded. Refused where there is none.
Result<void> set_setting(SolverSettings& settings, std::string_view path, double value);

}  // namespace embody::physics
