// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "scene/document/document_field.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;

Result<physics::WorldSettings> settings_from_json(const json& value, const std::string& where,
                                                  const physics::WorldSettings& start) {
    physics::WorldSettings settings = start;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    read_fields(reader, settings);
    reader.finish();
    if (error) return *error;
    if (const Result<void> valid = physics::validate(settings); !valid.ok()) {
        Error refused = valid.error();
        refused.where = reader.path(document_field(refused.where));
        return refused;
    }
    return settings;
}

json settings_to_json(const physics::WorldSettings& settings) {
    json out = json::object();
    write_fields(out, settings);
    return out;
}

void read_value(FieldReader& reader, const char* name, FieldRange, physics::WorldSettings& settings) {
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    Result<physics::WorldSettings> read = settings_from_json(*field, reader.path(name), settings);
    if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
    settings = read.value();
}

void write_value(json& object, const char* name, const physics::WorldSettings& settings) {
    object[name] = settings_to_json(settings);
}

}  // namespace embody::scene
