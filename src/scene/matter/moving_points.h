// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "foundation/result.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "physics/inter/world.h"
#include "scene/embody/points_definition.h"

namespace embody::scene {

/// Hit of a ray with a surface.
struct SurfaceHit {
    double distance = 0;  ///< m along the ray
    Vec3 normal;          ///< unit, outwards
};

class Liquids;

/// Points as they are drawn: now, or at a moment of a take.
class ShownPoints {
public:
    virtual ~ShownPoints() = default;
    /// Positions, world, m: always in the same order and of the same number, except for drops of liquid that are lost
    /// or come last, and the nodes that a sheet gets where it tears, which come last.
    virtual void read(std::vector<Vec3>& positions) const = 0;
    /// Radius of the ball that is drawn at each point, m; 0: the points deform the thing's own drawn form.
    [[nodiscard]] virtual double radius() const = 0;
    /// Whether they are drawn as one liquid, each as a ball of its volume.
    [[nodiscard]] virtual bool is_liquid() const { return false; }
    /// Another number whenever points have come or gone.
    [[nodiscard]] virtual std::uint64_t membership() const { return 0; }
    /// Of points that may come or go: their velocities, m/s, in the order of read(); else none.
    virtual void read_velocities(std::vector<Vec3>& velocities) const { velocities.clear(); }
};

/// The points of an entity that is not one body, whatever solver moves them. Their world outlives them; the destructor
/// removes them from it. Functions of only one kind are in its own class: SoftNodes, FluidBody.
class MovingPoints : public ShownPoints {
public:
    MovingPoints() = default;
    MovingPoints(const MovingPoints&) = delete;
    MovingPoints& operator=(const MovingPoints&) = delete;

    [[nodiscard]] virtual Vec3 linear_velocity() const = 0;  ///< of the centre of mass, m/s
    /// Angular velocity of the rigid body with the same angular momentum, rad/s.
    [[nodiscard]] virtual Vec3 angular_velocity() const { return {}; }
    /// Sleep state of the most awake point.
    [[nodiscard]] virtual physics::SleepState state() const = 0;
    [[nodiscard]] virtual Vec3 center_of_mass() const = 0;
    [[nodiscard]] virtual double mass() const = 0;  ///< kg
    /// Bounds of the drawn form; of a liquid without a drop those of where it is to come.
    [[nodiscard]] virtual Bounds bounds() const = 0;
    /// How far they can move down together until one touches another body, m; empty if none does within `max_distance`.
    [[nodiscard]] virtual std::optional<double> drop_distance(double max_distance) const = 0;
    /// Hit of a ray (unit direction) with a surface that is no body in the world; empty if all points are bodies.
    [[nodiscard]] virtual std::optional<SurfaceHit> cast_ray(Vec3, Vec3, double) const { return std::nullopt; }
    /// A body for one more hand to pull at, at or near a place: one of the points, or a body that holds some of them
    /// until let_go(). Null where there is none.
    [[nodiscard]] virtual physics::BodyHandle hold(Vec3 position) = 0;
    /// Ends one hold() that returned this body.
    virtual void let_go(physics::BodyHandle) {}

    /// Changes matter, masses, damping and other properties of the same points; positions and velocities stay. The
    /// definition is of their own kind and has the same number of points.
    virtual Result<void> set_definition(const PointsDefinition& definition) = 0;
    /// Moves all of them as one rigid body; then they are at rest.
    virtual Result<void> move(const Transform& motion) = 0;
    /// Puts each point at a place, m, with a velocity, m/s; in the order of read(). Liquids have as many drops
    /// afterwards; others are refused where the numbers differ.
    virtual Result<void> set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) = 0;
    /// Velocities as of one rigid body that turns about its centre of mass.
    virtual Result<void> set_velocity(Vec3 linear, Vec3 angular) = 0;
    /// Distributed by mass, N s.
    virtual Result<void> apply_impulse(Vec3 impulse) = 0;
    /// Distributed by mass, for the next step, N.
    virtual Result<void> apply_force(Vec3 force) = 0;
    virtual Result<void> set_enabled(bool enabled) = 0;
};

/// Makes all of them or none. `world` and `liquids`, its fluids, outlive them.
Result<std::unique_ptr<MovingPoints>> make_points(physics::World& world, Liquids& liquids,
                                                  const PointsDefinition& definition);

}  // namespace embody::scene
