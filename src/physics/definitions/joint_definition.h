// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <variant>

#include "foundation/result.h"
#include "math/transform.h"
#include "physics/definitions/handles.h"

namespace embody::physics {

/// Lower and upper bound of a joint coordinate: rad for hinges, m for sliders; lower <= upper.
struct JointLimit {
    double lower = 0, upper = 0;
};
/// Drives the joint coordinate at `speed` with at most `max_force` (N, or N m for a hinge).
struct JointMotor {
    double speed = 0;
    double max_force = 0;
};

/// No relative motion.
struct FixedJoint {};
/// Three rotations free about the common point.
struct BallJoint {};
/// One rotation free about the X axis of the joint frames.
struct HingeJoint {
    std::optional<JointLimit> limit;
    std::optional<JointMotor> motor;
};
/// One translation free along the X axis of the joint frames.
struct SliderJoint {
    std::optional<JointLimit> limit;
    std::optional<JointMotor> motor;
};

struct JointDefinition {
    std::variant<FixedJoint, BallJoint, HingeJoint, SliderJoint> joint;
    BodyHandle body_a;            ///< null: the world
    BodyHandle body_b;            ///< not null, not body_a
    Transform frame_a;            ///< joint frame in body_a's frame (in the world, where body_a is null)
    Transform frame_b;            ///< joint frame in body_b's frame
    bool bodies_collide = false;  ///< whether the two jointed bodies touch each other
};

/// The error's `where` is the field.
Result<void> validate(const JointDefinition& definition);

}  // namespace embody::physics
