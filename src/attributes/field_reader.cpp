// SPDX-License-Identifier: MIT
#include "attributes/field_reader.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "attributes/json_text.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

bool is_in(double value, std::pair<double, double> range) {
    return std::isfinite(value) && value >= range.first && value <= range.second;
}

std::string range_text(std::pair<double, double> range) {
    return json(range.first).dump() + " to " + json(range.second).dump();
}

}  // namespace

Result<json> read_json(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return Error{file.string(), "is a folder", "name a file"};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{file.string(), "cannot be opened"};
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (stream.bad()) return Error{file.string(), "cannot be read"};
    return parse_json(text, file.string());
}

FieldReader::FieldReader(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) fail("", "must be an object");
}

void FieldReader::word(const char* field, std::string& value, bool required) {
    const json* found = find(field, required);
    if (found == nullptr) return;
    if (!found->is_string() || found->get_ref<const std::string&>().empty()) {
        return fail(field, "must be a non-empty string");
    }
    value = found->get<std::string>();
}

void FieldReader::words(const char* field, std::vector<std::string>& value, bool required) {
    const json* found = find(field, required);
    if (found == nullptr) return;
    value.clear();
    if (!found->is_array()) return fail(field, "must be a list of strings");
    for (const json& item : *found) {
        if (!item.is_string()) return fail(field, "must be a list of strings");
        value.push_back(item.get<std::string>());
    }
}

void FieldReader::truth(const char* field, bool& value, bool required) {
    const json* found = find(field, required);
    if (found == nullptr) return;
    if (!found->is_boolean()) return fail(field, "must be true or false");
    value = found->get<bool>();
}

void FieldReader::number(const char* field, double& value, std::pair<double, double> range, bool required) {
    const json* found = find(field, required);
    if (found == nullptr) return;
    if (!found->is_number() || !is_in(found->get<double>(), range)) {
        return fail(field, "must be a number from " + range_text(range));
    }
    value = found->get<double>();
}

void FieldReader::interval(const char* field, Interval& value, std::pair<double, double> range, bool required) {
    const auto n = numbers(field, 3, range, required);
    if (!n) return;
    if ((*n)[0] > (*n)[1] || (*n)[1] > (*n)[2]) return fail(field, "must be [low, typical, high], ascending");
    value = {(*n)[0], (*n)[1], (*n)[2]};
}

void FieldReader::size(const char* field, Vec3& value, bool required) {
    if (const auto n = numbers(field, 3, {1e-5, 1e4}, required)) value = {(*n)[0], (*n)[1], (*n)[2]};
}

void FieldReader::range(const char* field, double& low, double& high, bool required) {
    const auto n = numbers(field, 2, {1e-5, 1e4}, required);
    if (!n) return;
    low = (*n)[0];
    high = (*n)[1];
    if (low > high) fail(field, "must be [low, high], ascending");
}

const json* FieldReader::list(const char* field, bool required) {
    const json* found = find(field, required);
    if (found != nullptr && !found->is_array()) fail(field, "must be a list");
    return error_ ? nullptr : found;
}

const json* FieldReader::object(const char* field, bool required) {
    const json* found = find(field, required);
    if (found != nullptr && !found->is_object()) fail(field, "must be an object");
    return error_ ? nullptr : found;
}

void FieldReader::fail(const std::string& field, const std::string& why) {
    if (!error_) error_ = Error{field.empty() ? where_ : where_ + "." + field, why};
}

std::optional<Error> FieldReader::finish() {
    if (error_) return error_;
    for (const auto& [field, value] : object_.items()) {
        if (!known_.contains(field)) return Error{where_ + "." + field, "there is no field of this name"};
    }
    return std::nullopt;
}

const json* FieldReader::find(const char* field, bool required) {
    known_.insert(field);
    if (error_ || !object_.is_object()) return nullptr;
    const auto found = object_.find(field);
    if (found != object_.end()) return &*found;
    if (required) fail(field, "is missing");
    return nullptr;
}

std::optional<std::vector<double>> FieldReader::numbers(const char* field, std::size_t count,
                                                        std::pair<double, double> range, bool required) {
    const json* found = find(field, required);
    if (found == nullptr) return std::nullopt;
    std::vector<double> values;
    if (found->is_array() && found->size() == count) {
        for (const json& item : *found) {
            if (item.is_number() && is_in(item.get<double>(), range)) values.push_back(item.get<double>());
        }
    }
    if (values.size() == count) return values;
    fail(field, "must be " + std::to_string(count) + " numbers from " + range_text(range));
    return std::nullopt;
}

}  // namespace embody::attributes
