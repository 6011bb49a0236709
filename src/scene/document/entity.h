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
#include "foundation/shared_optional.h"
#include "math/transform.h"
#include "physics/definitions/shape_definition.h"
#include "scene/document/field_list.h"
#include "scene/document/kept_form.h"

namespace embody::scene {

/// Names an entity of a document for the lifetime of the document; never used twice.
using EntityIndex = std::uint32_t;
/// Higher indices are for entities that actions spawn in a running simulation. Indices of joints and actions are not
/// higher either.
inline constexpr EntityIndex last_document_index = 0x7FFFFFFF;
inline constexpr NumberRange index_range{.low = 1, .high = last_document_index};

/// A model of the database, by its key.
struct ModelReference {
    std::string key;
    friend bool operator==(const ModelReference&, const ModelReference&) = default;
};

using Geometry = std::variant<ModelReference, physics::ShapeDefinition>;

/// Holds a deformable thing: its points within a distance of a place stay there, in the world or in another entity.
struct Pin {
    Vec3 position;
    double radius = 0.01;
    std::optional<EntityIndex> to;
    bool clamped = false;
    friend bool operator==(const Pin&, const Pin&) = default;
};

template <>
inline constexpr auto fields_of<Pin> = std::tuple{
    always_needed("position", &Pin::position, "the place that is held, in the entity's frame", {.unit = "m"}),
    always_saved("radius", &Pin::radius, "the points so near to the place are held; where there are none, the nearest",
                 {0, 1e4, "m"}),
    saved_when_set("to", &Pin::to, "index of the entity that holds it; without, the world", index_range),
    saved_when_set("clamped", &Pin::clamped, "of a rope: holds its direction and twist too"),
};
static_assert(lists_all_members<Pin>(), "a member of Pin is in no list, or one is there twice");

/// What a surface looks like over its own colour; drawn, never felt.
enum class Finish : std::uint8_t { plain, parquet, tiles, concrete, plaster, brick, grass, fabric };
/// Their names in files, in the order of the values.
inline constexpr std::array finish_names{"plain",   "parquet", "tiles", "concrete",
                                         "plaster", "brick",   "grass", "fabric"};

/// The light of a lamp, drawn about its middle.
struct Light {
    double lumen = 0;
    double kelvin = 2700;
    bool on = true;
    friend bool operator==(const Light&, const Light&) = default;
};

template <>
inline constexpr auto fields_of<Light> = std::tuple{
    always_saved("lumen", &Light::lumen, "how much light it gives; 0: it is no lamp", {0, 1e6, "lm"}),
    always_saved("kelvin", &Light::kelvin, "colour temperature: 2700 is warm, 6500 daylight", {1000, 20000, "K"}),
    always_saved("on", &Light::on, "whether it is switched on"),
};
static_assert(lists_all_members<Light>(), "a member of Light is in no list, or one is there twice");

/// A source of liquid on an entity; the liquid leaves it along the entity's -Y.
struct Tap {
    double litres_per_minute = 0;
    double radius = 0.01;
    double speed = 0;
    Vec3 position;
    EntityIndex liquid = 0;
    bool open = true;
    friend bool operator==(const Tap&, const Tap&) = default;
};

template <>
inline constexpr auto fields_of<Tap> = std::tuple{
    always_saved("litres_per_minute", &Tap::litres_per_minute, "how much comes; 0: it is no tap", {0, 6e5, "l/min"}),
    always_saved("radius", &Tap::radius, "of the mouth, a disc across the entity's -Y, along which the liquid comes",
                 {0, 10, "m"}),
    always_saved("speed", &Tap::speed,
                 "at which it comes; 0: that which fills the mouth. A higher one makes drops, as a shower",
                 {0, 100, "m/s"}),
    always_saved("position", &Tap::position, "of the middle of the mouth, in the entity's frame, outside of solids",
                 {.unit = "m"}),
    always_saved("liquid", &Tap::liquid, "index of the liquid that gains what comes; 0: that with the lowest index",
                 {0, last_document_index}),
    always_saved("open", &Tap::open, "whether it is open at the start"),
};
static_assert(lists_all_members<Tap>(), "a member of Tap is in no list, or one is there twice");

/// A hole on an entity: takes the liquid that comes into a ball.
struct Drain {
    double radius = 0;
    Vec3 position;
    bool open = true;
    friend bool operator==(const Drain&, const Drain&) = default;
};

template <>
inline constexpr auto fields_of<Drain> = std::tuple{
    always_saved("radius", &Drain::radius,
                 "of the ball whose drops go; 0: it is no drain. Below half a cell of the liquid it is hardly felt",
                 {0, 10, "m"}),
    always_saved("position", &Drain::position, "of the middle of the ball, in the entity's frame", {.unit = "m"}),
    always_saved("open", &Drain::open, "whether it is open at the start"),
};
static_assert(lists_all_members<Drain>(), "a member of Drain is in no list, or one is there twice");

/// The paper's VSEle = {index, GeomAttr, PhyAttr} (definition 2): geometry, attributes and pose.
struct Entity {
    EntityIndex index = 0;
    std::string name;
    Geometry geometry;  ///< the paper's GeomAttr (definition 3)
    /// Manual attributes of this entity by registry name; everything else comes from the model or the defaults
    /// (definition 4, 5).
    std::map<std::string, attributes::AttributeValue> attributes;
    Transform pose;
    Vec3 linear_velocity;   ///< m/s
    Vec3 angular_velocity;  ///< rad/s
    Vec3 force;             ///< N
    Vec3 torque;            ///< N m
    bool enabled = true;
    bool start_asleep = false;
    bool allow_sleep = true;
    bool continuous = false;
    std::string category;
    std::optional<std::array<double, 3>> color;
    double scale = 1;
    std::vector<Pin> pins;
    SharedOptional<KeptForm> kept;
    std::string group;  ///< "Dining/Chairs": a group within a group; empty: in none
    bool locked = false;
    Light light;
    Tap tap;
    Drain drain;
    bool starts_empty = false;
    Finish finish = Finish::plain;
};

template <>
inline constexpr auto fields_of<Entity> = std::tuple{
    always_saved("index", &Entity::index, "the entity's number, once in a file", index_range),
    always_saved("name", &Entity::name, "what people call it"),
    saved_beside(&Entity::geometry),
    saved_when_set("attributes", &Entity::attributes,
                   "physical attributes by name that are set for this entity; the others are the model's or the "
                   "default"),
    always_saved("pose", &Entity::pose, "of the entity's origin. A model's origin is the centre of its base"),
    saved_when_set("linear_velocity", &Entity::linear_velocity, "of the centre of mass at the start", {.unit = "m/s"}),
    saved_when_set("angular_velocity", &Entity::angular_velocity, "at the start, world axes", {.unit = "rad/s"}),
    saved_when_set("force", &Entity::force,
                   "constant, world axes, at the centre of mass; nodes, grains and drops share it by mass",
                   {.unit = "N"}),
    saved_when_set("torque", &Entity::torque,
                   "constant, world axes; it turns no nodes, grains and drops, which a message says", {.unit = "N m"}),
    saved_when_set("enabled", &Entity::enabled, "`false`: neither moves nor collides; still a template for `spawn`"),
    saved_when_set("start_asleep", &Entity::start_asleep, "whether it is asleep at the start"),
    saved_when_set("allow_sleep", &Entity::allow_sleep, "whether it may fall asleep"),
    saved_when_set("continuous", &Entity::continuous, "sweep fast motion against everything"),
    saved_when_set("category", &Entity::category, "of a primitive; a model brings its own"),
    saved_when_set("color", &Entity::color, "of a primitive, linear `[red, green, blue]`; null: the Studio's"),
    saved_when_set("scale", &Entity::scale, "of a model, uniform; its mass grows with the cube", {1e-4, 1e4}),
    saved_when_set("group", &Entity::group,
                   "the names of the groups that it is in, the outermost first, with `/` between them"),
    saved_when_set("pins", &Entity::pins, "of a thing of kind `soft`, `cloth` or `rope`: where it is held"),
    saved_when_set("kept", &Entity::kept,
                   "of a thing that is not one body: the form with which a run begins, as *Keep* found it; null: as "
                   "modelled"),
    saved_when_set("locked", &Entity::locked, "whether its pose, size and existence are kept from edits by hand"),
    saved_when_set("light", &Entity::light, "of a lamp"),
    saved_when_set("tap", &Entity::tap, "of what liquid comes from; it goes along with its entity"),
    saved_when_set("drain", &Entity::drain, "of what takes liquid; it goes along with its entity"),
    saved_when_set("starts_empty", &Entity::starts_empty,
                   "of a liquid: it begins without a drop, for a tap to fill; its shape tells how fine the drops are"),
    saved_when_set("finish", &Entity::finish,
                   "of a primitive, over its colour: `plain`, `parquet`, `tiles`, `concrete`, `plaster`, `brick`, "
                   "`grass` or `fabric`"),
};
static_assert(lists_all_members<Entity>(), "a member of Entity is in no list, or one is there twice");

}  // namespace embody::scene
