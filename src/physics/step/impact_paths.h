// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "physics/step/world_state.h"

namespace embody::physics {

/// Where bodies are within a step if nothing but their free motion and the impacts so far move them, and which contacts
/// close as fast as an impact does. A view of the world, made anew each step; its memory is the world's.
class ImpactPaths {
public:
    static constexpr double never = 1e300;
    static constexpr double touch_gap = 1e-6;       ///< m: bodies this near touch
    static constexpr double slowest_impact = 0.02;  ///< m/s: slower contacts rest
    static constexpr double least_liveliness = 0.05;

    /// Classifies the bodies by what the touch stage noted of their contacts.
    explicit ImpactPaths(WorldState& world);

    /// What carries a body cancels its weight: only bodies in free motion gain speed before the impact. m/s².
    [[nodiscard]] Vec3 free_acceleration(std::uint32_t body) const;
    [[nodiscard]] Vec3 center_at(std::uint32_t body, double time) const;
    [[nodiscard]] Transform pose_at(std::uint32_t body, double time) const;
    /// The last impact of either body in this step, s.
    [[nodiscard]] double earliest_time(const Contact& contact) const;
    /// Gap of a point and its rate, the turning of the bodies included: a foot of a spinning chair does not move
    /// straight. m, m/s.
    struct Gap {
        double size, rate;
    };
    [[nodiscard]] Gap gap_at(const Contact& contact, const ContactPoint& point, double time) const;

    [[nodiscard]] Material material_of(const Contact& contact) const;
    /// Whether the contact has a bounce, and neither body has bounced so often in this step that hardly any speed is
    /// left of the first one (Zeno's ball).
    [[nodiscard]] bool bounces(const Contact& contact) const;
    void note_bounce(const Contact& contact);
    /// Whether it hits what others carry: one of many contacts that stop it together.
    [[nodiscard]] bool hits_heap(const Contact& contact) const;
    /// Whether no point can close as fast as an impact does: most contacts of a heap at rest, told by what the touch
    /// stage noted of them. Holds for bodies that had no impact in this step.
    [[nodiscard]] bool is_surely_slow(const ContactGlance& glance) const;

    /// The time of the contact's next impact in this step, `never` if it has none. Points that close as fast but meet
    /// after the step are the next step's impact: they are left open, so that the substeps do not brake them before.
    double predict(Contact& contact);
    /// The surfaces `pass` each other in this step: leaves open all points that are apart now.
    void leave_open(Contact& contact);

private:
    /// How the matter of a body has moved since its contacts were found.
    struct Motion {
        Vec3 shift, velocity, spin;
        Quat turn;
        Vec3 tilt;  ///< ω t since the step began, rad: all that a round body's turning does to its contacts
    };
    [[nodiscard]] Motion motion_at(std::uint32_t body, double time) const;
    [[nodiscard]] double slowest_speed(const Contact& contact) const;
    [[nodiscard]] double touch_time(const Contact& contact, const ContactPoint& point, double start, Gap first,
                                    Gap last) const;
    double predict_exactly(Contact& contact, double slowest);

    WorldState& world_;
    ImpactMemory& memory_;
    const double step_, substep_;
    const std::size_t most_heap_bounces_;  ///< in a step; the collapse of a large heap of bouncing bodies has no end
};

}  // namespace embody::physics
