// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/constraint/namespace.h"
#include "physics/constraint/sweeps/contact_solver.h"
#include "physics/definitions/joint_definition.h"
#include "physics/definitions/settings/joint_settings.h"

namespace embody::physics::constraint {

/// One scalar row of a joint's Jacobian: speed = linear·(v_b − v_a) + angular_b·ω_b − angular_a·ω_a.
struct JointRow {
    Vec3 linear, angular_a, angular_b;
};

inline constexpr int max_joint_rows = 6;  ///< of a rigid body's motion

struct JointRows {
    int count = 0;
    std::array<JointRow, max_joint_rows> rows;
    JointRow free_row;  ///< along the joint coordinate
};

/// What holds a joint's free coordinate in a direct solve.
enum class FreeHold : std::uint8_t { nothing, motor, lower, upper };

/// Impulses of one phase, N s (N m s for turning rows).
struct JointImpulses {
    std::array<double, max_joint_rows> rows{};
    double motor = 0, lower = 0, upper = 0;
    bool are_good = true;  ///< the passes converged: worth a warm start
    FreeHold hold = FreeHold::nothing;
};

/// A joint between two bodies, or between the world and a body, as up to six rows that are solved as one block, and one
/// row along its free coordinate for limits and motor.
struct Joint {
    JointKind kind;
    bool a_is_world = false;
    std::uint32_t a = 0, b = 0;  ///< body slots; a is meaningless for the world
    Transform local_a, local_b;  ///< joint frames relative to the centres of mass, body axes (world for the world)

    int row_count = 0;
    std::array<JointRow, max_joint_rows> rows;
    std::array<std::array<double, max_joint_rows>, max_joint_rows> cholesky{};  ///< lower factor of J M⁻¹ Jᵀ
    JointRow free_row;
    double free_mass = 0;
    std::array<double, max_joint_rows> errors{};  ///< of the rows when they were prepared, m or rad
    Vec3 arm_b;                                   ///< from b's centre of mass to the joint, world, as in the rows

    JointImpulses position_phase, velocity_phase;  ///< warm start, as for contacts
    Vec3 total_linear, total_angular;              ///< impulse on b over the step, torque about b's joint frame
};

JointImpulses& impulses_of(Joint& joint, SolvePhase phase);

/// One phase of a substep in which joints are solved. A view that is valid during the phase.
struct JointPhase {
    SolvePhase phase = SolvePhase::position;
    double substep = 0;  ///< s
    const JointSettings& settings;

    /// Maximum correction of an error in the substep, m or rad.
    [[nodiscard]] double max_correction() const { return settings.max_correction_speed * substep; }
};

/// What a joint's rows are made of, world axes: for one pose of its bodies, or the mean of two.
struct JointGeometry {
    Vec3 arm_a, arm_b;  ///< from the centres of mass to the joint frames
    Vec3 reach_a;       ///< from a's centre of mass to b's joint frame: a slider's directions turn with a
    Vec3 x, y, z;       ///< axes of a's joint frame
    Vec3 axis_b;        ///< X of b's
};
JointGeometry mean_of(const JointGeometry& first, const JointGeometry& second);

struct JointPose {
    JointGeometry geometry;
    std::array<double, max_joint_rows> errors{};  ///< C, one number a row, m or rad
};
/// For given centres of mass and rotations of the bodies; that of the world is the identity.
JointPose pose_joint(const Joint& joint, const Transform& a, const Transform& b);

/// Rows and masses at the bodies' current poses.
void prepare_joint(Joint& joint, std::span<const BodyState> bodies);
/// The joint's block, for solve_joint(). Both bodies immovable: no rows.
void factor_joint(Joint& joint, std::span<const BodyState> bodies);

void warm_start_joint(Joint& joint, SolvePhase phase, std::span<BodyState> bodies);

/// One pass. Returns the largest speed that it still had to correct, m/s or rad/s.
double solve_joint(Joint& joint, const JointPhase& phase, std::span<BodyState> bodies);

// For a direct solve.

JointRows make_rows(const Joint& joint, const JointGeometry& geometry);
/// Gives the joint these rows; masses stay those of its preparation.
void set_rows(Joint& joint, const JointGeometry& geometry);
/// What a unit impulse along the row does to its speed, 1/kg.
double row_response(const Joint& joint, const JointRow& row, std::span<const BodyState> bodies);
bool has_motor(const Joint& joint);
bool has_limit(const Joint& joint);
/// Speed along the row, m/s or rad/s.
double row_speed(const Joint& joint, const JointRow& row, std::span<const BodyState> bodies);
/// Remaining part of an error of which at most `max_correction` is corrected, m or rad.
double rest_of_error(double error, double max_correction);

/// Finds what holds the free coordinate in the next iteration of a direct solve and writes it to the phase's impulses.
/// Returns by how much the speed along the free row is too large, m/s or rad/s: the row corrects it where something
/// holds, else it is changed here already. In the `first` iteration what held goes on holding.
double choose_free_hold(Joint& joint, const JointPhase& phase, bool is_first, std::span<BodyState> bodies);
/// Stores what a direct solve found for the free row.
void add_free_impulse(Joint& joint, SolvePhase phase, double change);

/// Adds the phase's impulses to the totals; after the phase's last pass, before the rows are prepared anew.
void add_to_totals(Joint& joint, SolvePhase phase);
/// As if it had held nothing yet: neither totals nor a warm start.
void forget_impulses(Joint& joint);

/// Hinge angle in (−π, π] or slider displacement; 0 for the others.
double joint_coordinate(const Joint& joint, std::span<const BodyState> bodies);

}  // namespace embody::physics::constraint
