// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "physics/definitions/step_account.h"

namespace embody::physics {

/// The stages of a step, in their order.
enum class StepStage : std::uint8_t {
    wake,
    fluids,
    find_pairs,
    touch,
    impact,
    islands,
    substeps,
    continuous,
    deformables,
    sleep,
    count
};

/// Limits reached while running; each names the setting to change.
enum class StepLimit : std::uint32_t {
    none = 0,
    linear_speed_clamped = 1u << 0,          ///< raise WorldSettings::max_linear_speed
    not_finite_body_frozen = 1u << 1,        ///< a body's state became non-finite; it was disabled where it last was
    impact_iterations_exhausted = 1u << 2,   ///< impacts needed more iterations, or were more, than allowed; a smaller
                                             ///< time_step helps
    deep_penetration = 1u << 3,              ///< bodies overlap deeply; place them apart or use a smaller time_step
    too_many_pairs = 1u << 4,                ///< so many bodies overlap that some pairs are left out
    angular_speed_clamped = 1u << 5,         ///< raise WorldSettings::max_angular_speed
    not_finite_deformable_frozen = 1u << 6,  ///< the same for a deformable
    not_finite_fluid_frozen = 1u << 7,       ///< the same for a fluid
    fluid_particles_lost = 1u << 8,  ///< particles flew so far that no grid holds them: walls or a floor are missing
    fluid_too_fast = 1u << 9,        ///< liquid moves by many cells a step; a larger cell_size or smaller time_step
                                     ///< helps
    fluid_unsolved = 1u << 10,       ///< its pressure or viscosity was not solved to the end; a smaller time_step helps
    fluid_source_waits = 1u << 11,   ///< a fluid has as many particles as a source allows; raise its max_particles
};

struct StepReport {
    std::uint64_t step = 0;  ///< steps done since the world was made
    double time = 0;         ///< simulated, s
    int workers = 1;         ///< threads that it ran on: WorldSettings::workers, or where that is 0 as many as paid
    std::uint32_t bodies_active = 0, bodies_wanting_to_sleep = 0, bodies_asleep = 0;  ///< dynamic ones
    std::uint32_t pairs = 0;                                                          ///< found by the broad phase
    std::uint32_t contacts = 0;                                                       ///< touching manifolds
    std::uint32_t islands = 0;
    std::uint32_t impacts = 0;  ///< manifolds solved by eq. (3) in this step
    std::uint32_t limits = 0;   ///< bits of StepLimit
    double milliseconds = 0;    ///< wall time of the step
    std::array<double, static_cast<std::size_t>(StepStage::count)> stage_milliseconds{};
    std::optional<StepAccount> account;  ///< of the rigid bodies, where World::keep_account() asks for it
};

}  // namespace embody::physics
