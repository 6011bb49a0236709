// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// "any", {"index": 3}, {"name": "Ball"} or {"category": "ball"}.
void read_target(FieldReader& reader, const char* name, Target& target) {
    const json* field = reader.take(name);
    if (!field) return;
    if (field->is_string() && field->get_ref<const std::string&>() == "any") {
        target = {};
        return;
    }
    if (!field->is_object())
        return reader.fail(reader.path(name),
                           "must be \"any\", {\"index\": number}, {\"name\": text} or {\"category\": text}");
    Target read;
    FieldReader inner(*field, reader.path(name), reader.error());
    int given = 0;
    if (inner.whole("index", read.index, 1)) read.by = Target::By::index, ++given;
    if (inner.text("name", read.word)) read.by = Target::By::name, ++given;
    if (inner.text("category", read.word)) read.by = Target::By::category, ++given;
    if (!inner.finish()) return;
    if (given != 1) return reader.fail(reader.path(name), "must say exactly one of index, name and category");
    target = read;
}

json target_to_json(const Target& target) {
    switch (target.by) {
        case Target::By::index:
            return {{"index", target.index}};
        case Target::By::name:
            return {{"name", target.word}};
        case Target::By::category:
            return {{"category", target.word}};
        case Target::By::any:
            break;
    }
    return "any";
}

Trigger read_signal(FieldReader& reader) {
    OnSignal signal;
    reader.text("key", signal.key);
    reader.text("button", signal.button);
    if (reader.ok() && signal.key.empty() == signal.button.empty())
        reader.fail(reader.path("key"), "say either a key or a button");
    return signal;
}

Trigger read_volume(FieldReader& reader) {
    Bounds volume{{0, 0, 0}, {0, 0, 0}};
    if (const json* field = reader.need("lower", "the corner with the least coordinates"))
        read_vector(*field, reader.path("lower"), volume.lower, reader.error());
    if (const json* field = reader.need("upper", "the corner with the greatest coordinates"))
        read_vector(*field, reader.path("upper"), volume.upper, reader.error());
    if (reader.ok() && volume.is_empty()) reader.fail(reader.path("upper"), "must be above lower in every coordinate");
    return OnEnterVolume{volume};
}

void read_trigger(FieldReader& action, Trigger& trigger) {
    const json* field = action.need("trigger", "what sets the action off");
    if (!field) return;
    FieldReader reader(*field, action.path("trigger"), action.error());
    std::size_t type = 0;
    reader.need("type", "time, contact_begin, contact_end, enter_volume, fall_asleep or signal");
    if (!reader.choice("type", type, {"time", "contact_begin", "contact_end", "enter_volume", "fall_asleep", "signal"}))
        return;
    if (type == 0) {
        AtTime at;
        reader.number("time", at.time, not_negative);
        reader.number("repeat_every", at.repeat_every, {1e-5, 1e9});
        trigger = at;
    } else if (type == 1) {
        OnContactBegin begin;
        read_target(reader, "other", begin.other);
        reader.number("least_approach_speed", begin.least_approach_speed, not_negative);
        trigger = begin;
    } else if (type == 2) {
        OnContactEnd end;
        read_target(reader, "other", end.other);
        trigger = end;
    } else if (type == 3) {
        trigger = read_volume(reader);
    } else if (type == 4) {
        trigger = OnFallAsleep{};
    } else {
        trigger = read_signal(reader);
    }
    reader.finish();
}

Effect read_set_attribute(FieldReader& reader) {
    SetAttribute set;
    reader.need("name", "an attribute's name");
    reader.text("name", set.name);
    const json* value = reader.need("value", "the attribute's new value");
    if (!value || !reader.ok()) return set;
    Result<attributes::AttributeValue> read = attribute_from_json(set.name, *value, reader.path("value"));
    if (read.ok()) {
        set.value = read.value();
    } else {
        reader.fail(read.error().where, read.error().why, read.error().remedy);
    }
    return set;
}

void need_vector(FieldReader& reader, const char* name, const char* what, Vec3& value) {
    if (const json* field = reader.need(name, what)) read_vector(*field, reader.path(name), value, reader.error());
}

Effect read_effect_of(FieldReader& reader, std::size_t type) {
    switch (type) {
        case 0:
            return read_set_attribute(reader);
        case 1: {
            ApplyImpulse impulse;
            need_vector(reader, "impulse", "N s, [x, y, z]", impulse.impulse);
            reader.vector("at", impulse.at);
            return impulse;
        }
        case 2: {
            ApplyForce force;
            need_vector(reader, "force", "N, [x, y, z]", force.force);
            reader.number("duration", force.duration, not_negative);
            return force;
        }
        case 3: {
            SetVelocity velocity;
            reader.vector("linear", velocity.linear);
            reader.vector("angular", velocity.angular);
            return velocity;
        }
        case 4: {
            Spawn spawn;
            reader.transform("pose", spawn.pose);
            reader.vector("linear_velocity", spawn.linear_velocity);
            return spawn;
        }
        case 5:
            return Remove{};
        case 6: {
            SetEnabled set;
            reader.truth("enabled", set.enabled);
            return set;
        }
        default:
            return Pause{};
    }
}

void read_effect(FieldReader& action, Effect& effect) {
    const json* field = action.need("effect", "what the action does");
    if (!field) return;
    FieldReader reader(*field, action.path("effect"), action.error());
    std::size_t type = 0;
    reader.need("type", "set_attribute, apply_impulse, apply_force, set_velocity, spawn, remove, set_enabled or pause");
    if (!reader.choice("type", type,
                       {"set_attribute", "apply_impulse", "apply_force", "set_velocity", "spawn", "remove",
                        "set_enabled", "pause"}))
        return;
    effect = read_effect_of(reader, type);
    reader.finish();
}

struct TriggerWriter {
    json operator()(const AtTime& t) const {
        json out = {{"type", "time"}, {"time", t.time}};
        if (t.repeat_every) out["repeat_every"] = *t.repeat_every;
        return out;
    }
    json operator()(const OnContactBegin& t) const {
        return {{"type", "contact_begin"},
                {"other", target_to_json(t.other)},
                {"least_approach_speed", t.least_approach_speed}};
    }
    json operator()(const OnContactEnd& t) const {
        return {{"type", "contact_end"}, {"other", target_to_json(t.other)}};
    }
    json operator()(const OnEnterVolume& t) const {
        return {{"type", "enter_volume"},
                {"lower", vector_to_json(t.volume.lower)},
                {"upper", vector_to_json(t.volume.upper)}};
    }
    json operator()(const OnFallAsleep&) const { return {{"type", "fall_asleep"}}; }
    json operator()(const OnSignal& t) const {
        if (!t.key.empty()) return {{"type", "signal"}, {"key", t.key}};
        return {{"type", "signal"}, {"button", t.button}};
    }
};

struct EffectWriter {
    json operator()(const SetAttribute& e) const {
        return {{"type", "set_attribute"}, {"name", e.name}, {"value", attributes::to_json(e.value)}};
    }
    json operator()(const ApplyImpulse& e) const {
        json out = {{"type", "apply_impulse"}, {"impulse", vector_to_json(e.impulse)}};
        if (e.at) out["at"] = vector_to_json(*e.at);
        return out;
    }
    json operator()(const ApplyForce& e) const {
        return {{"type", "apply_force"}, {"force", vector_to_json(e.force)}, {"duration", e.duration}};
    }
    json operator()(const SetVelocity& e) const {
        return {{"type", "set_velocity"}, {"linear", vector_to_json(e.linear)}, {"angular", vector_to_json(e.angular)}};
    }
    json operator()(const Spawn& e) const {
        return {{"type", "spawn"},
                {"pose", transform_to_json(e.pose)},
                {"linear_velocity", vector_to_json(e.linear_velocity)}};
    }
    json operator()(const Remove&) const { return {{"type", "remove"}}; }
    json operator()(const SetEnabled& e) const { return {{"type", "set_enabled"}, {"enabled", e.enabled}}; }
    json operator()(const Pause&) const { return {{"type", "pause"}}; }
};

}  // namespace

Result<Action> action_from_json(const json& value, const std::string& where) {
    Action action;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    reader.whole("id", action.id, 1, last_document_index);
    reader.text("name", action.name);
    read_target(reader, "sender", action.sender);
    read_target(reader, "receiver", action.receiver);
    read_trigger(reader, action.trigger);
    read_effect(reader, action.effect);

    // What repeats is not over after the first time, unless the file says so.
    const auto* at = std::get_if<AtTime>(&action.trigger);
    action.once = !(at && at->repeat_every);
    reader.truth("once", action.once);
    reader.finish();
    if (error) return *error;
    return action;
}

json action_to_json(const Action& action) {
    static_assert(count_members<Action>() == 7, "each member is written here and read above");
    return {{"id", action.id},
            {"name", action.name},
            {"sender", target_to_json(action.sender)},
            {"receiver", target_to_json(action.receiver)},
            {"trigger", std::visit(TriggerWriter{}, action.trigger)},
            {"effect", std::visit(EffectWriter{}, action.effect)},
            {"once", action.once}};
}

}  // namespace embody::scene
