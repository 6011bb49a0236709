// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "attributes/attribute.h"
#include "math/transform.h"
#include "physics/definitions/joint_definition.h"
#include "physics/definitions/shape_definition.h"
#include "physics/definitions/world_settings.h"
#include "scene/document/action.h"

namespace embody::scene {

/// Names an entity of a document for as long as the document lives; never used twice.
using EntityIndex = std::uint32_t;
/// Higher ones are for what actions spawn in a running simulation. Joints and actions have none higher either.
inline constexpr EntityIndex last_document_index = 0x7FFFFFFF;
/// Of one document: more would fill the memory before they were simulated.
inline constexpr std::size_t most_entities = 300'000;

/// A model of the database, by its key.
struct ModelReference {
    std::string key;
    friend bool operator==(const ModelReference&, const ModelReference&) = default;
};

/// Where a thing that changes its form is held: its points within a distance of a place stay where they are, in the
/// world or in another entity.
struct Pin {
    Vec3 position;                  ///< in the entity's frame, m
    double radius = 0.01;           ///< m; where it catches no point, the nearest is held
    std::optional<EntityIndex> to;  ///< a rigid entity; open: the world
    bool clamped = false;           ///< of a rope: holds its direction and twist too
    friend bool operator==(const Pin&, const Pin&) = default;
};

/// The paper's VSEle = {index, GeomAttr, PhyAttr} (definition 2): what it looks like, what it is made of, where it is.
struct Entity {
    EntityIndex index = 0;
    std::string name;
    std::variant<ModelReference, physics::ShapeDefinition> geometry;  ///< the paper's GeomAttr (definition 3)
    /// Manual attributes of this entity by registry name; everything else comes from the model or the defaults
    /// (definition 4, 5).
    std::map<std::string, attributes::AttributeValue> attributes;
    Transform pose;
    Vec3 linear_velocity;   ///< of the centre of mass at the start, m/s
    Vec3 angular_velocity;  ///< rad/s
    Vec3 force;             ///< constant, N, world axes, at the centre of mass
    Vec3 torque;            ///< constant, N m
    bool enabled = true;
    bool start_asleep = false;
    bool allow_sleep = true;
    bool continuous = false;                     ///< sweep fast motion
    std::string category;                        ///< of primitives, for actions; models bring theirs
    std::optional<std::array<double, 3>> color;  ///< of primitives, linear RGB 0 … 1
    double scale = 1;                            ///< of a model, uniform, > 0
    std::vector<Pin> pins;                       ///< of one of kind soft
};

/// A joint between two entities, or an entity and the world.
struct SceneJoint {
    std::uint32_t index = 0;
    std::string name;
    std::optional<EntityIndex> entity_a;  ///< open: the world
    EntityIndex entity_b = 0;
    physics::JointDefinition definition;  ///< its body handles are left null
};

/// The paper's VS = {VSEle_i} (definition 1) with what acts in it. A plain value: copy, compare, save.
struct Document {
    std::string title = "Untitled";
    std::string description;
    physics::WorldSettings settings{.workers = 0};
    std::vector<Entity> entities;                 ///< ascending index
    std::vector<SceneJoint> joints;               ///< ascending index
    std::vector<Action> actions;                  ///< ascending id
    std::optional<std::pair<Vec3, Vec3>> camera;  ///< position and target to open the scene with

    [[nodiscard]] const Entity* find(EntityIndex index) const;
    [[nodiscard]] Entity* find(EntityIndex index);
    [[nodiscard]] const SceneJoint* find_joint(std::uint32_t index) const;
    /// One more than the highest index ever used here.
    EntityIndex next_index = 1;
};

}  // namespace embody::scene
