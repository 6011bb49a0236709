// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/impact_memory.h"

namespace embody::physics::stages {

/// Where bodies are within a step if nothing but their free motion and the impacts so far move them. A view of the
/// world, made anew each step; its memory is the world's (ImpactMemory).
///
/// A free body moves as the substeps will move it: whole substeps by dynamic/equations_of_motion, and a part of one up
/// to the given time. A body that others carry moves straight on and turns evenly: they cancel its weight.
class BodyPaths {
public:
    explicit BodyPaths(const ImpactAccess& world);

    /// The body at `time` (s since the step began): pose, velocities and inertia.
    [[nodiscard]] BodyState state_at(std::uint32_t body, double time) const;
    /// The same, kept until another impact changes the path: an impact needs the states of its two bodies again and
    /// again. Valid until the second next call for another body or time. Not thread-safe.
    const BodyState& kept_state_at(std::uint32_t body, double time);
    Transform pose_at(std::uint32_t body, double time);
    /// Sets the body's state at the step's start such that its path leads through `state` at `time`, with the same
    /// energy.
    void lead_through(std::uint32_t body, BodyState state, double time);
    /// The same for a jointed body, which has no free path: its velocities change by these, m/s and rad/s, already at
    /// the step's start, and its place there changes such that its place at `time` stays the same.
    void change_velocities(std::uint32_t body, Vec3 linear, Vec3 angular, double time);
    /// Sets the body's state at the step's start.
    void begin_anew(std::uint32_t body, const BodyState& state);

    /// How the body's matter has moved since its contacts were found.
    struct Motion {
        Vec3 shift, velocity, spin;  ///< m, m/s, rad/s
        Quat turn;
    };
    /// The same without solving for the motion between the ends of remembered substeps: enough for predictions.
    [[nodiscard]] Motion motion_about(std::uint32_t body, double time) const;

    /// What the free motion adds to the velocity, m/s²; 0 for what is carried.
    [[nodiscard]] Vec3 free_acceleration(std::uint32_t body) const;
    /// Remembers the paths of these bodies at the ends of the substeps: most queried times are close to one.
    void remember(std::span<const std::uint32_t> bodies);

private:
    [[nodiscard]] bool turns_evenly(std::uint32_t body, const BodyState& state) const;
    void move_evenly(std::uint32_t body, BodyState& state, double time) const;
    void fill_path(std::uint32_t body);

    struct KeptState {
        std::uint32_t body = 0xFFFFFFFFu;
        double time = 0;
        BodyState state;
    };

    const ImpactAccess world_;
    ImpactMemory& memory_;
    const double step_, substep_;
    std::array<KeptState, 4> kept_;
    std::size_t next_kept_ = 0;
    const std::size_t states_;  ///< remembered of a path: one for each substep's end
};

}  // namespace embody::physics::stages
