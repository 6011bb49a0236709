// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/document/document.h"
#include "scene/file/json/field_reader.h"

namespace embody::scene {

// The fields of a listed value (scene/document/field_list.h) to JSON and back. What follows has a pair for each type
// that a field may have; a field of another type does not compile.

void write_value(nlohmann::json& object, const char* name, bool value);
void write_value(nlohmann::json& object, const char* name, int value);
void write_value(nlohmann::json& object, const char* name, std::uint32_t value);
void write_value(nlohmann::json& object, const char* name, double value);
void write_value(nlohmann::json& object, const char* name, const std::string& value);
void write_value(nlohmann::json& object, const char* name, const Vec3& value);
void write_value(nlohmann::json& object, const char* name, const Transform& value);
void write_value(nlohmann::json& object, const char* name, const std::optional<std::array<double, 3>>& color);
void write_value(nlohmann::json& object, const char* name, const std::optional<Camera>& camera);
void write_value(nlohmann::json& object, const char* name, const std::vector<Pin>& pins);
void write_value(nlohmann::json& object, const char* name,
                 const std::map<std::string, attributes::AttributeValue>& attributes);
void write_value(nlohmann::json& object, const char* name, const physics::WorldSettings& settings);
/// A model's key or a shape, each under its own name.
void write_value(nlohmann::json& object, const char* name, const Geometry& geometry);

// Each leaves the value as it is where the field is missing.
void read_value(FieldReader& reader, const char* name, FieldRange range, bool& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, int& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, std::uint32_t& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, double& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, std::string& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, Vec3& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, Transform& value);
void read_value(FieldReader& reader, const char* name, FieldRange range, std::optional<std::array<double, 3>>& color);
void read_value(FieldReader& reader, const char* name, FieldRange range, std::optional<Camera>& camera);
void read_value(FieldReader& reader, const char* name, FieldRange range, std::vector<Pin>& pins);
void read_value(FieldReader& reader, const char* name, FieldRange range,
                std::map<std::string, attributes::AttributeValue>& attributes);
void read_value(FieldReader& reader, const char* name, FieldRange range, physics::WorldSettings& settings);
void read_value(FieldReader& reader, const char* name, FieldRange range, Geometry& geometry);

/// As a scene file has it: what is as it would be anyway is not written.
template <class Owner>
void write_fields(nlohmann::json& object, const Owner& owner) {
    static const Owner plain;
    for_each_field<Owner>([&](const auto& field) {
        constexpr Saved saved = std::remove_cvref_t<decltype(field)>::saved;
        if constexpr (saved == Saved::when_set)
            if (owner.*field.member == plain.*field.member) return;
        if constexpr (saved != Saved::never) write_value(object, field.name, owner.*field.member);
    });
}

/// As a message has it that tells of a change: also what was taken away, as null or empty.
template <class Owner>
void write_all_fields(nlohmann::json& object, const Owner& owner) {
    for_each_field<Owner>([&](const auto& field) {
        if constexpr (std::remove_cvref_t<decltype(field)>::saved != Saved::never)
            write_value(object, field.name, owner.*field.member);
    });
}

/// Lays the fields that are there over those of `owner`.
template <class Owner>
void read_fields(FieldReader& reader, Owner& owner) {
    for_each_field<Owner>([&](const auto& field) {
        if constexpr (std::remove_cvref_t<decltype(field)>::saved != Saved::never)
            read_value(reader, field.name, field.range, owner.*field.member);
    });
}

}  // namespace embody::scene
