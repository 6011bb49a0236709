// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "attributes/attribute.h"
#include "math/bounds.h"
#include "math/transform.h"

namespace embody::scene {

/// Whom a trigger or an effect means: an entity by name or index, every entity of a category, or any.
struct Target {
    enum class By : std::uint8_t { any, index, name, category } by = By::any;
    std::uint32_t index = 0;
    std::string word;
};

struct AtTime {
    double time = 0;                     ///< s after the start
    std::optional<double> repeat_every;  ///< s
};
struct OnContactBegin {
    Target other;                     ///< the action's sender touches `other`
    double least_approach_speed = 0;  ///< m/s
};
struct OnContactEnd {
    Target other;
};
struct OnEnterVolume {
    Bounds volume;  ///< world; entered by the sender's centre of mass
};
struct OnFallAsleep {};
/// A key ("k", "Space", …) or named button of the Studio, or a call of the API.
struct OnSignal {
    std::string key, button;  ///< one of the two is set
};
using Trigger = std::variant<AtTime, OnContactBegin, OnContactEnd, OnEnterVolume, OnFallAsleep, OnSignal>;

struct SetAttribute {
    std::string name;
    attributes::AttributeValue value;
};
struct ApplyImpulse {
    Vec3 impulse;            ///< N s, world axes
    std::optional<Vec3> at;  ///< world point; open: centre of mass
};
struct ApplyForce {
    Vec3 force;           ///< N, for `duration`
    double duration = 0;  ///< s; 0: one step
};
struct SetVelocity {
    Vec3 linear, angular;
};
/// A new entity like the receiver (or like an entity of the document that is disabled), at `pose`.
struct Spawn {
    Transform pose;
    Vec3 linear_velocity;
};
struct Remove {};
struct SetEnabled {
    bool enabled = true;
};
struct Pause {};
using Effect = std::variant<SetAttribute, ApplyImpulse, ApplyForce, SetVelocity, Spawn, Remove, SetEnabled, Pause>;

/// The paper's Action = {act_name, act_sender, act_receiver, act_id, act_param} (definition 6); the parameters are the
/// trigger and the effect.
struct Action {
    std::uint32_t id = 0;
    std::string name;
    Target sender;    ///< whose doing triggers it
    Target receiver;  ///< who is changed
    Trigger trigger;
    Effect effect;
    bool once = true;  ///< fires at most once a run
};

}  // namespace embody::scene
