// SPDX-License-Identifier: MIT
#include "attributes/field_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "attributes/nearest_word.h"

namespace embody::attributes {

using nlohmann::json;

namespace {

std::string number_text(double value) { return json(value).dump(); }

std::string range_text(NumberRange range) {
    const std::string unit = *range.unit ? std::string(" ") + range.unit : std::string();
    if (range.low == positive.low && std::isinf(range.high)) return "greater than 0" + unit;
    if (std::isinf(range.high)) return number_text(range.low) + unit + " or more";
    if (std::isinf(range.low)) return number_text(range.high) + unit + " or less";
    return "from " + number_text(range.low) + " to " + number_text(range.high) + unit;
}

void keep_first(std::optional<Error>& error, std::string where, std::string why, std::string remedy = {}) {
    if (!error) error = Error{std::move(where), std::move(why), std::move(remedy)};
}

}  // namespace

const char* json_kind(const json& value) {
    switch (value.type()) {
        case json::value_t::object:
            return "an object";
        case json::value_t::array:
            return "a list";
        case json::value_t::string:
            return "text";
        case json::value_t::boolean:
            return "true or false";
        case json::value_t::number_integer:
        case json::value_t::number_unsigned:
        case json::value_t::number_float:
            return "a number";
        default:
            return "nothing (null)";
    }
}

std::string element_path(const std::string& list, std::size_t i) { return list + "[" + std::to_string(i) + "]"; }

bool read_number(const json& value, const std::string& where, double& number, std::optional<Error>& error,
                 NumberRange range) {
    if (error) return false;
    if (!value.is_number()) {
        keep_first(error, where, std::string("must be a number, got ") + json_kind(value));
        return false;
    }
    const double read = value.get<double>();
    if (!std::isfinite(read)) {
        keep_first(error, where, "must be a finite number");
        return false;
    }
    if (read < range.low || read > range.high) {
        keep_first(error, where, "must be " + range_text(range) + ", got " + number_text(read));
        return false;
    }
    number = read;
    return true;
}

bool read_array(const json& value, const std::string& where, std::optional<Error>& error) {
    if (error) return false;
    if (value.is_array()) return true;
    keep_first(error, where, std::string("must be a list, got ") + json_kind(value));
    return false;
}

bool read_vector(const json& value, const std::string& where, Vec3& vector, std::optional<Error>& error) {
    if (error) return false;
    if (!value.is_array() || value.size() != 3) {
        keep_first(error, where, "must be three numbers [x, y, z]");
        return false;
    }
    Vec3 read;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (!read_number(value[at], element_path(where, at), read[i], error)) return false;
    }
    vector = read;
    return true;
}

FieldReader::FieldReader(const json& value, std::string where, std::optional<Error>& error)
    : json_(value), where_(std::move(where)), error_(error), is_object_(value.is_object()) {
    if (!is_object_) fail(where_, std::string("must be an object {…}, got ") + json_kind(value));
}

FieldReader::FieldReader(const json& value, std::string where) : FieldReader(value, std::move(where), own_error_) {}

void FieldReader::fail(const std::string& where, std::string why, std::string remedy) {
    keep_first(error_, where, std::move(why), std::move(remedy));
}

void FieldReader::refuse(std::string_view field, std::string why, std::string remedy) {
    fail(path(field), std::move(why), std::move(remedy));
}

std::string FieldReader::path(std::string_view field) const {
    if (where_.empty() || field.empty()) return where_ + std::string(field);
    return where_ + "." + std::string(field);
}

const json* FieldReader::take(const char* name) {
    known_.emplace_back(name);
    if (!is_object_ || error_) return nullptr;
    const auto found = json_.find(name);
    return found == json_.end() ? nullptr : &*found;
}

const json* FieldReader::need(const char* name, const char* what) {
    const json* value = take(name);
    if (!value && is_object_) fail(path(name), std::string("is missing: ") + what);
    return value;
}

void FieldReader::require(std::initializer_list<const char*> names) {
    if (!is_object_) return;
    for (const char* name : names)
        if (!json_.contains(name)) refuse(name, "is missing");
}

bool FieldReader::number(const char* name, double& value, NumberRange range) {
    const json* field = take(name);
    return field && read_number(*field, path(name), value, error_, range);
}

bool FieldReader::number(const char* name, std::optional<double>& value, NumberRange range) {
    double read = 0;
    if (!number(name, read, range)) return false;
    value = read;
    return true;
}

bool FieldReader::whole(const char* name, std::uint32_t& value, std::uint32_t low, std::uint32_t high) {
    const json* field = take(name);
    if (!field) return false;
    double read = 0;
    if (!read_number(*field, path(name), read, error_, {static_cast<double>(low), static_cast<double>(high)}))
        return false;
    if (read != std::floor(read)) {
        fail(path(name), "must be a whole number, got " + number_text(read));
        return false;
    }
    value = static_cast<std::uint32_t>(read);
    return true;
}

bool FieldReader::whole(const char* name, int& value, int low, int high) {
    std::uint32_t read = 0;
    if (!whole(name, read, static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high))) return false;
    value = static_cast<int>(read);
    return true;
}

bool FieldReader::truth(const char* name, bool& value) {
    const json* field = take(name);
    if (!field) return false;
    if (!field->is_boolean()) {
        fail(path(name), std::string("must be true or false, got ") + json_kind(*field));
        return false;
    }
    value = field->get<bool>();
    return true;
}

bool FieldReader::text(const char* name, std::string& value) {
    const json* field = take(name);
    if (!field) return false;
    if (!field->is_string()) {
        fail(path(name), std::string("must be text, got ") + json_kind(*field));
        return false;
    }
    value = field->get_ref<const std::string&>();
    return true;
}

bool FieldReader::word(const char* name, std::string& value) {
    std::string read;
    if (!text(name, read)) return false;
    if (read.empty()) refuse(name, "must not be empty");
    if (error_) return false;
    value = std::move(read);
    return true;
}

bool FieldReader::words(const char* name, std::vector<std::string>& value) {
    const json* given = list(name);
    if (!given) return false;
    std::vector<std::string> read;
    for (std::size_t i = 0; i < given->size(); ++i) {
        const json& item = (*given)[i];
        if (!item.is_string()) {
            fail(element_path(path(name), i), std::string("must be text, got ") + json_kind(item));
            return false;
        }
        read.push_back(item.get<std::string>());
    }
    value = std::move(read);
    return true;
}

bool FieldReader::numbers(const char* name, std::span<double> values, NumberRange range) {
    const json* given = list(name);
    if (!given) return false;
    if (given->size() != values.size()) {
        refuse(name, "must be " + std::to_string(values.size()) + " numbers");
        return false;
    }
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!read_number((*given)[i], element_path(path(name), i), values[i], error_, range)) return false;
    return true;
}

const json* FieldReader::list(const char* name) {
    const json* field = take(name);
    return field && read_array(*field, path(name), error_) ? field : nullptr;
}

const json* FieldReader::object(const char* name) {
    const json* field = take(name);
    if (field && !field->is_object()) refuse(name, std::string("must be an object {…}, got ") + json_kind(*field));
    return error_ ? nullptr : field;
}

bool FieldReader::vector(const char* name, Vec3& value) {
    const json* field = take(name);
    return field && read_vector(*field, path(name), value, error_);
}

bool FieldReader::vector(const char* name, std::optional<Vec3>& value) {
    Vec3 read;
    if (!vector(name, read)) return false;
    value = read;
    return true;
}

bool FieldReader::rotation(const char* name, Quat& value) {
    const json* field = take(name);
    if (!field) return false;
    const std::string where = path(name);

    // The form for people: an axis and an angle.
    if (field->is_object()) {
        Vec3 axis;
        double degrees = 0;
        FieldReader reader(*field, where, error_);
        if (const json* given = reader.need("axis", "the axis of the rotation, [x, y, z]"))
            read_vector(*given, reader.path("axis"), axis, error_);
        if (const json* given = reader.need("degrees", "the angle of the rotation"))
            read_number(*given, reader.path("degrees"), degrees, error_);
        if (!reader.finish()) return false;
        // Only the direction of the axis and the angle modulo two turns count. Both are reduced first, since squares
        // and products could overflow.
        const double largest = std::max({std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)});
        if (largest == 0) {
            fail(reader.path("axis"), "must not be zero");
            return false;
        }
        value = from_axis_angle(normalized(axis / largest), std::fmod(degrees, 720) * std::numbers::pi / 180);
        return true;
    }

    // The quaternion itself; every bit is kept.
    if (!field->is_array() || field->size() != 4) {
        fail(where, "must be four numbers [x, y, z, w] or {\"axis\": [x, y, z], \"degrees\": angle}");
        return false;
    }
    Quat read;
    double* components[4] = {&read.x, &read.y, &read.z, &read.w};
    for (std::size_t i = 0; i < 4; ++i)
        if (!read_number((*field)[i], element_path(where, i), *components[i], error_, {-1e6, 1e6})) return false;
    if (dot(read, read) < 1e-12) {
        fail(where, "must not be zero: no rotation is [0, 0, 0, 1]");
        return false;
    }
    // A quaternion that is not of unit length was written by hand.
    value = std::fabs(dot(read, read) - 1) < 1e-9 ? read : normalized(read);
    return true;
}

bool FieldReader::transform(const char* name, Transform& value) {
    const json* field = take(name);
    if (!field) return false;
    Transform read;
    FieldReader reader(*field, path(name), error_);
    reader.vector("position", read.position);
    reader.rotation("rotation", read.rotation);
    if (!reader.finish()) return false;
    value = read;
    return true;
}

bool FieldReader::choice(const char* name, std::size_t& value, std::span<const char* const> words) {
    std::string word;
    if (!text(name, word)) return false;
    std::string list;
    std::vector<std::string> known;
    for (const char* candidate : words) {
        if (word == candidate) {
            value = known.size();
            return true;
        }
        known.emplace_back(candidate);
        list += (list.empty() ? "" : ", ") + known.back();
    }
    const std::string nearest = nearest_word(word, known);
    fail(path(name), "\"" + word + "\" is not one of: " + list,
         nearest.empty() ? "" : "did you mean \"" + nearest + "\"?");
    return false;
}

bool FieldReader::finish() {
    if (error_ || !is_object_) return false;
    for (const auto& [name, value] : json_.items()) {
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        const std::string nearest = nearest_word(name, known_);
        std::string all;
        for (auto known = known_.begin(); known != known_.end(); ++known)
            if (std::find(known_.begin(), known, *known) == known) all += (all.empty() ? "" : ", ") + *known;
        fail(path(name), "is not a field here",
             nearest.empty() ? "fields here: " + all : "did you mean \"" + nearest + "\"?");
        return false;
    }
    return true;
}

}  // namespace embody::attributes
