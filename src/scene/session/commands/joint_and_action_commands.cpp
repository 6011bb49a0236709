// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/file/json/parts.h"
#include "scene/session/commands/commands.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// The fields of the scene file, directly in the params or in an object of this name.
const json& inner_or_self(const json& params, const char* name) {
    if (params.is_object() && params.size() == 1 && params.contains(name) && params.at(name).is_object())
        return params.at(name);
    return params;
}

template <class Item, class Number>
Result<std::uint32_t> next_number(const std::vector<Item>& items, Number Item::*number) {
    if (items.empty()) return std::uint32_t{1};
    if (items.back().*number >= last_document_index)
        return Error{"", "no number is left above the highest", "give that one a lower number in the scene file"};
    return items.back().*number + 1;
}

// Where the entity is now: a run may have moved it.
Transform pose_now(const SessionState& state, EntityIndex index) {
    const bool moves = state.play_state != PlayState::stopped && state.simulation->contains(index);
    return moves ? state.simulation->pose(index) : state.document.find(index)->pose;
}

// An anchor is a place that a person sees: it is turned into frames where the things are now.
void follow_run(const SessionState& state, SceneJoint& joint) {
    if (state.play_state == PlayState::stopped) return;
    const Transform world = state.document.find(joint.entity_b)->pose * joint.definition.frame_b;
    joint.definition.frame_b = inverse(pose_now(state, joint.entity_b)) * world;
    joint.definition.frame_a = joint.entity_a ? inverse(pose_now(state, *joint.entity_a)) * world : world;
}

Result<json> add_joint(SessionState& state, const json& params) {
    const json& given = inner_or_self(params, "joint");
    Result<SceneJoint> read = joint_from_json(given, "", state.document);
    if (!read.ok()) return read.error();
    SceneJoint joint = std::move(read).value();
    if (given.contains("anchor")) follow_run(state, joint);
    if (joint.index != 0) return Error{"index", "is given by the session", "leave it out"};
    const Result<std::uint32_t> number = next_number(state.document.joints, &SceneJoint::index);
    if (!number.ok()) return number.error();
    joint.index = number.value();
    Edit edit = state.start_edit("Add joint" + (joint.name.empty() ? "" : " " + joint.name));
    const std::uint32_t index = joint.index;
    edit.changes.emplace_back(JointChange{std::nullopt, std::move(joint)});
    if (Result<void> added = state.commit(std::move(edit)); !added.ok()) return added.error();
    return json{{"index", index}};
}

Result<json> add_action(SessionState& state, const json& params) {
    Result<Action> read = action_from_json(inner_or_self(params, "action"), "");
    if (!read.ok()) return read.error();
    Action action = std::move(read).value();
    if (action.id != 0) return Error{"id", "is given by the session", "leave it out"};
    const Result<std::uint32_t> number = next_number(state.document.actions, &Action::id);
    if (!number.ok()) return number.error();
    action.id = number.value();
    Edit edit = state.start_edit("Add action" + (action.name.empty() ? "" : " " + action.name));
    const std::uint32_t index = action.id;
    edit.changes.emplace_back(ActionChange{std::nullopt, std::move(action)});
    if (Result<void> added = state.commit(std::move(edit)); !added.ok()) return added.error();
    return json{{"index", index}};
}

// The item with the number `index` of the params; an error if there is none.
template <class Item, class Number>
Result<Item> find_item(const json& params, const std::vector<Item>& items, Number Item::*number, const char* what) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t index = 0;
    if (reader.need("index", "its number")) reader.whole("index", index, 1);
    if (!reader.finish()) return *error;
    const auto found =
        std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.*number == index; });
    if (found == items.end()) return Error{"index", std::string("there is no ") + what + " " + std::to_string(index)};
    return *found;
}

Result<json> remove_joint(SessionState& state, const json& params) {
    Result<SceneJoint> joint = find_item(params, state.document.joints, &SceneJoint::index, "joint");
    if (!joint.ok()) return joint.error();
    Edit edit = state.start_edit("Delete joint" + (joint.value().name.empty() ? "" : " " + joint.value().name));
    edit.changes.emplace_back(JointChange{std::move(joint).value(), std::nullopt});
    return done(state.commit(std::move(edit)));
}

Result<json> remove_action(SessionState& state, const json& params) {
    Result<Action> action = find_item(params, state.document.actions, &Action::id, "action");
    if (!action.ok()) return action.error();
    Edit edit = state.start_edit("Delete action" + (action.value().name.empty() ? "" : " " + action.value().name));
    edit.changes.emplace_back(ActionChange{std::move(action).value(), std::nullopt});
    return done(state.commit(std::move(edit)));
}

// The stored thing with the fields that are given; null: the field's default.
json with_fields(json whole, const json& fields) {
    for (const auto& [name, value] : fields.items()) {
        if (value.is_null())
            whole.erase(name);
        else
            whole[name] = value;
    }
    return whole;
}

struct Update {
    std::uint32_t index = 0;
    json fields;
};

// Reads {index, `name`: the fields to change}.
Result<Update> read_update(const json& params, const char* name, const char* number) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    Update update;
    if (reader.need("index", "its number")) reader.whole("index", update.index, 1);
    reader.need(name, "the fields to change");
    const json* fields = reader.ok() ? reader.object(name) : nullptr;
    if (fields && fields->contains(number))
        reader.refuse(std::string(name) + "." + number, "cannot be changed", "leave it out");
    if (!reader.finish()) return *error;
    update.fields = *fields;
    return update;
}

template <class Item, class Number>
Result<Item> item_numbered(std::uint32_t index, const std::vector<Item>& items, Number Item::*number,
                           const char* what) {
    return find_item(json{{"index", index}}, items, number, what);
}

// Without new frames an anchor or axis that is not given stays where it is in the world, also at other ends.
void keep_place(const SessionState& state, const SceneJoint& joint, const json& fields, json& whole) {
    const auto has = [&fields](const char* name) { return fields.contains(name); };
    const bool is_placed = has("anchor") || has("axis") || has("entity_a") || has("entity_b");
    if (!is_placed || has("frame_a") || has("frame_b")) return;
    const Transform world = pose_now(state, joint.entity_b) * joint.definition.frame_b;
    whole.erase("frame_a");
    whole.erase("frame_b");
    whole["anchor"] = vector_to_json(world.position);
    whole["axis"] = vector_to_json(rotate(world.rotation, {1, 0, 0}));
}

Result<json> update_joint(SessionState& state, const json& params) {
    const Result<Update> update = read_update(params, "joint", "index");
    if (!update.ok()) return update.error();
    const auto& [index, fields] = update.value();
    Result<SceneJoint> before = item_numbered(index, state.document.joints, &SceneJoint::index, "joint");
    if (!before.ok()) return before.error();
    json whole = joint_to_json(before.value());
    // Limits and motors are of one kind: metres are no radians.
    if (fields.contains("type") && fields["type"] != whole["type"]) {
        whole.erase("limit");
        whole.erase("motor");
    }
    keep_place(state, before.value(), fields, whole);
    const json changed = with_fields(std::move(whole), fields);
    Result<SceneJoint> after = joint_from_json(changed, "joint", state.document);
    if (!after.ok()) return after.error();
    if (changed.contains("anchor")) follow_run(state, after.value());
    const std::string& name = after.value().name;
    Edit edit = state.start_edit("Change joint" + (name.empty() ? "" : " " + name));
    edit.changes.emplace_back(JointChange{std::move(before).value(), std::move(after).value()});
    return done(state.commit(std::move(edit)));
}

Result<json> update_action(SessionState& state, const json& params) {
    const Result<Update> update = read_update(params, "action", "id");
    if (!update.ok()) return update.error();
    const auto& [index, fields] = update.value();
    Result<Action> before = item_numbered(index, state.document.actions, &Action::id, "action");
    if (!before.ok()) return before.error();
    Result<Action> after = action_from_json(with_fields(action_to_json(before.value()), fields), "action");
    if (!after.ok()) return after.error();
    const std::string& name = after.value().name;
    Edit edit = state.start_edit("Change action" + (name.empty() ? "" : " " + name));
    edit.changes.emplace_back(ActionChange{std::move(before).value(), std::move(after).value()});
    return done(state.commit(std::move(edit)));
}

// Actions are carried out in the order of their numbers: those between the two places move on by one.
Result<json> move_action(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t index = 0, place = 0;
    const std::vector<Action>& actions = state.document.actions;
    if (reader.need("index", "its number")) reader.whole("index", index, 1);
    if (reader.need("place", "its place in the order, from 1"))
        reader.whole("place", place, 1, static_cast<std::uint32_t>(std::max<std::size_t>(actions.size(), 1)));
    if (!reader.finish()) return *error;
    const auto found = std::ranges::find(actions, index, &Action::id);
    if (found == actions.end()) return Error{"index", "there is no action " + std::to_string(index)};

    std::vector<Action> ordered = actions;
    const auto from = ordered.begin() + (found - actions.begin()), to = ordered.begin() + (place - 1);
    if (from < to)
        std::rotate(from, from + 1, to + 1);
    else
        std::rotate(to, from, from + 1);
    Edit edit = state.start_edit("Order actions");
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        if (ordered[i].id == actions[i].id) continue;
        ordered[i].id = actions[i].id;
        edit.changes.emplace_back(ActionChange{actions[i], ordered[i]});
    }
    const std::uint32_t moved = actions[place - 1].id;
    if (Result<void> made = state.commit(std::move(edit)); !made.ok()) return made.error();
    return json{{"index", moved}};
}

Result<json> run_action(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::uint32_t index = 0;
    EntityIndex sender = 0;
    if (reader.need("index", "its number")) reader.whole("index", index, 1);
    reader.whole("sender", sender, 1);
    if (!reader.finish()) return *error;
    if (state.play_state == PlayState::stopped)
        return Error{"action.run", "the simulation is stopped", "play first: what an action does is part of a run"};
    return done(state.simulation->run_action(index, sender));
}

Result<json> trigger(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string key, button;
    reader.text("key", key);
    reader.text("button", button);
    if (reader.ok() && key.empty() == button.empty()) reader.fail("key", "say either a key or a button");
    if (!reader.finish()) return *error;
    return json{{"started", state.simulation->signal(key, button)}};
}

}  // namespace

std::span<const Command> joint_and_action_commands() {
    static constexpr Command commands[] = {{"joint.add", add_joint},
                                           {"joint.update", update_joint},
                                           {"joint.remove", remove_joint},
                                           {"action.add", add_action},
                                           {"action.update", update_action},
                                           {"action.move", move_action},
                                           {"action.remove", remove_action},
                                           {"action.run", run_action, Need::run},
                                           {"action.trigger", trigger, Need::run}};
    return commands;
}

}  // namespace embody::scene
