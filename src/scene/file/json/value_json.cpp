// SPDX-License-Identifier: MIT
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "scene/file/json/parts.h"

namespace embody::scene {

using attributes::AttributeValue;
using nlohmann::json;

json vector_to_json(Vec3 vector) { return json::array({vector.x, vector.y, vector.z}); }

json rotation_to_json(Quat rotation) { return json::array({rotation.x, rotation.y, rotation.z, rotation.w}); }

json transform_to_json(const Transform& transform) {
    return {{"position", vector_to_json(transform.position)}, {"rotation", rotation_to_json(transform.rotation)}};
}

json float_to_json(float value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    double shortest = 0;
    std::from_chars(text.data(), end, shortest);
    return shortest;
}

Result<AttributeValue> attribute_from_json(const std::string& name, const json& value, const std::string& where) {
    Result<AttributeValue> read = attributes::value_from_json(name, value);
    if (read.ok()) return read;
    // The registry checks name, type and range; the place in the file is added here.
    Error refused = read.error();
    refused.where = where;
    return refused;
}

}  // namespace embody::scene
