// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "scene/file/json/field_reader.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"

namespace embody::scene {

using nlohmann::json;

namespace {

// A model's key or a shape; an entity has one of the two.
bool read_geometry(FieldReader& reader, Entity& entity) {
    std::string key;
    const bool is_model = reader.text("model", key);
    const json* shape = reader.take("shape");
    if (!reader.ok() || (!is_model && !shape)) return false;
    if (is_model && shape) {
        reader.fail(reader.path("shape"), "goes without a model: an entity is one of the two");
    } else if (is_model) {
        if (key.empty()) reader.fail(reader.path("model"), "must be the key of a model");
        entity.geometry = ModelReference{key};
    } else {
        Result<physics::ShapeDefinition> read = shape_from_json(*shape, reader.path("shape"));
        if (!read.ok()) {
            reader.fail(read.error().where, read.error().why, read.error().remedy);
            return false;
        }
        entity.geometry = std::move(read).value();
    }
    return true;
}

void read_attributes(FieldReader& reader, Entity& entity) {
    const json* field = reader.take("attributes");
    if (!field || !reader.ok()) return;
    if (!field->is_object()) return reader.fail(reader.path("attributes"), "must be an object of name: value");
    entity.attributes.clear();
    for (const auto& [name, value] : field->items()) {
        Result<attributes::AttributeValue> read = attribute_from_json(name, value, reader.path("attributes." + name));
        if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
        entity.attributes[name] = read.value();
    }
}

// Null takes the colour away.
void read_color(FieldReader& reader, Entity& entity) {
    const json* field = reader.take("color");
    if (!field || !reader.ok()) return;
    if (field->is_null()) {
        entity.color.reset();
        return;
    }
    if (!field->is_array() || field->size() != 3)
        return reader.fail(reader.path("color"), "must be three numbers from 0 to 1: [red, green, blue]");
    std::array<double, 3> color{};
    for (std::size_t i = 0; i < 3; ++i)
        if (!read_number((*field)[i], element_path(reader.path("color"), i), color[i], reader.error(), {0, 1})) return;
    entity.color = color;
}

// All pins at once, as attributes are.
void read_pins(FieldReader& reader, Entity& entity) {
    const json* field = reader.take("pins");
    if (!field || !reader.ok()) return;
    const std::string where = reader.path("pins");
    if (!read_array(*field, where, reader.error())) return;
    entity.pins.clear();
    for (std::size_t i = 0; i < field->size() && reader.ok(); ++i) {
        FieldReader item((*field)[i], element_path(where, i), reader.error());
        Pin pin;
        item.need("position", "the place that is held, in the entity's frame");
        item.vector("position", pin.position);
        item.number("radius", pin.radius, {0, 1e4});
        std::uint32_t to = 0;
        if (item.whole("to", to, 1, last_document_index)) pin.to = to;
        item.truth("clamped", pin.clamped);
        if (pin.to == entity.index && entity.index != 0) reader.fail(item.path("to"), "must be another entity");
        if (item.finish()) entity.pins.push_back(pin);
    }
}

json pins_to_json(const std::vector<Pin>& pins) {
    json out = json::array();
    for (const Pin& pin : pins) {
        out.push_back({{"position", vector_to_json(pin.position)}, {"radius", pin.radius}});
        if (pin.to) out.back()["to"] = *pin.to;
        if (pin.clamped) out.back()["clamped"] = true;
    }
    return out;
}

}  // namespace

Result<void> change_entity_from_json(Entity& entity, const json& value, const std::string& where, bool is_new) {
    Entity changed = entity;
    std::optional<Error> error;
    FieldReader reader(value, where, error);
    reader.text("name", changed.name);
    const bool has_geometry = read_geometry(reader, changed);
    read_attributes(reader, changed);
    reader.transform("pose", changed.pose);
    reader.vector("linear_velocity", changed.linear_velocity);
    reader.vector("angular_velocity", changed.angular_velocity);
    reader.vector("force", changed.force);
    reader.vector("torque", changed.torque);
    reader.truth("enabled", changed.enabled);
    reader.truth("start_asleep", changed.start_asleep);
    reader.truth("allow_sleep", changed.allow_sleep);
    reader.truth("continuous", changed.continuous);
    reader.text("category", changed.category);
    read_color(reader, changed);
    reader.number("scale", changed.scale, {1e-4, 1e4});
    std::uint32_t index = entity.index;
    if (reader.whole("index", index, 1, last_document_index) && is_new) changed.index = index;
    read_pins(reader, changed);
    if (!reader.finish()) return *error;
    // Last, so that a slip in the field's name is told as such.
    if (is_new && !has_geometry) return Error{reader.path("model"), "is missing: an entity needs a model or a shape"};
    if (!is_new && index != entity.index) return Error{reader.path("index"), "of an entity can't be changed"};
    entity = std::move(changed);
    return {};
}

Result<Entity> entity_from_json(const json& value, const std::string& where) {
    Entity entity;
    if (const Result<void> read = change_entity_from_json(entity, value, where, true); !read.ok()) return read.error();
    return entity;
}

json entity_to_json(const Entity& entity) {
    json out = {{"index", entity.index}, {"name", entity.name}, {"pose", transform_to_json(entity.pose)}};
    if (const auto* model = std::get_if<ModelReference>(&entity.geometry)) {
        out["model"] = model->key;
    } else {
        out["shape"] = shape_to_json(std::get<physics::ShapeDefinition>(entity.geometry));
    }

    // What is as it would be anyway is not written.
    const Entity plain;
    const auto write_vector = [&out](const char* name, Vec3 value) {
        if (value != Vec3{}) out[name] = vector_to_json(value);
    };
    if (!entity.attributes.empty()) {
        json manual = json::object();
        for (const auto& [name, attribute] : entity.attributes) manual[name] = attributes::to_json(attribute);
        out["attributes"] = std::move(manual);
    }
    write_vector("linear_velocity", entity.linear_velocity);
    write_vector("angular_velocity", entity.angular_velocity);
    write_vector("force", entity.force);
    write_vector("torque", entity.torque);
    if (entity.enabled != plain.enabled) out["enabled"] = entity.enabled;
    if (entity.start_asleep != plain.start_asleep) out["start_asleep"] = entity.start_asleep;
    if (entity.allow_sleep != plain.allow_sleep) out["allow_sleep"] = entity.allow_sleep;
    if (entity.continuous != plain.continuous) out["continuous"] = entity.continuous;
    if (!entity.category.empty()) out["category"] = entity.category;
    if (entity.color) out["color"] = *entity.color;
    if (entity.scale != plain.scale) out["scale"] = entity.scale;
    if (!entity.pins.empty()) out["pins"] = pins_to_json(entity.pins);
    return out;
}

}  // namespace embody::scene
