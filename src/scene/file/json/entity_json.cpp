// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"

namespace embody::scene {

using nlohmann::json;

Result<void> change_entity_from_json(Entity& entity, const json& value, const std::string& where, bool is_new) {
    Entity changed = entity;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    read_fields(reader, changed);
    for (std::size_t i = 0; i < changed.pins.size(); ++i)
        if (changed.index != 0 && changed.pins[i].to == changed.index)
            reader.fail(element_path(reader.path("pins"), i) + ".to", "must be another entity");
    if (!reader.finish()) return *error;
    // Checked last, so that a wrong name of the field is reported as such.
    if (is_new && !value.contains("model") && !value.contains("shape"))
        return Error{reader.path("model"), "is missing: an entity needs a model or a shape"};
    if (!is_new && changed.index != entity.index) return Error{reader.path("index"), "of an entity can't be changed"};
    entity = std::move(changed);
    return {};
}

Result<Entity> entity_from_json(const json& value, const std::string& where) {
    Entity entity;
    if (const Result<void> read = change_entity_from_json(entity, value, where, true); !read.ok()) return read.error();
    return entity;
}

json entity_to_json(const Entity& entity) {
    json out = json::object();
    write_fields(out, entity);
    return out;
}

}  // namespace embody::scene
