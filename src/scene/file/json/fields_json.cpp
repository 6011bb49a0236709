// SPDX-License-Identifier: MIT
#include "scene/file/json/fields_json.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "scene/file/json/parts.h"

namespace embody::scene {

using nlohmann::json;

namespace {

template <class Whole>
Whole whole_bound(double bound) {
    using Limits = std::numeric_limits<Whole>;
    return static_cast<Whole>(std::clamp(bound, 0.0, static_cast<double>(Limits::max())));
}

}  // namespace

void write_value(json& object, const char* name, bool value) { object[name] = value; }
void write_value(json& object, const char* name, int value) { object[name] = value; }
void write_value(json& object, const char* name, std::uint32_t value) { object[name] = value; }
void write_value(json& object, const char* name, double value) { object[name] = value; }
void write_value(json& object, const char* name, const std::string& value) { object[name] = value; }
void write_value(json& object, const char* name, const Vec3& value) { object[name] = vector_to_json(value); }
void write_value(json& object, const char* name, const Transform& value) { object[name] = transform_to_json(value); }

void write_value(json& object, const char* name, const std::optional<Camera>& camera) {
    object[name] =
        camera ? json{{"position", vector_to_json(camera->position)}, {"target", vector_to_json(camera->target)}}
               : json(nullptr);
}

void read_value(FieldReader& reader, const char* name, FieldRange, bool& value) { reader.truth(name, value); }

void read_value(FieldReader& reader, const char* name, FieldRange range, int& value) {
    reader.whole(name, value, whole_bound<int>(range.low), whole_bound<int>(range.high));
}

void read_value(FieldReader& reader, const char* name, FieldRange range, std::uint32_t& value) {
    reader.whole(name, value, whole_bound<std::uint32_t>(range.low), whole_bound<std::uint32_t>(range.high));
}

void read_value(FieldReader& reader, const char* name, FieldRange range, double& value) {
    reader.number(name, value, {range.low, range.high});
}

void read_value(FieldReader& reader, const char* name, FieldRange, std::string& value) { reader.text(name, value); }
void read_value(FieldReader& reader, const char* name, FieldRange, Vec3& value) { reader.vector(name, value); }
void read_value(FieldReader& reader, const char* name, FieldRange, Transform& value) { reader.transform(name, value); }

void read_value(FieldReader& reader, const char* name, FieldRange, std::optional<Camera>& camera) {
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    Camera read;
    FieldReader inner(*field, reader.path(name), reader.error());
    inner.vector("position", read.position);
    inner.vector("target", read.target);
    if (inner.finish()) camera = read;
}

}  // namespace embody::scene
