// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "physics/definitions/joint_definition.h"
#include "scene/document/entity.h"

namespace embody::scene {

/// A joint between two entities, or an entity and the world.
struct SceneJoint {
    std::uint32_t index = 0;
    std::string name;
    std::optional<EntityIndex> entity_a;  ///< empty: the world
    EntityIndex entity_b = 0;
    physics::JointDefinition definition;  ///< its body handles are left null
};

template <>
inline constexpr auto fields_of<physics::JointLimit> = std::tuple{
    always_needed("lower", &physics::JointLimit::lower, "minimum angle or displacement, rad or m"),
    always_needed("upper", &physics::JointLimit::upper, "maximum angle or displacement, rad or m"),
};

template <>
inline constexpr auto fields_of<physics::JointMotor> = std::tuple{
    always_saved("speed", &physics::JointMotor::speed, "rad/s of a hinge, m/s of a slider"),
    always_needed("max_force", &physics::JointMotor::max_force, "N m of a hinge, N of a slider", {.low = 0}),
};

template <>
inline constexpr auto fields_of<physics::HingeJoint> = std::tuple{
    saved_when_set("limit", &physics::HingeJoint::limit, "of the angle"),
    saved_when_set("motor", &physics::HingeJoint::motor, "turns it"),
};

template <>
inline constexpr auto fields_of<physics::SliderJoint> = std::tuple{
    saved_when_set("limit", &physics::SliderJoint::limit, "of the displacement"),
    saved_when_set("motor", &physics::SliderJoint::motor, "moves it"),
};

/// The free directions of a joint.
template <>
inline constexpr auto alternatives_of<physics::JointKind> = names_of(static_cast<const physics::JointKind*>(nullptr));

template <>
inline constexpr auto fields_of<physics::JointDefinition> = std::tuple{
    saved_beside(&physics::JointDefinition::joint),
    never_saved("body_a", &physics::JointDefinition::body_a),
    never_saved("body_b", &physics::JointDefinition::body_b),
    always_saved("frame_a", &physics::JointDefinition::frame_a, "the joint's frame in `entity_a`, or in the world"),
    always_saved("frame_b", &physics::JointDefinition::frame_b, "the joint's frame in `entity_b`"),
    always_saved("bodies_collide", &physics::JointDefinition::bodies_collide, "whether the two touch each other"),
};

template <>
inline constexpr auto fields_of<SceneJoint> = std::tuple{
    always_saved("index", &SceneJoint::index, "the joint's number, once in a file", index_range),
    always_saved("name", &SceneJoint::name, "what people call it"),
    saved_when_set("entity_a", &SceneJoint::entity_a, "index, or a name that only one entity has; without, the world",
                   index_range),
    always_needed("entity_b", &SceneJoint::entity_b,
                  "the entity that the joint holds: its index, or a name that only one entity has", index_range),
    saved_beside(&SceneJoint::definition),
};

}  // namespace embody::scene
