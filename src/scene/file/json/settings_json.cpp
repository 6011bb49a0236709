// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "scene/document/document_field.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;

Result<physics::WorldSettings> settings_from_json(const json& value, const std::string& where,
                                                  const physics::WorldSettings& start) {
    physics::WorldSettings settings = start;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    reader.vector("gravity", settings.gravity);
    reader.number("time_step", settings.time_step);
    reader.whole("substeps", settings.substeps, 1, 64);
    reader.number("time_to_sleep", settings.time_to_sleep);
    reader.truth("sleeping", settings.sleeping);
    reader.truth("shock_propagation", settings.shock_propagation);
    reader.vector("wind", settings.wind);
    reader.number("gustiness", settings.gustiness);
    reader.number("gust_time", settings.gust_time);
    reader.number("air_density", settings.air_density);
    reader.number("max_linear_speed", settings.max_linear_speed);
    reader.number("max_angular_speed", settings.max_angular_speed);
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
    return {{"gravity", vector_to_json(settings.gravity)},
            {"time_step", settings.time_step},
            {"substeps", settings.substeps},
            {"time_to_sleep", settings.time_to_sleep},
            {"sleeping", settings.sleeping},
            {"shock_propagation", settings.shock_propagation},
            {"wind", vector_to_json(settings.wind)},
            {"gustiness", settings.gustiness},
            {"gust_time", settings.gust_time},
            {"air_density", settings.air_density},
            {"max_linear_speed", settings.max_linear_speed},
            {"max_angular_speed", settings.max_angular_speed}};
}

}  // namespace embody::scene
