// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "foundation/result.h"

namespace embody::scene {

// Physics refuses a value by the name of the field in its own definition. These say it as the scene file spells it, so
// that a person finds it there. What a scene file spells alike, and what is spelled so already, stays.

/// Of a number of a vector: "gravity.y" is "gravity[1]".
std::string document_field(std::string field);
/// Of an entity: "position.y" is "pose.position[1]", "material.restitution" is "attributes.restitution".
std::string entity_field(const std::string& field);
/// Of a joint: "joint.motor.speed" is "motor.speed", "body_a" is "entity_a".
std::string joint_field(const std::string& field);

/// `error` as seen from outside of a place such as a file, an entity or a joint, whose name (may be empty) goes before
/// its field.
Error in_place(const std::string& place, Error error);

}  // namespace embody::scene
