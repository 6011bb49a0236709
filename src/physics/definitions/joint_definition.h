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

// `name` is the joint's in scene files. A joint with a limit and a motor has a free coordinate on the X axis of the
// joint frames; `turns` says whether that is an angle about it or a displacement along it.

/// No relative motion.
struct FixedJoint {
    static constexpr const char* name = "fixed";
};
/// Three rotations free about the common point.
struct BallJoint {
    static constexpr const char* name = "ball";
};
/// One rotation free about the X axis of the joint frames.
struct HingeJoint {
    static constexpr const char* name = "hinge";
    static constexpr bool turns = true;
    std::optional<JointLimit> limit;
    std::optional<JointMotor> motor;
};
/// One translation free along the X axis of the joint frames.
struct SliderJoint {
    static constexpr const char* name = "slider";
    static constexpr bool turns = false;
    std::optional<JointLimit> limit;
    std::optional<JointMotor> motor;
};
using JointKind = std::variant<FixedJoint, BallJoint, HingeJoint, SliderJoint>;

template <class Kind>
concept HasCoordinate = requires(Kind kind) {
    kind.limit;
    kind.motor;
};

/// Null where the kind has none.
inline const std::optional<JointLimit>* limit_of(const JointKind& joint) {
    return std::visit(
        []<class Kind>(const Kind& kind) -> const std::optional<JointLimit>* {
            if constexpr (HasCoordinate<Kind>) return &kind.limit;
            return nullptr;
        },
        joint);
}
inline const std::optional<JointMotor>* motor_of(const JointKind& joint) {
    return std::visit(
        []<class Kind>(const Kind& kind) -> const std::optional<JointMotor>* {
            if constexpr (HasCoordinate<Kind>) return &kind.motor;
            return nullptr;
        },
        joint);
}

struct JointDefinition {
    JointKind joint;
    BodyHandle body_a;            ///< null: the world
    BodyHandle body_b;            ///< not null, not body_a
    Transform frame_a;            ///< joint frame in body_a's frame (in the world, where body_a is null)
    Transform frame_b;            ///< joint frame in body_b's frame
    bool bodies_collide = false;  ///< whether the two jointed bodies touch each other
};

/// The error's `where` is the field.
Result<void> validate(const JointDefinition& definition);

}  // namespace embody::physics
