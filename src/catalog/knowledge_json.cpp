// SPDX-License-Identifier: MIT
#include "catalog/knowledge_json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"

namespace embody::catalog {
namespace {

using Json = nlohmann::json;
using attributes::AttributeEntry;
using attributes::AttributeSet;
using attributes::AttributeValue;
using attributes::ModelFacts;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

// JSON has no infinity; "inf" as a number's text is told from a word by the key it stands under.
Json from_number(double number) {
    if (std::isfinite(number)) return number;
    return std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf";
}
double to_number(const Json& json) {
    if (!json.is_string()) return json.get<double>();
    const std::string& word = json.get_ref<const std::string&>();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return word == "inf" ? infinity : word == "-inf" ? -infinity : std::numeric_limits<double>::quiet_NaN();
}

Json from_vector(Vec3 v) { return Json::array({from_number(v.x), from_number(v.y), from_number(v.z)}); }
Vec3 to_vector(const Json& json) { return {to_number(json.at(0)), to_number(json.at(1)), to_number(json.at(2))}; }

// By columns, as Mat3 holds them.
Json from_matrix(const Mat3& m) { return Json::array({from_vector(m.x), from_vector(m.y), from_vector(m.z)}); }
Mat3 to_matrix3(const Json& json) { return {to_vector(json.at(0)), to_vector(json.at(1)), to_vector(json.at(2))}; }

// {"number": …}, {"word": …}, {"truth": …}, {"vector": …} or {"tensor": …}, written into the entry itself.
void put_value(Json& json, const AttributeValue& value) {
    if (const auto* number = std::get_if<double>(&value)) json["number"] = from_number(*number);
    if (const auto* word = std::get_if<std::string>(&value)) json["word"] = *word;
    if (const auto* truth = std::get_if<bool>(&value)) json["truth"] = *truth;
    if (const auto* vector = std::get_if<Vec3>(&value)) json["vector"] = from_vector(*vector);
    if (const auto* tensor = std::get_if<Mat3>(&value)) json["tensor"] = from_matrix(*tensor);
}

Result<AttributeValue> get_value(const Json& json) {
    if (json.contains("number")) return AttributeValue(to_number(json.at("number")));
    if (json.contains("word")) return AttributeValue(json.at("word").get<std::string>());
    if (json.contains("truth")) return AttributeValue(json.at("truth").get<bool>());
    if (json.contains("vector")) return AttributeValue(to_vector(json.at("vector")));
    if (json.contains("tensor")) return AttributeValue(to_matrix3(json.at("tensor")));
    return Error{"stored attribute", "has no value", {}};
}

Json from_entry(const AttributeEntry& entry) {
    Json json = {{"name", entry.name}};
    put_value(json, entry.value);
    if (entry.low) json["low"] = from_number(*entry.low);
    if (entry.high) json["high"] = from_number(*entry.high);
    json["source"] = entry.source;
    json["level"] = attributes::level_name(entry.level);
    return json;
}

Result<AttributeEntry> to_entry(const Json& json) {
    AttributeEntry entry;
    entry.name = json.at("name").get<std::string>();
    auto value = get_value(json);
    if (!value) return value.error();
    entry.value = std::move(*value);
    if (json.contains("low")) entry.low = to_number(json.at("low"));
    if (json.contains("high")) entry.high = to_number(json.at("high"));
    entry.source = json.at("source").get<std::string>();
    const auto level = attributes::level_from_name(json.at("level").get<std::string>());
    if (!level) return Error{"stored attribute " + entry.name, "has an unknown level", {}};
    entry.level = *level;
    return entry;
}

// The library throws where a field is missing or of another type; nothing thrown leaves here.
template <class T, class Read>
Result<T> read_text(std::string_view text, const char* what, const Read& read) {
    try {
        return read(Json::parse(text));
    } catch (const Json::exception& problem) {
        return Error{what, std::string("cannot be read: ") + problem.what(), "import the model again"};
    }
}

}  // namespace

std::string to_json(const AttributeValue& value) {
    Json json = Json::object();
    put_value(json, value);
    return text_of(json);
}

Result<AttributeValue> value_from_json(std::string_view text) {
    return read_text<AttributeValue>(text, "stored attribute", get_value);
}

std::string to_json(const AttributeSet& set) {
    Json json = Json::array();
    for (const AttributeEntry& entry : set.entries()) json.push_back(from_entry(entry));
    return text_of(json);
}

Result<AttributeSet> set_from_json(std::string_view text) {
    return read_text<AttributeSet>(text, "stored attributes", [](const Json& json) -> Result<AttributeSet> {
        AttributeSet set;
        if (!json.is_array()) return Error{"stored attributes", "are no list", "import the model again"};
        for (const Json& element : json) {
            auto entry = to_entry(element);
            if (!entry) return entry.error();
            set.put(std::move(*entry));
        }
        return set;
    });
}

std::string to_json(const ModelFacts& facts) { return text_of(attributes::to_json(facts)); }

Result<ModelFacts> facts_from_json(std::string_view text) {
    return read_text<ModelFacts>(text, "stored facts",
                                 [](const Json& json) { return attributes::facts_from_json(json); });
}

std::string valid_utf8(const std::string& text) {
    // The JSON writer knows how to replace; reading back removes its escapes.
    return Json::parse(text_of(Json(text))).get<std::string>();
}

}  // namespace embody::catalog
