// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "physics/definitions/settings/impact_settings.h"
#include "physics/stages/access.h"
#include "physics/stages/impact/body_paths.h"
#include "physics/stages/namespace.h"
#include "physics/state/impact_memory.h"

namespace embody::physics::stages {

/// Which contacts close as fast as an impact does, and when, on the paths that their bodies take through the step. A
/// view of the world, made anew each step; its memory is the world's.
class ImpactPaths {
public:
    using Prediction = ImpactPrediction;
    static constexpr double never = Prediction::never;

    ImpactPaths(const ImpactAccess& world, const BodyPaths& bodies);

    /// The last impact of either body in this step, s.
    [[nodiscard]] double earliest_time(const Contact& contact) const;
    /// Gap of a point and its rate, the turning of the bodies included: a foot of a spinning chair does not move
    /// straight. m, m/s.
    struct Gap {
        double size = 0, rate = 0;
    };
    using Gaps = std::array<Gap, Manifold::max_points>;
    /// Of the contact's points, in their order.
    [[nodiscard]] Gaps gaps_at(const Contact& contact, double time) const;

    [[nodiscard]] Material material_of(const Contact& contact) const;
    /// Whether the contact has a bounce, and neither body has bounced so often in this step that hardly any speed is
    /// left of the first one (Zeno's ball).
    [[nodiscard]] bool bounces(const Contact& contact) const;
    void note_bounce(const Contact& contact);
    [[nodiscard]] std::size_t max_pile_bounces() const { return max_pile_bounces_; }
    /// Whether the contact is with a body that others carry: one of many contacts that stop the impact together.
    [[nodiscard]] bool hits_pile(const Contact& contact) const;
    [[nodiscard]] const ImpactSettings& settings() const { return settings_; }
    /// Whether no point can close as fast as an impact does: true for most contacts of a pile at rest, by what the
    /// touch stage noted of them. Holds for bodies that had no impact in this step.
    [[nodiscard]] bool is_surely_slow(const ContactSummary& summary) const;

    /// Along straight paths: certain for bodies that stay away or are slow, and accurate enough for bodies that hit a
    /// pile. Points that close as fast as an impact but meet after the step are the next step's impact: they are left
    /// open, so that the substeps do not brake the bodies before.
    Prediction predict_straight(Contact& contact);
    Prediction predict_exactly(Contact& contact);
    Prediction predict(Contact& contact) {
        const Prediction straight = predict_straight(contact);
        return straight.is_certain ? straight : predict_exactly(contact);
    }
    /// Whether the body turns so far in the step that its path must be known exactly for a prediction.
    [[nodiscard]] bool turns_far(std::uint32_t body) const;
    /// The surfaces `pass` each other in this step: leaves open all points that are apart now.
    void leave_open(Contact& contact);

private:
    struct Motion : BodyPaths::Motion {
        Vec3 tilt;  ///< twice its imaginary part, rad: the only effect of a round body's turning on its contacts
    };
    [[nodiscard]] Motion motion_at(std::uint32_t body, double time) const;
    [[nodiscard]] double slowest_speed(const Contact& contact) const;
    [[nodiscard]] Gap gap_at(const Contact& contact, const ContactPoint& point, double time) const;
    [[nodiscard]] double touch_time(const Contact& contact, const ContactPoint& point, double start, Gap first,
                                    Gap last) const;
    /// How far the true paths of the contact's points can leave the straight ones, m, and how much faster they can
    /// become, m/s.
    struct Deviation {
        double distance, speed;
    };
    [[nodiscard]] Deviation deviation_of(const Contact& contact, const Motion& a, const Motion& b) const;
    [[nodiscard]] bool keeps_apart(const Contact& contact, double start) const;

    const ImpactAccess world_;
    const BodyPaths& bodies_;
    ImpactMemory& memory_;
    const double step_, substep_;
    const ImpactSettings& settings_;
    const std::size_t max_pile_bounces_;  ///< in a step
};

}  // namespace embody::physics::stages
