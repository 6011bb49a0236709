// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "attributes/attribute.h"
#include "math/bounds.h"
#include "math/transform.h"
#include "scene/document/entity.h"
#include "scene/document/field_list.h"

namespace embody::scene {

/// The entities that a trigger or an effect names: one by name or index, every entity of a category, or any.
struct Target {
    enum class By : std::uint8_t { any, index, name, category } by = By::any;
    std::uint32_t index = 0;
    std::string word;
    friend bool operator==(const Target&, const Target&) = default;
};

struct AtTime {
    double time = 0;
    std::optional<double> repeat_every;
};
template <>
inline constexpr auto fields_of<AtTime> = std::tuple{
    always_saved("time", &AtTime::time, "after the start", {.low = 0, .unit = "s"}),
    saved_when_set("repeat_every", &AtTime::repeat_every, "and then every so many; at most once a step",
                   {1e-5, 1e9, "s"}),
};

struct OnContactBegin {
    Target other;
    double least_approach_speed = 0;
};
template <>
inline constexpr auto fields_of<OnContactBegin> = std::tuple{
    always_saved("other", &OnContactBegin::other, "whom the sender begins to touch"),
    always_saved("least_approach_speed", &OnContactBegin::least_approach_speed, "slower ones do not count",
                 {.low = 0, .unit = "m/s"}),
};

struct OnContactEnd {
    Target other;
};
template <>
inline constexpr auto fields_of<OnContactEnd> = std::tuple{
    always_saved("other", &OnContactEnd::other, "whom the sender ceases to touch"),
};

/// The sender's centre of mass enters a box of the world; an entity that starts inside has not entered.
struct OnEnterVolume {
    Bounds volume{{0, 0, 0}, {0, 0, 0}};
};
template <>
inline constexpr auto fields_of<Bounds> = std::tuple{
    always_needed("lower", &Bounds::lower, "the corner with the least coordinates", {.unit = "m"}),
    always_needed("upper", &Bounds::upper, "the corner with the greatest coordinates", {.unit = "m"}),
};
template <>
inline constexpr auto fields_of<OnEnterVolume> = std::tuple{saved_beside(&OnEnterVolume::volume)};

struct OnFallAsleep {};

/// A signal of the Studio or a call of the API: one of the two is set.
struct OnSignal {
    std::string key, button;
};
template <>
inline constexpr auto fields_of<OnSignal> = std::tuple{
    saved_when_set("key", &OnSignal::key, "of the Studio: \"k\", \"Space\", …"),
    saved_when_set("button", &OnSignal::button, "of the Studio, by its name; instead of a key"),
};

using Trigger = std::variant<AtTime, OnContactBegin, OnContactEnd, OnEnterVolume, OnFallAsleep, OnSignal>;
template <>
inline constexpr std::array<const char*, 6> alternatives_of<Trigger> = {"time",         "contact_begin", "contact_end",
                                                                        "enter_volume", "fall_asleep",   "signal"};

struct SetAttribute {
    std::string name;
    attributes::AttributeValue value;
};
template <>
inline constexpr auto fields_of<SetAttribute> = std::tuple{
    always_needed("name", &SetAttribute::name, "an attribute's name"),
    always_needed("value", &SetAttribute::value, "the attribute's new value for the rest of the run"),
};

struct ApplyImpulse {
    Vec3 impulse;
    std::optional<Vec3> at;
};
template <>
inline constexpr auto fields_of<ApplyImpulse> = std::tuple{
    always_needed("impulse", &ApplyImpulse::impulse, "N s, [x, y, z], world axes"),
    saved_when_set("at", &ApplyImpulse::at, "point of the world; without, the centre of mass", {.unit = "m"}),
};

struct ApplyForce {
    Vec3 force;
    double duration = 0;
};
template <>
inline constexpr auto fields_of<ApplyForce> = std::tuple{
    always_needed("force", &ApplyForce::force, "N, [x, y, z], world axes"),
    always_saved("duration", &ApplyForce::duration, "at least one step", {.low = 0, .unit = "s"}),
};

struct SetVelocity {
    Vec3 linear, angular;
};
template <>
inline constexpr auto fields_of<SetVelocity> = std::tuple{
    always_saved("linear", &SetVelocity::linear, "of the centre of mass", {.unit = "m/s"}),
    always_saved("angular", &SetVelocity::angular, "world axes", {.unit = "rad/s"}),
};

/// A new entity like the receiver (or like an entity of the document that is disabled).
struct Spawn {
    Transform pose;
    Vec3 linear_velocity;
};
template <>
inline constexpr auto fields_of<Spawn> = std::tuple{
    always_saved("pose", &Spawn::pose, "where the new entity is"),
    always_saved("linear_velocity", &Spawn::linear_velocity, "of its centre of mass", {.unit = "m/s"}),
};

struct Remove {};

struct SetEnabled {
    bool enabled = true;
};
template <>
inline constexpr auto fields_of<SetEnabled> = std::tuple{
    always_saved("enabled", &SetEnabled::enabled, "whether the receiver moves and collides"),
};

/// Of the receiver's tap and drain.
struct SetOpen {
    bool open = true;
};
template <>
inline constexpr auto fields_of<SetOpen> = std::tuple{
    always_saved("open", &SetOpen::open, "whether the receiver's tap and drain are open"),
};

/// The receiver becomes liquid, with its mass and momenta (docs/physics/melting.md).
struct Melt {
    EntityIndex into = 0;
};
template <>
inline constexpr auto fields_of<Melt> = std::tuple{
    always_saved("into", &Melt::into,
                 "index of the liquid that gains its drops; 0: it becomes a liquid of its own matter",
                 {0, last_document_index}),
};

/// Each connected component of the receiver, a liquid, becomes a rigid thing, with its mass and momenta.
struct Freeze {};

struct Pause {};

using Effect = std::variant<SetAttribute, ApplyImpulse, ApplyForce, SetVelocity, Spawn, Remove, SetEnabled, SetOpen,
                            Melt, Freeze, Pause>;
template <>
inline constexpr std::array<const char*, 11> alternatives_of<Effect> = {
    "set_attribute", "apply_impulse", "apply_force", "set_velocity", "spawn", "remove",
    "set_enabled",   "set_open",      "melt",        "freeze",       "pause"};

/// The paper's Action = {act_name, act_sender, act_receiver, act_id, act_param} (definition 6); the parameters are the
/// trigger and the effect.
struct Action {
    std::uint32_t id = 0;
    std::string name;
    Target sender;
    Target receiver;
    Trigger trigger;
    Effect effect;
    bool once = true;
    bool enabled = true;
};
template <>
inline constexpr auto fields_of<Action> = std::tuple{
    always_saved("id", &Action::id, "the action's number, once in a file", index_range),
    always_saved("name", &Action::name, "what people call it"),
    always_saved("sender", &Action::sender, "whose doing sets it off"),
    always_saved("receiver", &Action::receiver, "who is changed"),
    always_needed("trigger", &Action::trigger, "what sets the action off"),
    always_needed("effect", &Action::effect, "what the action does"),
    always_saved("once", &Action::once, "at most once a run; of what repeats false where nothing is said"),
    saved_when_set("enabled", &Action::enabled, "`false`: nothing sets it off"),
};

}  // namespace embody::scene
