// SPDX-License-Identifier: MIT
#include "attributes/attribute_json.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "attributes/registry.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

constexpr std::array type_names{"number", "word", "truth", "vector", "tensor"};

json number_json(double value) {
    if (std::isfinite(value)) return value;
    return value > 0 ? "infinity" : "-infinity";
}
json vector_json(Vec3 v) { return json::array({v.x, v.y, v.z}); }
json tensor_json(const Mat3& m) { return json::array({m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}); }
json columns_json(const Mat3& m) { return json::array({vector_json(m.x), vector_json(m.y), vector_json(m.z)}); }

std::optional<double> number_of(const json& document) {
    if (document.is_number()) return document.get<double>();
    if (document == "infinity") return HUGE_VAL;
    if (document == "-infinity") return -HUGE_VAL;
    return std::nullopt;
}

std::optional<std::vector<double>> numbers_of(const json& document) {
    if (!document.is_array()) return std::nullopt;
    std::vector<double> numbers;
    for (const json& item : document) {
        if (!item.is_number()) return std::nullopt;
        numbers.push_back(item.get<double>());
    }
    return numbers;
}

std::optional<Vec3> vector_of(const json& document) {
    const auto n = numbers_of(document);
    if (!n || n->size() != 3) return std::nullopt;
    return Vec3{(*n)[0], (*n)[1], (*n)[2]};
}

std::optional<Mat3> tensor_of(const json& document) {
    const auto n = numbers_of(document);
    if (n && n->size() == 3) return Mat3::diagonal({(*n)[0], (*n)[1], (*n)[2]});
    if (!n || n->size() != 6) return std::nullopt;
    return Mat3{{(*n)[0], (*n)[3], (*n)[4]}, {(*n)[3], (*n)[1], (*n)[5]}, {(*n)[4], (*n)[5], (*n)[2]}};
}

template <class Value>
std::optional<AttributeValue> as_value(std::optional<Value> value) {
    if (!value) return std::nullopt;
    return AttributeValue(std::move(*value));
}

std::optional<AttributeValue> value_of(ValueType type, const json& document) {
    switch (type) {
        case ValueType::number:
            return as_value(number_of(document));
        case ValueType::word:
            return document.is_string() ? as_value(std::optional(document.get<std::string>())) : std::nullopt;
        case ValueType::truth:
            return document.is_boolean() ? as_value(std::optional(document.get<bool>())) : std::nullopt;
        case ValueType::vector:
            return as_value(vector_of(document));
        case ValueType::tensor:
            return as_value(tensor_of(document));
    }
    return std::nullopt;
}

// Reads optional fields of an object; the first of a wrong type is the error.
class FactReader {
public:
    explicit FactReader(const json& object) : object_(object) {
        if (!object.is_object()) error_ = Error{"facts", "must be an object"};
    }
    template <class Value>
    void read(const char* field, Value& value) {
        if (error_ || !object_.contains(field)) return;
        if (!take(object_[field], value)) error_ = Error{std::string("facts.") + field, "is of the wrong type"};
    }
    const json* object(const char* field) {
        if (error_ || !object_.contains(field)) return nullptr;
        return &object_[field];
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    static bool take(const json& d, std::string& value) {
        return d.is_string() && (value = d.get<std::string>(), true);
    }
    static bool take(const json& d, bool& value) { return d.is_boolean() && (value = d.get<bool>(), true); }
    static bool take(const json& d, double& value) { return d.is_number() && (value = d.get<double>(), true); }
    static bool take(const json& d, std::optional<bool>& value) {
        if (d.is_null()) return true;
        return d.is_boolean() && (value = d.get<bool>(), true);
    }
    static bool take(const json& d, Vec3& value) {
        const auto v = vector_of(d);
        return v && (value = *v, true);
    }
    static bool take(const json& d, Mat3& value) {
        return d.is_array() && d.size() == 3 && take(d[0], value.x) && take(d[1], value.y) && take(d[2], value.z);
    }
    static bool take(const json& d, Quat& value) {
        const auto n = numbers_of(d);
        if (!n || n->size() != 4) return false;
        value = {(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
        return true;
    }
    static bool take(const json& d, geometry::MassProperties& value) {
        return d.is_array() && d.size() == 3 && take(d[0], value.volume) && take(d[1], value.center) &&
               take(d[2], value.inertia);
    }
    static bool take(const json& d, std::vector<PartFacts>& value) {
        if (!d.is_array()) return false;
        for (const json& item : d) {
            PartFacts part;
            FactReader reader(item);
            reader.read("material", part.material);
            reader.read("shell", part.form.shell);
            reader.read("solid", part.form.solid);
            if (reader.error()) return false;
            value.push_back(std::move(part));
        }
        return true;
    }
    static bool take(const json& d, std::vector<std::string>& value) {
        if (!d.is_array()) return false;
        value.clear();
        for (const json& item : d) {
            if (!item.is_string()) return false;
            value.push_back(item.get<std::string>());
        }
        return true;
    }

    const json& object_;
    std::optional<Error> error_;
};

// Numbers of a body of unit density: [measure, centre, columns of the inertia].
json mass_properties_json(const geometry::MassProperties& p) {
    return json::array({p.volume, vector_json(p.center), columns_json(p.inertia)});
}

json parts_json(const std::vector<PartFacts>& parts) {
    json list = json::array();
    for (const PartFacts& part : parts) {
        list.push_back({{"material", part.material},
                        {"shell", mass_properties_json(part.form.shell)},
                        {"solid", mass_properties_json(part.form.solid)}});
    }
    return list;
}

json geometry_json(const GeometryFacts& g) {
    const Quat turn = g.fitted_pose.rotation;
    return {{"size", vector_json(g.size)},
            {"closed", g.closed},
            {"volume", g.volume},
            {"volume_method", g.volume_method},
            {"volume_relative_error", g.volume_relative_error},
            {"center_of_volume", vector_json(g.center_of_volume)},
            {"unit_inertia", columns_json(g.unit_inertia)},
            {"hull_volume", g.hull_volume},
            {"hull_concavity", g.hull_concavity},
            {"surface_area", g.surface_area},
            {"fitted_shape", g.fitted_shape},
            {"fitted_dimensions", vector_json(g.fitted_dimensions)},
            {"fitted_position", vector_json(g.fitted_pose.position)},
            {"fitted_rotation", json::array({turn.x, turn.y, turn.z, turn.w})},
            {"fitted_error", g.fitted_error},
            {"parts", parts_json(g.parts)}};
}

std::optional<Error> read_geometry(const json& document, GeometryFacts& g) {
    FactReader reader(document);
    reader.read("size", g.size);
    reader.read("closed", g.closed);
    reader.read("volume", g.volume);
    reader.read("volume_method", g.volume_method);
    reader.read("volume_relative_error", g.volume_relative_error);
    reader.read("center_of_volume", g.center_of_volume);
    reader.read("unit_inertia", g.unit_inertia);
    reader.read("hull_volume", g.hull_volume);
    reader.read("hull_concavity", g.hull_concavity);
    reader.read("surface_area", g.surface_area);
    reader.read("fitted_shape", g.fitted_shape);
    reader.read("fitted_dimensions", g.fitted_dimensions);
    reader.read("fitted_position", g.fitted_pose.position);
    reader.read("fitted_rotation", g.fitted_pose.rotation);
    reader.read("fitted_error", g.fitted_error);
    reader.read("parts", g.parts);
    return reader.error();
}

}  // namespace

nlohmann::json to_json(const AttributeValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_json(*number);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* truth = std::get_if<bool>(&value)) return *truth;
    if (const auto* vector = std::get_if<Vec3>(&value)) return vector_json(*vector);
    return tensor_json(std::get<Mat3>(value));
}

Result<AttributeValue> value_from_json(std::string_view name, const nlohmann::json& document) {
    const AttributeDescription* description = describe(name);
    if (description == nullptr) return validate(name, 0.0).error();
    const auto value = value_of(description->type, document);
    if (!value) {
        return Error{description->name,
                     std::string("must be a ") + type_names[static_cast<std::size_t>(description->type)] + ", got " +
                         document.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 80)};
    }
    if (auto valid = validate(name, *value); !valid) return valid.error();
    return *value;
}

nlohmann::json to_json(const AttributeEntry& entry) {
    json document{{"name", entry.name},
                  {"value", to_json(entry.value)},
                  {"source", entry.source},
                  {"level", level_name(entry.level)}};
    if (entry.low) document["low"] = number_json(*entry.low);
    if (entry.high) document["high"] = number_json(*entry.high);
    if (const AttributeDescription* description = describe(entry.name)) {
        document["kind"] = description->kind;
        document["unit"] = description->unit;
        document["label"] = description->label;
        document["help"] = description->help;
    }
    return document;
}

Result<AttributeEntry> entry_from_json(const nlohmann::json& document) {
    if (!document.is_object()) return Error{"attribute", "must be an object"};
    AttributeEntry entry;
    for (const char* field : {"name", "source", "level"}) {
        if (!document.contains(field) || !document[field].is_string()) {
            return Error{std::string("attribute.") + field, "must be a string"};
        }
    }
    entry.name = document["name"].get<std::string>();
    entry.source = document["source"].get<std::string>();

    // Level and value by their names.
    const auto level = level_from_name(document["level"].get_ref<const std::string&>());
    if (!level) return Error{entry.name + ".level", "is not a level"};
    entry.level = *level;
    if (!document.contains("value")) return Error{entry.name + ".value", "is missing"};
    auto value = value_from_json(entry.name, document["value"]);
    if (!value) return value.error();
    entry.value = std::move(*value);

    for (const auto& [field, end] : {std::pair{"low", &entry.low}, std::pair{"high", &entry.high}}) {
        if (!document.contains(field)) continue;
        *end = number_of(document[field]);
        if (!*end) return Error{entry.name + "." + field, "must be a number"};
    }
    return entry;
}

nlohmann::json to_json(const AttributeSet& set) {
    json list = json::array();
    for (const AttributeEntry& entry : set.entries()) list.push_back(to_json(entry));
    return list;
}

Result<AttributeSet> set_from_json(const nlohmann::json& document) {
    if (!document.is_array()) return Error{"attributes", "must be a list"};
    AttributeSet set;
    for (const json& item : document) {
        auto entry = entry_from_json(item);
        if (!entry) return entry.error();
        if (set.find(entry->name) != nullptr) return Error{entry->name, "is there twice"};
        set.put(std::move(*entry));
    }
    return set;
}

nlohmann::json registry_to_json() {
    json list = json::array();
    for (const AttributeDescription& d : registry()) {
        json row{{"name", d.name},
                 {"kind", d.kind},
                 {"type", type_names[static_cast<std::size_t>(d.type)]},
                 {"unit", d.unit},
                 {"default", to_json(d.standard)},
                 {"applies_to", d.applies_to},
                 {"label", d.label},
                 {"help", d.help}};
        if (d.low) row["low"] = *d.low;
        if (d.high) row["high"] = *d.high;
        if (!d.choices.empty()) row["choices"] = d.choices;
        list.push_back(std::move(row));
    }
    return list;
}

nlohmann::json to_json(const ModelFacts& facts) {
    json document{{"name", facts.name},
                  {"tags", facts.tags},
                  {"catalogue_category", facts.catalogue_category},
                  {"folder", facts.folder},
                  {"material_names", facts.material_names},
                  {"door_or_window", facts.door_or_window},
                  {"size_is_stated", facts.size_is_stated},
                  {"geometry", geometry_json(facts.geometry)}};
    if (!facts.stated_thing.empty()) document["stated_thing"] = facts.stated_thing;
    if (facts.movable) document["movable"] = *facts.movable;
    return document;
}

Result<ModelFacts> facts_from_json(const nlohmann::json& document) {
    ModelFacts facts;
    FactReader reader(document);
    reader.read("name", facts.name);
    reader.read("tags", facts.tags);
    reader.read("catalogue_category", facts.catalogue_category);
    reader.read("folder", facts.folder);
    reader.read("stated_thing", facts.stated_thing);
    reader.read("material_names", facts.material_names);
    reader.read("door_or_window", facts.door_or_window);
    reader.read("size_is_stated", facts.size_is_stated);
    reader.read("movable", facts.movable);
    const json* geometry = reader.object("geometry");
    if (reader.error()) return *reader.error();
    if (geometry != nullptr) {
        if (auto error = read_geometry(*geometry, facts.geometry)) return *error;
    }
    return facts;
}

}  // namespace embody::attributes
