// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/collision/queries/ball_touch.h"
#include "physics/constraint/contact/contact.h"
#include "physics/constraint/namespace.h"
#include "physics/constraint/rolling/rolling_ball.h"
#include "physics/definitions/settings/rolling_settings.h"
#include "physics/dynamic/body_state.h"

namespace embody::physics::constraint {

/// Where a ball that rolls on still ground ends the step.
struct RolledBall {
    std::uint32_t body = 0;
    std::uint32_t contact = 0;    ///< index of the contact whose normal is closest to the final one
    std::uint32_t candidate = 0;  ///< the caller's number of it
    BodyState state;
    Vec3 impulse;  ///< of the ground, N s
};

/// The ball in motion.
struct BallPlace {
    Vec3 center;
    Quat rotation;
    BallMotion motion;
    BallTouch touch;
    std::size_t ground = 0;
    double centripetal = 0;  ///< v · dn/dt in the last part, m/s²: what the curvature of the ground asks for
    bool rolls = false;
};

/// What a ball may touch, and where it is close to touching, while its path is followed.
struct BallSurroundings {
    struct Ground {
        std::uint32_t body = 0;
        const CollisionShape* shape = nullptr;
        Transform pose;
        BallFriction friction;
    };
    std::vector<Ground> grounds;
    std::vector<BallTouch> touches;
    std::vector<std::size_t> ground_of;  ///< by touch
};

/// A ball, and what the step knows of it. Nothing is copied.
struct BallInStep {
    std::uint32_t body = 0;
    const BodyState& state;
    const BodyConstants& constants;
    const CollisionShape& shape;
    double radius = 0;                      ///< m
    std::span<const Contact> all_contacts;  ///< of the world
    std::span<const std::uint32_t> own;     ///< which of them it has with still ground
    double step = 0;                        ///< s
    int substeps = 1;
    const RollingSettings& settings;
};

/// A ball that rolls or slides along still ground. The surroundings are memory of the caller, who lists the grounds.
class BallPath {
public:
    BallPath(const BallInStep& ball, BallSurroundings& surroundings);

    /// Follows the ball alone through the whole step. False, without a result, where it lifts off, hits something, has
    /// come to rest or moves on level ground.
    bool roll(RolledBall& rolled);

    // The same in parts, beside other balls. Each returns false where the ball does not stay on the ground.

    /// At the step's start. A ball beside others rolls on however slow it is.
    bool begin(BallPlace& at, bool has_company);
    [[nodiscard]] int count_parts(const BallPlace& at) const;
    /// Finds the ground's curvature by a trial part of this time (s), where the touch does not have it.
    bool see_curvature(BallPlace& at, double part);
    bool advance(BallPlace& at, double time);
    /// The end of the step. `received`: impulse of other bodies than the ground, N s.
    bool write(const BallPlace& at, Vec3 received, RolledBall& rolled) const;
    [[nodiscard]] double mass() const { return mass_; }

private:
    void find(Vec3 center, double margin);
    [[nodiscard]] bool is_flat(const BallPlace& at) const;
    bool is_plain(const BallPlace& at);
    [[nodiscard]] double load(const BallPlace& at) const;
    bool leaves(const BallPlace& at);
    bool hit(BallPlace& at, Vec3 last_normal);
    bool settle(BallPlace& at, const Vec3* last_normal, double margin);
    double move_along_plane(const BallPlace& from, BallPlace& to, double pressing, double time) const;
    std::optional<double> turn_or_hit(BallPlace& at, Vec3 last_normal, double time);
    bool advance(BallPlace& at, double time, int halvings);

    const BallInStep ball_;
    const RollingSettings& limits_;
    const BallPathSettings& settings_;
    const BodyState& state_;
    const double step_, radius_;
    const Vec3 acceleration_;
    const double mass_;
    bool was_touching_ = false, bounces_ = false, resists_ = false;
    std::vector<BallSurroundings::Ground>& grounds_;
    std::vector<BallTouch>& touches_;
    std::vector<std::size_t>& ground_of_;
};

}  // namespace embody::physics::constraint
