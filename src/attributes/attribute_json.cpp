// SPDX-License-Identifier: MIT
#include "attributes/attribute_json.h"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "attributes/field_reader.h"
#include "attributes/registry.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

constexpr std::array type_names{"number", "word", "truth", "vector", "tensor"};

std::string infinity_word(AttributeForm form) { return form == AttributeForm::told ? "infinity" : "inf"; }

json number_json(double value, AttributeForm form) {
    if (std::isfinite(value)) return value;
    if (std::isnan(value)) return "nan";
    return (value > 0 ? "" : "-") + infinity_word(form);
}

std::optional<double> number_of(const json& document, AttributeForm form) {
    if (document.is_number()) return document.get<double>();
    if (document == infinity_word(form)) return std::numeric_limits<double>::infinity();
    if (document == "-" + infinity_word(form)) return -std::numeric_limits<double>::infinity();
    if (form == AttributeForm::stored && document == "nan") return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

std::optional<std::vector<double>> numbers_of(const json& document, AttributeForm form) {
    if (!document.is_array()) return std::nullopt;
    std::vector<double> numbers;
    for (const json& item : document) {
        const auto number = number_of(item, form);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

json vector_json(Vec3 v, AttributeForm form) {
    return json::array({number_json(v.x, form), number_json(v.y, form), number_json(v.z, form)});
}

std::optional<Vec3> vector_of(const json& document, AttributeForm form) {
    const auto n = numbers_of(document, form);
    if (!n || n->size() != 3) return std::nullopt;
    return Vec3{(*n)[0], (*n)[1], (*n)[2]};
}

// The six numbers of a symmetric tensor, or the columns of any.
json tensor_json(const Mat3& m, AttributeForm form) {
    if (form == AttributeForm::stored)
        return json::array({vector_json(m.x, form), vector_json(m.y, form), vector_json(m.z, form)});
    json numbers = json::array();
    for (const double number : {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)})
        numbers.push_back(number_json(number, form));
    return numbers;
}

std::optional<Mat3> tensor_of(const json& document, AttributeForm form) {
    if (form == AttributeForm::stored) {
        if (!document.is_array() || document.size() != 3) return std::nullopt;
        const auto x = vector_of(document[0], form), y = vector_of(document[1], form), z = vector_of(document[2], form);
        return x && y && z ? std::optional(Mat3{*x, *y, *z}) : std::nullopt;
    }
    const auto n = numbers_of(document, form);
    if (n && n->size() == 3) return Mat3::diagonal({(*n)[0], (*n)[1], (*n)[2]});
    if (!n || n->size() != 6) return std::nullopt;
    return Mat3{{(*n)[0], (*n)[3], (*n)[4]}, {(*n)[3], (*n)[1], (*n)[5]}, {(*n)[4], (*n)[5], (*n)[2]}};
}

json content_json(const AttributeValue& value, AttributeForm form) {
    if (const auto* number = std::get_if<double>(&value)) return number_json(*number, form);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* truth = std::get_if<bool>(&value)) return *truth;
    if (const auto* vector = std::get_if<Vec3>(&value)) return vector_json(*vector, form);
    return tensor_json(std::get<Mat3>(value), form);
}

template <class Value>
std::optional<AttributeValue> as_value(std::optional<Value> value) {
    if (!value) return std::nullopt;
    return AttributeValue(std::move(*value));
}

std::optional<AttributeValue> content_of(ValueType type, const json& document, AttributeForm form) {
    switch (type) {
        case ValueType::number:
            return as_value(number_of(document, form));
        case ValueType::word:
            return document.is_string() ? as_value(std::optional(document.get<std::string>())) : std::nullopt;
        case ValueType::truth:
            return document.is_boolean() ? as_value(std::optional(document.get<bool>())) : std::nullopt;
        case ValueType::vector:
            return as_value(vector_of(document, form));
        case ValueType::tensor:
            return as_value(tensor_of(document, form));
    }
    return std::nullopt;
}

Error wrong_type(std::string where, ValueType type, const json& document) {
    return {std::move(where), std::string("must be a ") + type_names[static_cast<std::size_t>(type)] + ", got " +
                                  document.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 80)};
}

Result<AttributeValue> value_of_entry(FieldReader& reader, const json& document, const std::string& name,
                                      AttributeForm form, const std::string& where) {
    if (form == AttributeForm::stored) return stored_value_from_json(document, where);
    const json* value = reader.need("value", "the attribute's value");
    if (value == nullptr) return *reader.error();
    return value_from_json(name, *value);
}

void read_end(FieldReader& reader, const char* name, AttributeForm form, std::optional<double>& end) {
    const json* given = reader.take(name);
    if (given == nullptr) return;
    end = number_of(*given, form);
    if (!end) reader.refuse(name, std::string("must be a number, got ") + json_kind(*given));
}

}  // namespace

nlohmann::json to_json(const AttributeValue& value, AttributeForm form) {
    if (form == AttributeForm::told) return content_json(value, form);
    return json{{type_names[value.index()], content_json(value, form)}};
}

Result<AttributeValue> value_from_json(std::string_view name, const nlohmann::json& document) {
    const AttributeDescription* description = describe(name);
    if (description == nullptr) return validate(name, 0.0).error();
    const auto value = content_of(description->type, document, AttributeForm::told);
    if (!value) return wrong_type(description->name, description->type, document);
    if (auto valid = validate(name, *value); !valid) return valid.error();
    return *value;
}

Result<AttributeValue> stored_value_from_json(const nlohmann::json& document, const std::string& where) {
    for (std::size_t i = 0; i < type_names.size(); ++i) {
        if (!document.is_object() || !document.contains(type_names[i])) continue;
        const auto type = static_cast<ValueType>(i);
        auto value = content_of(type, document[type_names[i]], AttributeForm::stored);
        if (!value) return wrong_type(where + "." + type_names[i], type, document[type_names[i]]);
        return std::move(*value);
    }
    return Error{where, "has no value", "import the model again"};
}

nlohmann::json to_json(const AttributeEntry& entry, AttributeForm form) {
    json document =
        form == AttributeForm::told ? json{{"value", to_json(entry.value, form)}} : to_json(entry.value, form);
    document["name"] = entry.name;
    document["source"] = entry.source;
    document["level"] = level_name(entry.level);
    if (entry.low) document["low"] = number_json(*entry.low, form);
    if (entry.high) document["high"] = number_json(*entry.high, form);
    const AttributeDescription* description = form == AttributeForm::told ? describe(entry.name) : nullptr;
    if (description != nullptr) {
        document["kind"] = description->kind;
        document["unit"] = description->unit;
        document["label"] = description->label;
        document["help"] = description->help;
    }
    return document;
}

Result<AttributeEntry> entry_from_json(const nlohmann::json& document, const std::string& where, AttributeForm form) {
    AttributeEntry entry;
    FieldReader reader(document, where);
    reader.require({"name", "source", "level"});
    std::string level;
    reader.text("name", entry.name);
    reader.text("source", entry.source);
    if (reader.text("level", level)) {
        const auto known = level_from_name(level);
        if (known)
            entry.level = *known;
        else
            reader.refuse("level", "\"" + level + "\" is not a level");
    }
    if (!reader.ok()) return *reader.error();
    auto value = value_of_entry(reader, document, entry.name, form, where);
    if (!value) return value.error();
    entry.value = std::move(*value);
    read_end(reader, "low", form, entry.low);
    read_end(reader, "high", form, entry.high);
    if (!reader.ok()) return *reader.error();
    return entry;
}

nlohmann::json to_json(const AttributeSet& set, AttributeForm form) {
    json list = json::array();
    for (const AttributeEntry& entry : set.entries()) list.push_back(to_json(entry, form));
    return list;
}

Result<AttributeSet> set_from_json(const nlohmann::json& document, const std::string& where, AttributeForm form) {
    std::optional<Error> error;
    if (!read_array(document, where, error)) return *error;
    AttributeSet set;
    for (std::size_t i = 0; i < document.size(); ++i) {
        auto entry = entry_from_json(document[i], element_path(where, i), form);
        if (!entry) return entry.error();
        if (set.find(entry->name) != nullptr) return Error{element_path(where, i) + ".name", "is there twice"};
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

}  // namespace embody::attributes
