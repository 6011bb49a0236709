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

Result<json> add_joint(SessionState& state, const json& params) {
    Result<SceneJoint> read = joint_from_json(inner_or_self(params, "joint"), "", state.document);
    if (!read.ok()) return read.error();
    SceneJoint joint = std::move(read).value();
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
                                           {"joint.remove", remove_joint},
                                           {"action.add", add_action},
                                           {"action.remove", remove_action},
                                           {"action.trigger", trigger, Need::run}};
    return commands;
}

}  // namespace embody::scene
