// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "physics/inter/world.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// Where a ray meets a surface.
struct SurfaceHit {
    double distance = 0;  ///< m along the ray
    Vec3 normal;          ///< unit, outwards
};

class Liquids;

/// What stands for an entity that is not one body: many points, whatever physics moves them. The world that they are in
/// outlives them; the destructor takes them out of it. What only one kind can is its own: SoftNodes, FluidBody.
class MovingPoints {
public:
    MovingPoints() = default;
    MovingPoints(const MovingPoints&) = delete;
    MovingPoints& operator=(const MovingPoints&) = delete;
    virtual ~MovingPoints() = default;

    /// Where they are now, world, m: always in the same order, and as many, but for drops of liquid that got lost.
    virtual void read(std::vector<Vec3>& positions) const = 0;
    /// Of the ball that is drawn at each, m; 0: they carry the thing's own drawn form.
    [[nodiscard]] virtual double radius() const = 0;
    /// They are drawn as one liquid, each a ball of its volume.
    [[nodiscard]] virtual bool is_liquid() const { return false; }
    [[nodiscard]] virtual Vec3 linear_velocity() const = 0;  ///< of the centre of mass, m/s
    /// Of the rigid thing with as much angular momentum, rad/s.
    [[nodiscard]] virtual Vec3 angular_velocity() const { return {}; }
    /// Of the most awake of them.
    [[nodiscard]] virtual physics::SleepState state() const = 0;
    [[nodiscard]] virtual Vec3 center_of_mass() const = 0;
    [[nodiscard]] virtual double mass() const = 0;  ///< kg
    /// Of all that is drawn.
    [[nodiscard]] virtual Bounds bounds() const = 0;
    /// How far they can move down together until one touches something else, m; nothing if none does within `most`.
    [[nodiscard]] virtual std::optional<double> drop_distance(double most) const = 0;
    /// Where a ray (unit direction) meets the surface of what is no body in the world; nothing where bodies are all
    /// there is.
    [[nodiscard]] virtual std::optional<SurfaceHit> cast_ray(Vec3, Vec3, double) const { return std::nullopt; }
    /// A body to pull at, at or near a place: one of theirs, or a hand that is there until let_go(). Null where there
    /// is none.
    [[nodiscard]] virtual physics::BodyHandle hold(Vec3 position) = 0;
    virtual void let_go() {}

    /// Other matter, masses, damping and the like of the same points; they stay where they are and go on as they move.
    /// The definition is of their own kind and has as many.
    virtual Result<void> set_definition(const PointsDefinition& definition) = 0;
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

/// All of them or none. `world` and `liquids`, its fluids, outlive them.
Result<std::unique_ptr<MovingPoints>> make_points(physics::World& world, Liquids& liquids,
                                                  const PointsDefinition& definition);

}  // namespace embody::scene
