// SPDX-License-Identifier: MIT
#include "physics/definitions/joint_definition.h"

#include <string>

#include "physics/definitions/field_check.h"

namespace embody::physics {

namespace {

Result<void> check_limit_and_motor(const std::optional<JointLimit>& limit, const std::optional<JointMotor>& motor,
                                   double largest, double largest_speed) {
    if (limit) {
        auto result = first_error(check_number("joint.limit.lower", limit->lower, -largest, largest),
                                  check_number("joint.limit.upper", limit->upper, -largest, largest));
        if (!result) return result;
        if (limit->lower > limit->upper) return Error{"joint.limit.lower", "must not be above the upper limit"};
    }
    if (motor) {
        return first_error(check_number("joint.motor.speed", motor->speed, -largest_speed, largest_speed),
                           check_number("joint.motor.max_force", motor->max_force, 0, largest_force));
    }
    return {};
}

Result<void> check_frame(const std::string& field, const Transform& frame) {
    return first_error(check_vector(field + ".position", frame.position, largest_coordinate, "m"),
                       check_rotation(field + ".rotation", frame.rotation));
}

}  // namespace

Result<void> validate(const JointDefinition& definition) {
    if (definition.body_b.is_null()) return Error{"body_b", "must name a body"};
    if (definition.body_a == definition.body_b) return Error{"body_a", "must differ from body_b"};
    auto frames = first_error(check_frame("frame_a", definition.frame_a), check_frame("frame_b", definition.frame_b));
    if (!frames) return frames;

    // An angle is known within one turn only, so its limits lie in ±π.
    constexpr double half_turn = 3.14159265358979323846;
    return std::visit(
        []<class Kind>(const Kind& kind) -> Result<void> {
            if constexpr (HasCoordinate<Kind>) {
                return check_limit_and_motor(kind.limit, kind.motor, Kind::turns ? half_turn : largest_coordinate,
                                             Kind::turns ? largest_angular_speed : largest_linear_speed);
            }
            return {};
        },
        definition.joint);
}

}  // namespace embody::physics
