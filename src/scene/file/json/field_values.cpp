// SPDX-License-Identifier: MIT
#include "scene/file/json/field_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "attributes/attribute_json.h"
#include "scene/document/document_field.h"
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
void write_value(json& object, const char* name, const std::vector<std::uint32_t>& values) { object[name] = values; }
void write_value(json& object, const char* name, Finish value) {
    object[name] = finish_names[static_cast<std::size_t>(value)];
}
void write_value(json& object, const char* name, const Vec3& value) { object[name] = vector_to_json(value); }
void write_value(json& object, const char* name, const Transform& value) { object[name] = transform_to_json(value); }

void read_value(FieldReader& reader, const char* name, NumberRange, bool& value) { reader.truth(name, value); }

void read_value(FieldReader& reader, const char* name, NumberRange range, int& value) {
    reader.whole(name, value, whole_bound<int>(range.low), whole_bound<int>(range.high));
}

void read_value(FieldReader& reader, const char* name, NumberRange range, std::uint32_t& value) {
    reader.whole(name, value, whole_bound<std::uint32_t>(range.low), whole_bound<std::uint32_t>(range.high));
}

void read_value(FieldReader& reader, const char* name, NumberRange range, double& value) {
    reader.number(name, value, range);
}

void read_value(FieldReader& reader, const char* name, NumberRange, std::string& value) { reader.text(name, value); }
void read_value(FieldReader& reader, const char* name, NumberRange range, std::vector<std::uint32_t>& values) {
    const json* list = reader.list(name);
    if (!list) return;
    std::vector<std::uint32_t> read;
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string where = element_path(reader.path(name), i);
        double number = 0;
        if (!read_number(
                (*list)[i], where, number, reader.error(),
                {std::max(range.low, 0.0), std::min<double>(range.high, std::numeric_limits<std::uint32_t>::max())}))
            return;
        if (number != std::floor(number)) return reader.fail(where, "must be a whole number");
        read.push_back(static_cast<std::uint32_t>(number));
    }
    values = std::move(read);
}
void read_value(FieldReader& reader, const char* name, NumberRange, Finish& value) {
    std::string word;
    if (!reader.text(name, word)) return;
    const auto found = std::ranges::find(finish_names, word, [](const char* known) { return std::string_view(known); });
    if (found == finish_names.end()) {
        std::string known;
        for (const char* each : finish_names) known += (known.empty() ? "" : ", ") + std::string(each);
        return reader.refuse(name, "must be one of " + known + ", got \"" + word + "\"");
    }
    value = static_cast<Finish>(found - finish_names.begin());
}
void read_value(FieldReader& reader, const char* name, NumberRange, Vec3& value) { reader.vector(name, value); }
void read_value(FieldReader& reader, const char* name, NumberRange, Transform& value) { reader.transform(name, value); }

// "any", {"index": 3}, {"name": "Ball"} or {"category": "ball"}.
void read_value(FieldReader& reader, const char* name, NumberRange, Target& target) {
    const json* field = reader.take(name);
    if (!field) return;
    if (field->is_string() && field->get_ref<const std::string&>() == "any") {
        target = {};
        return;
    }
    if (!field->is_object())
        return reader.refuse(name, "must be \"any\", {\"index\": number}, {\"name\": text} or {\"category\": text}");
    Target read;
    FieldReader inner(*field, reader.path(name), reader.error());
    int given = 0;
    if (inner.whole("index", read.index, 1)) read.by = Target::By::index, ++given;
    if (inner.text("name", read.word)) read.by = Target::By::name, ++given;
    if (inner.text("category", read.word)) read.by = Target::By::category, ++given;
    if (!inner.finish()) return;
    if (given != 1) return reader.refuse(name, "must say exactly one of index, name and category");
    target = read;
}

void write_value(json& object, const char* name, const Target& target) {
    switch (target.by) {
        case Target::By::index:
            object[name] = {{"index", target.index}};
            return;
        case Target::By::name:
            object[name] = {{"name", target.word}};
            return;
        case Target::By::category:
            object[name] = {{"category", target.word}};
            return;
        case Target::By::any:
            object[name] = "any";
    }
}

void read_value(FieldReader& reader, const char* name, NumberRange, attributes::AttributeValue& value) {
    std::string attribute;
    reader.text("name", attribute);
    const json* field = reader.take(name);
    if (!field || !reader.ok()) return;
    Result<attributes::AttributeValue> read = attribute_from_json(attribute, *field, reader.path(name));
    if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
    value = std::move(read).value();
}

void write_value(json& object, const char* name, const attributes::AttributeValue& value) {
    object[name] = attributes::to_json(value);
}

// Replaces all attributes.
void read_value(FieldReader& reader, const char* name, NumberRange,
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

// Null removes the colour.
void read_value(FieldReader& reader, const char* name, NumberRange, std::optional<std::array<double, 3>>& color) {
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

// An entity has either a model or a shape.
void read_fields(FieldReader& reader, Geometry& geometry) {
    std::string key;
    const bool is_model = reader.text("model", key);
    const json* shape = reader.take("shape");
    if (!reader.ok() || (!is_model && !shape)) return;
    if (is_model && shape) {
        reader.refuse("shape", "goes without a model: an entity is one of the two");
    } else if (is_model) {
        if (key.empty()) reader.refuse("model", "must be the key of a model");
        geometry = ModelReference{key};
    } else {
        Result<physics::ShapeDefinition> read = shape_from_json(*shape, reader.path("shape"));
        if (!read.ok()) return reader.fail(read.error().where, read.error().why, read.error().remedy);
        geometry = std::move(read).value();
    }
}

void write_fields(json& object, const Geometry& geometry) {
    if (const auto* model = std::get_if<ModelReference>(&geometry))
        object["model"] = model->key;
    else
        object["shape"] = shape_to_json(std::get<physics::ShapeDefinition>(geometry));
}

void check_value(FieldReader& reader, const Bounds& box) {
    if (reader.ok() && box.is_empty()) reader.refuse("upper", "must be above lower in every coordinate");
}

void check_value(FieldReader& reader, const OnSignal& signal) {
    if (reader.ok() && signal.key.empty() == signal.button.empty())
        reader.refuse("key", "say either a key or a button");
}

void check_value(FieldReader& reader, const physics::JointLimit& limit) {
    if (limit.lower > limit.upper) reader.refuse("", "lower must not be above upper");
}

void check_value(FieldReader& reader, const physics::WorldSettings& settings) {
    const Result<void> valid = physics::validate(settings);
    if (!valid.ok()) reader.refuse(document_field(valid.error().where), valid.error().why, valid.error().remedy);
}

void write_null(json& object, const char* name) { object[name] = nullptr; }
bool is_null(const json& value) { return value.is_null(); }
json& add_object(json& object, const char* name) { return object[name] = json::object(); }
json& add_list(json& object, const char* name) { return object[name] = json::array(); }
json& append_object(json& list) { return list.emplace_back(json::object()); }

bool read_items(FieldReader& reader, const char* name, const std::function<void(FieldReader& item)>& read) {
    const json* list = reader.list(name);
    if (!list) return false;
    for (std::size_t i = 0; i < list->size() && reader.ok(); ++i) {
        FieldReader item((*list)[i], element_path(reader.path(name), i), reader.error());
        read(item);
    }
    return reader.ok();
}

bool read_type(FieldReader& reader, std::span<const char* const> words, std::size_t& type) {
    std::string choices;
    for (std::size_t i = 0; i < words.size(); ++i)
        choices += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + std::string(words[i]);
    reader.need("type", choices.c_str());
    return reader.choice("type", type, words);
}

}  // namespace embody::scene
