// SPDX-License-Identifier: MIT
#include "scene/file/json/change_json.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/document/document_field.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/json/text.h"
#include "scene/file/scene_file.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// The heading's fields with those of its settings beside them, as scene.settings reads them.
json heading_to_json(const Document& document) {
    json heading = json::object();
    write_all_fields<Heading>(heading, document);
    json settings = std::move(heading["settings"]);
    heading.erase("settings");
    settings.update(heading);
    return settings;
}

Result<std::uint32_t> index_of(const json& change, const std::string& where) {
    std::optional<Error> error;
    double number = 0;
    if (!read_number(change.value("index", json()), where + ".index", number, error, {1, last_document_index}))
        return *error;
    return static_cast<std::uint32_t>(number);
}

Result<Change> read_removal(const std::string& op, const json& change, const std::string& where) {
    const Result<std::uint32_t> index = index_of(change, where);
    if (!index.ok()) return index.error();
    if (op == "joint_removed") {
        SceneJoint gone;
        gone.index = index.value();
        return Change(JointChange{std::move(gone), std::nullopt});
    }
    if (op == "action_removed") {
        Action gone;
        gone.id = index.value();
        return Change(ActionChange{std::move(gone), std::nullopt});
    }
    Entity gone;
    gone.index = index.value();
    return Change(EntityChange{std::move(gone), std::nullopt});
}

bool has_same_kept(const json& change) { return change.contains("same_kept") && change["same_kept"] == true; }

Result<Change> read_entity(const json& change, const std::string& where, const Document& document) {
    Result<Entity> entity = entity_from_json(change.value("entity", json()), where + ".entity");
    if (!entity.ok()) return entity.error();
    if (entity.value().index == 0) return Error{where + ".entity.index", "is missing"};
    if (const Entity* present = has_same_kept(change) ? document.find(entity.value().index) : nullptr)
        entity.value().kept = present->kept;
    return Change(EntityChange{std::nullopt, std::move(entity).value()});
}

Result<Change> read_pose(const json& change, const std::string& where, const Document& document) {
    const Result<std::uint32_t> index = index_of(change, where);
    if (!index.ok()) return index.error();
    if (!document.find(index.value()))
        return Error{where + ".index", "there is no entity " + std::to_string(index.value())};
    // The pose is read as that of an entity, where it has its form.
    Entity moved;
    const json fields = {{"pose", change.value("pose", json::object())}};
    if (Result<void> read = change_entity_from_json(moved, fields, where, false); !read.ok()) return read.error();
    return Change(PoseChange{index.value(), {}, moved.pose});
}

Result<Change> read_heading(const json& change, const std::string& where, const Document& document) {
    std::optional<Error> error;
    json fields = change.value("settings", json());
    HeadingChange heading{document, document};
    // Null: the scene has none.
    if (fields.is_object() && fields.contains("camera") && fields["camera"].is_null()) {
        heading.after->camera.reset();
        fields.erase("camera");
    }
    FieldReader reader(fields, where + ".settings", error);
    for_each_field<Heading>([&](const auto& field) {
        if constexpr (!std::is_same_v<typename std::remove_cvref_t<decltype(field)>::Member, physics::WorldSettings>)
            read_field(reader, field, *heading.after);
    });
    read_fields(reader, heading.after->settings);
    if (!reader.finish()) return *error;
    return Change(std::move(heading));
}

// A change for the document as those before it leave it.
Result<Change> read_change(const json& change, const std::string& where, const Document& document) {
    const std::string op = change["op"];
    if (op == "entity") return read_entity(change, where, document);
    if (op.ends_with("_removed")) return read_removal(op, change, where);
    if (op == "pose") return read_pose(change, where, document);
    if (op == "settings") return read_heading(change, where, document);
    if (op == "joint") {
        Result<SceneJoint> joint = joint_from_json(change.value("joint", json()), where + ".joint", document);
        if (!joint.ok()) return joint.error();
        return Change(JointChange{std::nullopt, std::move(joint).value()});
    }
    if (op == "action") {
        Result<Action> action = action_from_json(change.value("action", json()), where + ".action");
        if (!action.ok()) return action.error();
        return Change(ActionChange{std::nullopt, std::move(action).value()});
    }
    return Error{where + ".op", "\"" + op + "\" is not a change"};
}

}  // namespace

json change_to_json(const Change& change, const Document& document) {
    if (const auto* entity = std::get_if<EntityChange>(&change)) {
        if (!entity->after) return {{"op", "entity_removed"}, {"index", entity->before->index}};
        Entity present = *document.find(entity->after->index);
        const bool is_same = entity->before && present.kept && entity->before->kept.is_copy_of(present.kept);
        if (!is_same) return {{"op", "entity"}, {"entity", entity_to_json(present)}};
        present.kept.reset();
        return {{"op", "entity"}, {"entity", entity_to_json(present)}, {"same_kept", true}};
    }
    if (const auto* pose = std::get_if<PoseChange>(&change))
        return {{"op", "pose"}, {"index", pose->index}, {"pose", transform_to_json(pose->after)}};
    if (const auto* joint = std::get_if<JointChange>(&change)) {
        if (!joint->after) return {{"op", "joint_removed"}, {"index", joint->before->index}};
        return {{"op", "joint"}, {"joint", joint_to_json(*joint->after)}};
    }
    if (const auto* action = std::get_if<ActionChange>(&change)) {
        if (!action->after) return {{"op", "action_removed"}, {"index", action->before->id}};
        return {{"op", "action"}, {"action", action_to_json(*action->after)}};
    }
    return {{"op", "settings"}, {"settings", heading_to_json(document)}};
}

Result<void> apply_changes(Document& document, const json& changes) {
    if (!changes.is_array()) return Error{"changes", "is not a list"};
    // Changes of one kind in a row are applied together, which is fast where thousands of entities come or go.
    std::vector<Change> row;
    std::string kind;
    const auto apply_row = [&] {
        apply_changes(document, row);
        row.clear();
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const std::string where = element_path("changes", i);
        if (!changes[i].is_object() || !changes[i].contains("op") || !changes[i]["op"].is_string())
            return Error{where, "has no \"op\""};
        if (changes[i]["op"] != kind || has_same_kept(changes[i])) apply_row();
        kind = changes[i]["op"];
        Result<Change> change = read_change(changes[i], where, document);
        if (!change.ok()) return change.error();
        row.push_back(std::move(change).value());
    }
    apply_row();
    return {};
}

}  // namespace embody::scene
