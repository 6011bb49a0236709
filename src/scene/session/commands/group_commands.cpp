// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <string>

#include "scene/session/commands/commands.h"
#include "scene/session/groups.h"

namespace embody::scene {

using nlohmann::json;

namespace {

void put_group(const SessionState& state, Edit& edit, EntityIndex index, const std::string& group) {
    const Entity& before = *state.document.find(index);
    if (before.group == group) return;
    Entity after = before;
    after.group = group;
    edit.changes.emplace_back(change_of(before, after));
}

bool read_path(FieldReader& reader, const char* name, std::string& path) {
    if (!reader.text(name, path)) return false;
    if (is_group_path(path)) return true;
    reader.fail(reader.path(name), "\"" + path + "\" is no path of groups", "write names with one / between two");
    return false;
}

// A new group in the innermost one that all of them are in.
Result<json> group(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::string name = "Group";
    need_indices(reader, state, indices);
    reader.text("name", name);
    if (reader.ok() && (name.empty() || name.find('/') != std::string::npos))
        reader.fail("name", "must be a name without /", "groups within groups are made by grouping their things");
    if (!reader.finish()) return *error;
    std::string parent = state.document.find(indices.front())->group;
    for (const EntityIndex index : indices) parent = common_group(parent, state.document.find(index)->group);
    const std::string made = free_group(state.document, parent, name);
    Edit edit = state.start_edit("Group " + state.called(indices));
    for (const EntityIndex index : indices)
        put_group(state, edit, index, moved_group(state.document.find(index)->group, parent, made));
    if (Result<void> grouped = state.commit(std::move(edit)); !grouped.ok()) return grouped.error();
    return json{{"group", made}};
}

Result<json> ungroup(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::string name;
    if (reader.need("group", "the group's path")) read_path(reader, "group", name);
    if (!reader.finish()) return *error;
    Edit edit = state.start_edit("Ungroup " + name);
    json members = json::array();
    for (const Entity& entity : state.document.entities) {
        if (name.empty() || !is_in_group(entity.group, name)) continue;
        put_group(state, edit, entity.index, moved_group(entity.group, name, parent_group(name)));
        members.push_back(entity.index);
    }
    if (members.empty()) return Error{"group", "there is no group \"" + name + "\""};
    if (Result<void> done = state.commit(std::move(edit)); !done.ok()) return done.error();
    return json{{"indices", std::move(members)}};
}

// Into another group, out of one, or all of a group under another name.
Result<json> set_group(SessionState& state, const json& params) {
    std::optional<Error> error;
    FieldReader reader(params, "", error);
    std::vector<EntityIndex> indices;
    std::string from, to;
    need_indices(reader, state, indices);
    if (reader.need("group", "the path of the group that they come into; empty: none")) read_path(reader, "group", to);
    read_path(reader, "from", from);
    const bool keeps_inner = params.is_object() && params.contains("from");
    if (!reader.finish()) return *error;
    if (keeps_inner && !from.empty() && to != from && is_in_group(to, from))
        for (const EntityIndex index : indices)
            if (is_in_group(state.document.find(index)->group, to))
                return Error{"group", "\"" + to + "\" is within what is moved"};
    Edit edit = state.start_edit("Group " + state.called(indices));
    for (const EntityIndex index : indices) {
        const std::string& path = state.document.find(index)->group;
        if (keeps_inner && !is_in_group(path, from))
            return Error{"from", state.called({index}) + " is not in the group \"" + from + "\""};
        put_group(state, edit, index, keeps_inner ? moved_group(path, from, to) : to);
    }
    return done(state.commit(std::move(edit)));
}

}  // namespace

std::span<const Command> group_commands() {
    static constexpr Command commands[] = {
        {"entity.group", group}, {"entity.ungroup", ungroup}, {"entity.set_group", set_group}};
    return commands;
}

}  // namespace embody::scene
