// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "physics/inter/definitions/body_definition.h"

namespace embody::scene {

/// What stands for an entity that is not one body: many points, whatever physics moves them. The world that they are in
/// outlives them; the destructor takes them out of it.
class MovingPoints {
public:
    MovingPoints() = default;
    MovingPoints(const MovingPoints&) = delete;
    MovingPoints& operator=(const MovingPoints&) = delete;
    virtual ~MovingPoints() = default;

    /// Where they are now, world, m: always as many, in the same order.
    virtual void read(std::vector<Vec3>& positions) const = 0;
    /// Of the ball that is drawn at each, m.
    [[nodiscard]] virtual double radius() const = 0;
    /// Of the most awake of them.
    [[nodiscard]] virtual physics::SleepState state() const = 0;
    [[nodiscard]] virtual Vec3 center_of_mass() const = 0;
    [[nodiscard]] virtual double mass() const = 0;  ///< kg
    /// Of all that is drawn.
    [[nodiscard]] virtual Bounds bounds() const = 0;
    /// How far they can move down together until one touches something else, m; nothing if none does within `most`.
    [[nodiscard]] virtual std::optional<double> drop_distance(double most) const = 0;
    /// The body nearest to a place, to pull at; null where they have none.
    [[nodiscard]] virtual physics::BodyHandle nearest_body(Vec3 position) const = 0;

    /// Carries all of them along as one rigid thing; they are at rest then.
    virtual Result<void> move(const Transform& motion) = 0;
    /// As of one rigid thing that turns about its centre of mass.
    virtual Result<void> set_velocity(Vec3 linear, Vec3 angular) = 0;
    /// Shared out by mass, N s.
    virtual Result<void> apply_impulse(Vec3 impulse) = 0;
    /// Shared out by mass, for the next step, N.
    virtual Result<void> apply_force(Vec3 force) = 0;
    virtual Result<void> set_enabled(bool enabled) = 0;
};

}  // namespace embody::scene
