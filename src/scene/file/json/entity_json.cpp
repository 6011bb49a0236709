// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"

namespace embody::scene {

using nlohmann::json;

namespace {

json pin_to_json(const Pin& pin) {
    static_assert(count_members<Pin>() == 4, "each member is written here and read below");
    json out = {{"position", vector_to_json(pin.position)}, {"radius", pin.radius}};
    if (pin.to) out["to"] = *pin.to;
    if (pin.clamped) out["clamped"] = true;
    return out;
}

Pin read_pin(FieldReader& reader) {
    Pin pin;
    reader.need("position", "the place that is held, in the entity's frame");
    reader.vector("position", pin.position);
    reader.number("radius", pin.radius, {0, 1e4});
    std::uint32_t to = 0;
    if (reader.whole("to", to, 1, last_document_index)) pin.to = to;
    reader.truth("clamped", pin.clamped);
    return pin;
}

}  // namespace

// An entity has one of the two.
void read_value(FieldReader& reader, const char*, FieldRange, Geometry& geometry) {
    std::string key;
    const bool is_model = reader.text("model", key);
    const json* shape = reader.take("shape");
    if (!reader.ok() || (!is_model && !shape)) return;
    if (is_model && shape) {
        reader.fail(reader.path("shape"), "goes without a model: an entity is one of the two");
    } else if (is_model) {
        if (key.empty()) reader.fail(reader.path("model"), "must be the key of a model");
        geometry = ModelReference{key};
    } else {
        Result<physics::ShapeDefinition> read = shape_from_json(*shape, reader.path("shape"));
        if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
        geometry = std::move(read).value();
    }
}

void write_value(json& object, const char*, const Geometry& geometry) {
    if (const auto* model = std::get_if<ModelReference>(&geometry))
        object["model"] = model->key;
    else
        object["shape"] = shape_to_json(std::get<physics::ShapeDefinition>(geometry));
}

// All attributes at once, and so all pins below.
void read_value(FieldReader& reader, const char* name, FieldRange,
                std::map<std::string, attributes::AttributeValue>& attributes) {
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    const std::string where = reader.path(name);
    if (!field->is_object()) return reader.fail(where, "must be an object of name: value");
    attributes.clear();
    for (const auto& [attribute, value] : field->items()) {
        Result<attributes::AttributeValue> read = attribute_from_json(attribute, value, where + "." + attribute);
        if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
        attributes[attribute] = read.value();
    }
}

void write_value(json& object, const char* name, const std::map<std::string, attributes::AttributeValue>& attributes) {
    json manual = json::object();
    for (const auto& [attribute, value] : attributes) manual[attribute] = attributes::to_json(value);
    object[name] = std::move(manual);
}

// Null takes the colour away.
void read_value(FieldReader& reader, const char* name, FieldRange, std::optional<std::array<double, 3>>& color) {
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    if (field->is_null()) return color.reset();
    const std::string where = reader.path(name);
    if (!field->is_array() || field->size() != 3)
        return reader.fail(where, "must be three numbers from 0 to 1: [red, green, blue]");
    std::array<double, 3> read{};
    for (std::size_t i = 0; i < 3; ++i)
        if (!read_number((*field)[i], element_path(where, i), read[i], reader.error(), {0, 1})) return;
    color = read;
}

void write_value(json& object, const char* name, const std::optional<std::array<double, 3>>& color) {
    object[name] = color ? json(*color) : json(nullptr);
}

void read_value(FieldReader& reader, const char* name, FieldRange, std::vector<Pin>& pins) {
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    const std::string where = reader.path(name);
    if (!read_array(*field, where, reader.error())) return;
    pins.clear();
    for (std::size_t i = 0; i < field->size() && reader.ok(); ++i) {
        FieldReader item((*field)[i], element_path(where, i), reader.error());
        const Pin pin = read_pin(item);
        if (item.finish()) pins.push_back(pin);
    }
}

void write_value(json& object, const char* name, const std::vector<Pin>& pins) {
    json list = json::array();
    for (const Pin& pin : pins) list.push_back(pin_to_json(pin));
    object[name] = std::move(list);
}

Result<void> change_entity_from_json(Entity& entity, const json& value, const std::string& where, bool is_new) {
    Entity changed = entity;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    read_fields(reader, changed);
    for (std::size_t i = 0; i < changed.pins.size(); ++i)
        if (changed.index != 0 && changed.pins[i].to == changed.index)
            reader.fail(element_path(reader.path("pins"), i) + ".to", "must be another entity");
    if (!reader.finish()) return *error;
    // Last, so that a slip in the field's name is told as such.
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
