// SPDX-License-Identifier: MIT
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "scene/file/json/field_reader.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"

namespace embody::scene {

using nlohmann::json;

namespace {

constexpr std::uint32_t format_version = 1;

bool is_format(FieldReader& reader) {
    const json* version = reader.need("embody_scene", "the format's version, 1");
    if (!version) return false;
    if (version->is_number_integer() && *version == format_version) return true;
    reader.fail(reader.path("embody_scene"),
                "must be 1, got " + std::string(version->is_number() ? version->dump() : json_kind(*version)),
                "a later version of Embody may read it");
    return false;
}

// Gives items without a number the next free ones, sorts them, and refuses a number that occurs twice.
template <class Item, class Number>
bool number_items(FieldReader& reader, const char* list, std::vector<Item>& items, Number Item::*number, Number& next) {
    std::set<Number> taken;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Number given = items[i].*number;
        if (given == 0) continue;
        if (!taken.insert(given).second) {
            reader.fail(element_path(reader.path(list), i),
                        "has the number " + std::to_string(given) + " of another one");
            return false;
        }
        next = std::max(next, given + 1);
    }
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].*number != 0) continue;
        if (next > last_document_index) {
            reader.fail(element_path(reader.path(list), i), "has no number, and none is left above the highest",
                        "give it one that is free");
            return false;
        }
        items[i].*number = next++;
    }
    std::sort(items.begin(), items.end(), [number](const Item& a, const Item& b) { return a.*number < b.*number; });
    return true;
}

// Reads a list of `Item`s with `read(json, where)`.
template <class Item, class Read>
void read_list(FieldReader& reader, const char* name, std::vector<Item>& items, const Read& read) {
    const json* list = reader.take(name);
    if (!list || !read_array(*list, reader.path(name), reader.error())) return;
    items.reserve(list->size());
    for (std::size_t i = 0; i < list->size(); ++i) {
        Result<Item> item = read((*list)[i], element_path(reader.path(name), i));
        if (!item.ok()) return reader.fail(item.error().where, item.error().why, item.error().remedy);
        items.push_back(std::move(item).value());
    }
}

}  // namespace

Result<Document> document_from_json(const json& value) {
    Document document;
    std::optional<Error> error;
    FieldReader reader(value, "", error);
    if (!is_format(reader)) return *error;
    read_fields<Heading>(reader, document);
    if (const auto list = value.find("entities"); list != value.end() && list->size() > max_entities)
        return Error{"entities",
                     "are " + std::to_string(list->size()) + ", more than the " + std::to_string(max_entities) +
                         " that a scene can have",
                     "split the scene"};
    // Entities first: joints name them.
    reader.whole("next_index", document.next_index, 1,
                 last_document_index + 1);  // the upper bound means that no index is left
    read_list(reader, "entities", document.entities, entity_from_json);
    if (error || !number_items(reader, "entities", document.entities, &Entity::index, document.next_index))
        return *error;
    read_list(reader, "joints", document.joints, [&document](const json& joint, const std::string& where) {
        return joint_from_json(joint, where, document);
    });
    std::uint32_t next_joint = 1;
    if (error || !number_items(reader, "joints", document.joints, &SceneJoint::index, next_joint)) return *error;
    read_list(reader, "actions", document.actions, action_from_json);
    std::uint32_t next_action = 1;
    if (error || !number_items(reader, "actions", document.actions, &Action::id, next_action)) return *error;
    if (!reader.finish()) return *error;
    return document;
}

json document_to_json(const Document& document) {
    static_assert(count_members<Document>() == 5, "the heading and the lists below are all that there is to write");
    json out = {{"embody_scene", format_version}, {"next_index", document.next_index}, {"entities", json::array()}};
    write_fields<Heading>(out, document);
    for (const Entity& entity : document.entities) out["entities"].push_back(entity_to_json(entity));
    for (const SceneJoint& joint : document.joints) out["joints"].push_back(joint_to_json(joint));
    for (const Action& action : document.actions) out["actions"].push_back(action_to_json(action));
    return out;
}

}  // namespace embody::scene
