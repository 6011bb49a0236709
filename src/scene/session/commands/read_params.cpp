// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/session/commands/commands.h"

namespace embody::scene {

using nlohmann::json;

bool need_text(FieldReader& reader, const char* name, const char* what, std::string& value) {
    return reader.need(name, what) && reader.text(name, value);
}

bool need_index(FieldReader& reader, const char* name, EntityIndex& value) {
    return reader.need(name, "an entity's index") && reader.whole(name, value, 1);
}

bool need_vector(FieldReader& reader, const char* name, const char* what, Vec3& value) {
    return reader.need(name, what) && reader.vector(name, value);
}

bool need_indices(FieldReader& reader, const SessionState& state, std::vector<EntityIndex>& indices) {
    const json* list = reader.need("indices", "a list of entities' indices");
    const std::string where = reader.path("indices");
    if (!list || !read_array(*list, where, reader.error())) return false;
    if (list->empty()) {
        reader.fail(where, "names no entity");
        return false;
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
        double number = 0;
        if (!read_number((*list)[i], element_path(where, i), number, reader.error(), {1, last_document_index}))
            return false;
        const auto index = static_cast<EntityIndex>(number);
        if (number != std::floor(number) || !state.document.find(index)) {
            reader.fail(element_path(where, i), "there is no entity " + (*list)[i].dump() + " in the scene");
            return false;
        }
        indices.push_back(index);
    }
    std::sort(indices.begin(), indices.end());
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    return true;
}

void read_drop(FieldReader& reader, std::optional<Drop>& drop) {
    const json* given = reader.take("drop");
    if (!given) return;
    drop.emplace();
    FieldReader ray(*given, reader.path("drop"), reader.error());
    need_vector(ray, "origin", "where the ray starts", drop->ray.origin);
    need_vector(ray, "direction", "where it goes", drop->ray.direction);
    ray.truth("snap", drop->snap);
    ray.finish();
}

Result<json> done(const Result<void>& result) {
    if (!result.ok()) return result.error();
    return json::object();
}

}  // namespace embody::scene
