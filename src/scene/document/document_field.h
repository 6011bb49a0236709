// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"

namespace embody::scene {

// Physics refuses a value by the name of the field in its own definition. These functions return the scene file's name
// of the field, so that a person finds it there. A name that is the same in both, or is the scene file's already,
// stays.

/// Field with a component of a vector: "gravity.y" is "gravity[1]".
std::string document_field(std::string field);
/// Field of an entity: "position.y" is "pose.position[1]", "material.restitution" is "attributes.restitution".
std::string entity_field(const std::string& field);
/// Field of a joint: "joint.motor.speed" is "motor.speed", "body_a" is "entity_a".
std::string joint_field(const std::string& field);

/// `error` with the name of a place (a file, an entity or a joint; may be empty) before its field.
Error in_place(const std::string& place, Error error);

}  // namespace embody::scene
