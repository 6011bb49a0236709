// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "physics/constraint/contact_solver.h"
#include "physics/inter/definitions/joint_definition.h"

namespace embody::physics {

/// One scalar row of a joint's Jacobian: speed = linear·(v_b − v_a) + angular_b·ω_b − angular_a·ω_a.
struct JointRow {
    Vec3 linear, angular_a, angular_b;
};

inline constexpr int max_joint_rows = 6;

/// Impulses of one phase, N s (N m s for turning rows).
struct JointImpulses {
    std::array<double, max_joint_rows> rows{};
    double motor = 0, lower = 0, upper = 0;
    bool are_good = true;  ///< the passes came to an end: worth a warm start
};

/// A joint between two bodies, or between the world and a body, as up to six rows that are solved as one block, and one
/// row along its free coordinate for limits and motor.
struct Joint {
    std::variant<FixedJoint, BallJoint, HingeJoint, SliderJoint> kind;
    bool a_is_world = false;
    std::uint32_t a = 0, b = 0;  ///< body slots; a is meaningless for the world
    Transform local_a, local_b;  ///< joint frames relative to the centres of mass, body axes (world for the world)

    int row_count = 0;
    std::array<JointRow, max_joint_rows> rows;
    std::array<std::array<double, max_joint_rows>, max_joint_rows> cholesky{};  ///< lower factor of J M⁻¹ Jᵀ
    JointRow free_row;
    double free_mass = 0;
    std::array<double, max_joint_rows> errors{};  ///< of the rows when they were prepared, m or rad
    Vec3 arm_b;                                   ///< from b's centre of mass to the joint, world

    JointImpulses position_phase, velocity_phase;  ///< warm start, as for contacts
    Vec3 total_linear, total_angular;              ///< impulse on b over the step, torque about b's joint frame
};

JointImpulses& impulses_of(Joint& joint, SolvePhase phase);

/// Rows and masses at the bodies' current poses. Both bodies immovable: no rows.
void prepare_joint(Joint& joint, std::span<const BodyState> bodies);

void warm_start_joint(Joint& joint, SolvePhase phase, std::span<BodyState> bodies);

/// One pass. Returns the largest speed that it still had to correct, m/s or rad/s.
double solve_joint(Joint& joint, SolvePhase phase, double substep, std::span<BodyState> bodies);

/// Adds the phase's impulses to the totals; after the phase's last pass, before the rows are prepared anew.
void add_to_totals(Joint& joint, SolvePhase phase);

/// Hinge angle in (−π, π] or slider displacement; 0 for the others.
double joint_coordinate(const Joint& joint, std::span<const BodyState> bodies);

}  // namespace embody::physics
