// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;

Result<Action> action_from_json(const json& value, const std::string& where) {
    Action action;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    read_whole(reader, action);
    if (error) return *error;

    // A repeated action is not over after the first time, unless the file says so.
    const auto* at = std::get_if<AtTime>(&action.trigger);
    if (!value.contains("once")) action.once = !(at && at->repeat_every);
    return action;
}

json action_to_json(const Action& action) {
    json out = json::object();
    write_fields(out, action);
    return out;
}

}  // namespace embody::scene
