// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "math/mat3.h"
#include "math/transform.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/definitions/material.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// A rigid body near a deformable. It has made its step already: through the substeps it moves along the path of that
/// step and, in addition, by the nodes' pushes.
struct TouchedBody {
    std::uint32_t body = 0;  ///< slot
    const CollisionShape* shape = nullptr;
    Material material;       ///< of its surface
    Transform start;         ///< pose of the shape's frame when the step began
    Vec3 start_center;       ///< of mass, when the step began, m
    double step_time = 0;    ///< of the whole step, s
    Vec3 path_velocity;      ///< mean over the step, m/s
    Vec3 path_acceleration;  ///< mean over the step, m/s²: the path is a parabola
    Vec3 path_spin;          ///< mean over the step, rad/s
    Vec3 path_spin_up;       ///< mean over the step, rad/s²
    Vec3 path_turn;          ///< the turn of the step as the argument of cayley(), over the step's time, 1/s
    bool is_dynamic = true;  ///< else pushes have no effect on it
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::zero();   ///< world axes
    Vec3 expected_force, expected_torque;  ///< pushes of the last step, which the path includes already, N and N m
    Vec3 expected_late_force, expected_late_torque;  ///< the part of these that acts for the whole step at its end

    Vec3 shift, turn;                         ///< displacement off the path so far, m and rad
    Vec3 velocity, spin;                      ///< velocities beyond the path's, m/s and rad/s
    Vec3 impulse, angular_impulse;            ///< pushes of this step so far, N s and N m s about the centre of mass
    Vec3 late_impulse, late_angular_impulse;  ///< the part of these for the whole step

    /// Pose of the body `time` (s) after the step began, with pushes.
    [[nodiscard]] Vec3 center_at(double time) const {
        return start_center + time * path_velocity + bend(time) * path_acceleration + shift;
    }
    /// What turns directions of the start to those then.
    [[nodiscard]] Mat3 rotation_at(double time) const { return rotation_on_path(time, turn); }
    /// The same at the start of the substep of h seconds that ends at `time`, without the pushes in it.
    [[nodiscard]] Vec3 center_before(double h, double time) const {
        return start_center + (time - h) * path_velocity + bend(time - h) * path_acceleration + shift - h * velocity;
    }
    [[nodiscard]] Mat3 rotation_before(double h, double time) const {
        return rotation_on_path(time - h, turn - h * spin);
    }
    /// Displacement of the point at `arm` from its centre in the substep of h seconds that ends at `time`, m.
    [[nodiscard]] Vec3 displacement(double h, double time, Vec3 arm) const;
    /// Moves it into a substep of h seconds: takes off the pushes that the path includes already, goes on with the
    /// rest.
    void enter_substep(double h);
    /// After the last of `substeps`, before the deformables that push it once for the whole step: a push that is
    /// applied at once moves it further than one taken off in parts, so the rest of the displacement is taken off here.
    void enter_whole_step(int substeps);
    /// Impulse (N s) at `arm` (m) from its centre of mass, in a substep of h seconds: moves it too.
    void push(Vec3 impulse, Vec3 arm, double h);
    /// Angular impulse (N m s) in a substep of h seconds.
    void push_turn(Vec3 angular_impulse, double h);

private:
    [[nodiscard]] Mat3 rotation_on_path(double time, Vec3 off) const;
    // A path of constant acceleration differs from the straight one by this times the acceleration, s².
    [[nodiscard]] double bend(double time) const { return time * (time - step_time) / 2; }
};

/// Moves bodies through the parts of a substep: the effect of earlier parts' pushes continues in the next.
class PartPushes {
public:
    /// Before the first part.
    explicit PartPushes(std::span<const TouchedBody> bodies);
    /// Before each further one, of h seconds.
    void go_on(std::span<TouchedBody> bodies, double h) const;

private:
    std::vector<std::pair<Vec3, Vec3>> velocities_;  // displacement off the path, and spins
};

}  // namespace embody::physics::deformable
