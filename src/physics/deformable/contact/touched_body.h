// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "math/transform.h"
#include "physics/collision/shapes/collision_shape.h"
#include "physics/definitions/material.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// What bears a body on the rigid side: a point of contact with something that does not give way, or a joint to it
/// (docs/physics/coupling.md). Forces are those of the body on what bears it, N.
struct BodySupport {
    Vec3 anchor;                   ///< on the body, from its centre of mass when the step began, m
    bool is_joint = false;         ///< holds in both directions
    Mat3 held = Mat3::identity();  ///< of a joint: projection onto the directions that it holds, when the step began
    bool turns = true;             ///< the anchor turns with the body; else the body rolls on it
    Vec3 normal;                   ///< of a contact: unit, towards what bears the body
    double gap = 0;                ///< when the step began, m
    Vec3 velocity;                 ///< of what bears it, m/s
    PairFriction friction;
    bool sticks = true;
    Vec3 path_force;    ///< mean over the body's path; of a joint: 0, for only changes count
    Vec3 force;         ///< in the last solve
    Vec3 given;         ///< that the body's motion includes in this substep
    Vec3 impulse;       ///< of the group that is being solved, in this substep so far, N s
    Vec3 past_impulse;  ///< of the motion in the substeps before this one, N s
};

/// A rigid body near a deformable. It has made its step already: through the substeps it moves along the path of that
/// step and, in addition, by the nodes' pushes.
struct TouchedBody {
    std::uint32_t body = 0;  ///< slot
    const CollisionShape* shape = nullptr;
    Material material;           ///< of its surface
    Transform start;             ///< pose of the shape's frame when the step began
    Vec3 start_center;           ///< of mass, when the step began, m
    double step_time = 0;        ///< of the whole step, s
    Vec3 path_velocity;          ///< mean over the step, m/s
    Vec3 path_acceleration;      ///< mean over the step, m/s²: the path is a parabola
    Vec3 path_spin;              ///< mean over the step, rad/s
    Vec3 path_spin_up;           ///< mean over the step, rad/s²
    Vec3 path_turn;              ///< the turn of the step as the argument of cayley(), over the step's time, 1/s
    bool is_dynamic = true;      ///< else pushes have no effect on it
    bool touches_solid = false;  ///< or may in this step
    bool is_borne = false;       ///< others push it on the rigid side, or a joint holds it: `supports` has some of them
    double inverse_mass = 0;
    Mat3 inverse_inertia = Mat3::zero();   ///< world axes
    Vec3 expected_force, expected_torque;  ///< pushes of the last step, which the path includes already, N and N m
    Vec3 expected_late_force, expected_late_torque;  ///< the part of these that acts for the whole step at its end

    std::vector<BodySupport> supports;
    Vec3 borne_force, borne_torque;  ///< of these on the body along its path, N and N m
    bool is_off_path = false;  ///< pushes of the last step were taken off in this substep, and so were these forces
    bool is_settled = false;   ///< a solve of this substep included the supports
    bool is_open = false;      ///< what the supports did in it is not in `given` yet

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
    /// Displacement of the point at `anchor` (from the centre of mass when the step began) on the path alone, since
    /// then. `turns`: with the body.
    [[nodiscard]] Vec3 path_displacement(double time, Vec3 anchor, bool turns) const;
    /// Displacement of the point at `arm` from its centre in the substep of h seconds that ends at `time`, m.
    [[nodiscard]] Vec3 displacement(double h, double time, Vec3 arm) const;
    /// Of its supports, which are complete.
    void set_borne_forces();
    /// Moves it into a substep of h seconds: takes off the pushes that the path includes already, and with these the
    /// forces of what bears it: both may be a thousand times the weight of a light body, their sum is not. Goes on with
    /// the rest.
    void enter_substep(double h);
    /// After the last of `substeps`, before the deformables that push it once for the whole step: a push that is
    /// applied at once moves it further than one taken off in parts, so the rest of the displacement is taken off here.
    void enter_whole_step(int substeps);
    /// Takes it back from the end of a substep of h seconds to that of its first part.
    void return_to_part(double h, double part);
    /// Goes on for another part, of that length, s.
    void enter_part(double part);
    /// Impulse (N s) at `arm` (m) from its centre of mass, in a substep of h seconds: moves it too.
    void push(Vec3 impulse, Vec3 arm, double h);
    /// As push(), by what bears the body: deformables do not push it by that.
    void bear(Vec3 impulse, Vec3 arm, double h);
    /// After a group of deformables is solved for a substep of h seconds: its motion includes what the supports did.
    void close_supports(double h);
    /// Angular impulse (N m s) in a substep of h seconds.
    void push_turn(Vec3 angular_impulse, double h);

private:
    [[nodiscard]] bool is_pushed_on_path() const { return expected_force != Vec3{} || expected_torque != Vec3{}; }
    void move(Vec3 impulse, Vec3 angular_impulse, double h);
    [[nodiscard]] Mat3 rotation_on_path(double time, Vec3 off) const;
    // A path of constant acceleration differs from the straight one by this times the acceleration, s².
    [[nodiscard]] double bend(double time) const { return time * (time - step_time) / 2; }
};

}  // namespace embody::physics::deformable
