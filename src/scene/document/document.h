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
#include "scene/document/field_list.h"

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

using Geometry = std::variant<ModelReference, physics::ShapeDefinition>;

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
    Geometry geometry;  ///< the paper's GeomAttr (definition 3)
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

/// What an entity's field is called in files and messages; its geometry there is "model" or "shape".
template <>
inline constexpr auto fields_of<Entity> = std::tuple{
    always_saved("index", &Entity::index, {1, last_document_index}),
    always_saved("name", &Entity::name),
    always_saved("geometry", &Entity::geometry),
    saved_when_set("attributes", &Entity::attributes),
    always_saved("pose", &Entity::pose),
    saved_when_set("linear_velocity", &Entity::linear_velocity),
    saved_when_set("angular_velocity", &Entity::angular_velocity),
    saved_when_set("force", &Entity::force),
    saved_when_set("torque", &Entity::torque),
    saved_when_set("enabled", &Entity::enabled),
    saved_when_set("start_asleep", &Entity::start_asleep),
    saved_when_set("allow_sleep", &Entity::allow_sleep),
    saved_when_set("continuous", &Entity::continuous),
    saved_when_set("category", &Entity::category),
    saved_when_set("color", &Entity::color),
    saved_when_set("scale", &Entity::scale, {1e-4, 1e4}),
    saved_when_set("pins", &Entity::pins),
};
static_assert(lists_all_members<Entity>(), "a member of Entity is in no list, or one is there twice");

/// A joint between two entities, or an entity and the world.
struct SceneJoint {
    std::uint32_t index = 0;
    std::string name;
    std::optional<EntityIndex> entity_a;  ///< open: the world
    EntityIndex entity_b = 0;
    physics::JointDefinition definition;  ///< its body handles are left null
};

/// Where the eye is and what it looks at.
struct Camera {
    Vec3 position{4, 3, 6};
    Vec3 target;
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// What belongs to a document as a whole.
struct Heading {
    std::string title = "Untitled";
    std::string description;
    physics::WorldSettings settings{.workers = 0};
    std::optional<Camera> camera;  ///< to open the scene with
};

template <>
inline constexpr auto fields_of<Heading> = std::tuple{
    always_saved("title", &Heading::title),
    saved_when_set("description", &Heading::description),
    always_saved("settings", &Heading::settings),
    saved_when_set("camera", &Heading::camera),
};
static_assert(lists_all_members<Heading>(), "a member of Heading is in no list, or one is there twice");

/// The settings of the physics that a scene has. Their ranges are validate()'s to judge.
template <>
inline constexpr auto fields_of<physics::WorldSettings> = std::tuple{
    always_saved("gravity", &physics::WorldSettings::gravity),
    always_saved("time_step", &physics::WorldSettings::time_step),
    always_saved("substeps", &physics::WorldSettings::substeps, {1, 64}),
    always_saved("wind", &physics::WorldSettings::wind),
    always_saved("gustiness", &physics::WorldSettings::gustiness),
    always_saved("gust_time", &physics::WorldSettings::gust_time),
    always_saved("air_density", &physics::WorldSettings::air_density),
    never_saved("deformable_substeps", &physics::WorldSettings::deformable_substeps),
    always_saved("time_to_sleep", &physics::WorldSettings::time_to_sleep),
    always_saved("sleeping", &physics::WorldSettings::sleeping),
    always_saved("shock_propagation", &physics::WorldSettings::shock_propagation),
    always_saved("max_linear_speed", &physics::WorldSettings::max_linear_speed),
    always_saved("max_angular_speed", &physics::WorldSettings::max_angular_speed),
    never_saved("workers", &physics::WorldSettings::workers),
    never_saved("lanes", &physics::WorldSettings::lanes),
    never_saved("solver", &physics::WorldSettings::solver),
};
static_assert(lists_all_members<physics::WorldSettings>(), "a setting is in no list, or one is there twice");

/// The paper's VS = {VSEle_i} (definition 1) with what acts in it. A plain value: copy, compare, save.
struct Document : Heading {
    std::vector<Entity> entities;    ///< ascending index
    std::vector<SceneJoint> joints;  ///< ascending index
    std::vector<Action> actions;     ///< ascending id

    [[nodiscard]] const Entity* find(EntityIndex index) const;
    [[nodiscard]] Entity* find(EntityIndex index);
    [[nodiscard]] const SceneJoint* find_joint(std::uint32_t index) const;
    /// One more than the highest index ever used here.
    EntityIndex next_index = 1;
};

}  // namespace embody::scene
