// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/document/document.h"
#include "scene/file/json/field_reader.h"

namespace embody::scene {

// JSON readers and writers of field values that are not made of others: a pair for each type.

void write_value(nlohmann::json& object, const char* name, bool value);
void write_value(nlohmann::json& object, const char* name, int value);
void write_value(nlohmann::json& object, const char* name, std::uint32_t value);
void write_value(nlohmann::json& object, const char* name, double value);
void write_value(nlohmann::json& object, const char* name, const std::string& value);
void write_value(nlohmann::json& object, const char* name, const std::vector<std::uint32_t>& values);
void write_value(nlohmann::json& object, const char* name, const PackedNumbers& numbers);
void write_value(nlohmann::json& object, const char* name, Finish value);
void write_value(nlohmann::json& object, const char* name, const Vec3& value);
void write_value(nlohmann::json& object, const char* name, const Transform& value);
void write_value(nlohmann::json& object, const char* name, const Target& target);
void write_value(nlohmann::json& object, const char* name, const attributes::AttributeValue& value);
void write_value(nlohmann::json& object, const char* name, const std::optional<std::array<double, 3>>& color);
void write_value(nlohmann::json& object, const char* name,
                 const std::map<std::string, attributes::AttributeValue>& attributes);

// Each leaves the value unchanged where the field is missing.
void read_value(FieldReader& reader, const char* name, NumberRange range, bool& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, int& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, std::uint32_t& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, double& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, std::string& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, std::vector<std::uint32_t>& values);
/// Finite numbers, at most max_packed_numbers.
void read_value(FieldReader& reader, const char* name, NumberRange range, PackedNumbers& numbers);
void read_value(FieldReader& reader, const char* name, NumberRange range, Finish& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, Vec3& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, Transform& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, Target& target);
/// A value of the attribute that the field "name" beside it names.
void read_value(FieldReader& reader, const char* name, NumberRange range, attributes::AttributeValue& value);
void read_value(FieldReader& reader, const char* name, NumberRange range, std::optional<std::array<double, 3>>& color);
void read_value(FieldReader& reader, const char* name, NumberRange range,
                std::map<std::string, attributes::AttributeValue>& attributes);

/// A model's key or a shape, each with its own field name.
void write_fields(nlohmann::json& object, const Geometry& geometry);
void read_fields(FieldReader& reader, Geometry& geometry);

// Checks conditions between fields.
void check_value(FieldReader& reader, const Bounds& box);
void check_value(FieldReader& reader, const OnSignal& signal);
void check_value(FieldReader& reader, const KeptForm& kept);
void check_value(FieldReader& reader, const physics::JointLimit& limit);
void check_value(FieldReader& reader, const physics::WorldSettings& settings);

// Building blocks of the JSON of listed values.

/// Writes null under the name; an empty object or list under the name; an empty object at the end of a list.
void write_null(nlohmann::json& object, const char* name);
bool is_null(const nlohmann::json& value);
nlohmann::json& add_object(nlohmann::json& object, const char* name);
nlohmann::json& add_list(nlohmann::json& object, const char* name);
nlohmann::json& append_object(nlohmann::json& list);
/// Reads a list's items one by one; returns whether the list is there.
bool read_items(FieldReader& reader, const char* name, const std::function<void(FieldReader& item)>& read);
/// Index of the word in the field "type", which must be there.
bool read_type(FieldReader& reader, std::span<const char* const> words, std::size_t& type);

}  // namespace embody::scene
