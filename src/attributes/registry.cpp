// SPDX-License-Identifier: MIT
#include "attributes/registry.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "attributes/nearest_word.h"
#include "attributes/registry_table.h"

namespace embody::attributes {
namespace {

constexpr const char* type_words[] = {"a number", "a word", "true or false", "three numbers", "a symmetric 3x3 tensor"};

// The shortest text that reads back as the same number.
std::string number_text(double value) {
    if (std::isinf(value)) return value > 0 ? "infinity" : "-infinity";
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    return {buffer, end.ptr};
}

Error unknown_name(std::string_view name) {
    const AttributeDescription* nearest = nullptr;
    std::size_t min_distance = 0;
    for (const AttributeDescription& description : registry()) {
        const std::size_t distance = edit_distance(name.substr(0, 64), description.name);
        if (nearest == nullptr || distance < min_distance) {
            nearest = &description;
            min_distance = distance;
        }
    }
    // A name that is similar to none gets no guess.
    const bool close = min_distance <= std::max<std::size_t>(2, nearest->name.size() / 2);
    return {std::string(name.substr(0, 64)), "there is no attribute of this name",
            close ? "did you mean \"" + nearest->name + "\"?" : ""};
}

std::string range_text(const AttributeDescription& description) {
    const std::string unit = description.unit == "1" || description.unit.empty() ? "" : " " + description.unit;
    if (description.low && description.high) {
        return (description.whole ? "must be a whole number from " : "must be ") + number_text(*description.low) +
               " to " + number_text(*description.high) + unit;
    }
    if (description.low) return "must be at least " + number_text(*description.low) + unit;
    return "must be a number";
}

// NaN is never in range; infinity only where the attribute has no upper bound.
bool in_range(const AttributeDescription& description, double value) {
    if (std::isnan(value)) return false;
    if (std::isinf(value) && (value < 0 || description.high)) return false;
    return (!description.low || value >= *description.low) && (!description.high || value <= *description.high);
}

Result<void> validate_number(const AttributeDescription& description, double value) {
    if (in_range(description, value) && !(description.whole && value != std::floor(value))) return {};
    return Error{description.name, range_text(description) + ", got " + number_text(value)};
}

Result<void> validate_word(const AttributeDescription& description, const std::string& value) {
    if (description.choices.empty() || std::ranges::find(description.choices, value) != description.choices.end())
        return {};
    std::string choices;
    for (const std::string& choice : description.choices) choices += (choices.empty() ? "" : ", ") + choice;
    return Error{description.name, "must be one of " + choices + ", got \"" + value + "\""};
}

// Every moment of a real body is positive and at most the sum of the other two.
Result<void> validate_tensor(const AttributeDescription& description, const Mat3& value) {
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            if (auto valid = validate_number(description, value(row, column)); !valid) return valid;
        }
    }
    const double size = std::fabs(trace(value));
    const Mat3 skewed = value - transpose(value);
    if (length(skewed.x) + length(skewed.y) + length(skewed.z) > 1e-9 * size) {
        return Error{description.name, "must be symmetric"};
    }
    const Vec3 moments = eigen_symmetric(value).values;
    if (!(moments.x > 0)) return Error{description.name, "must have three positive principal moments"};
    if (moments.z > (moments.x + moments.y) * (1 + 1e-9)) {
        return Error{description.name, "no principal moment may exceed the sum of the other two"};
    }
    return {};
}

Result<void> validate_vector(const AttributeDescription& description, Vec3 value) {
    for (int axis = 0; axis < 3; ++axis) {
        if (auto valid = validate_number(description, value[axis]); !valid) return valid;
    }
    return {};
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::optional<double> read_number(std::string_view text) {
    text = trimmed(text);
    if (text == "infinity" || text == "inf") return HUGE_VAL;
    if (text == "-infinity" || text == "-inf") return -HUGE_VAL;
    double value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<std::vector<double>> read_numbers(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const auto comma = text.find(',');
        const auto number = read_number(text.substr(0, comma));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

// Vectors are "x,y,z", tensors "xx,yy,zz,xy,xz,yz" or, diagonal, "xx,yy,zz".
std::optional<AttributeValue> read_components(ValueType type, std::string_view text) {
    const auto n = read_numbers(text);
    if (!n) return std::nullopt;
    if (type == ValueType::vector) {
        if (n->size() != 3) return std::nullopt;
        return Vec3{(*n)[0], (*n)[1], (*n)[2]};
    }
    if (n->size() == 3) return Mat3::diagonal({(*n)[0], (*n)[1], (*n)[2]});
    if (n->size() != 6) return std::nullopt;
    return Mat3{{(*n)[0], (*n)[3], (*n)[4]}, {(*n)[3], (*n)[1], (*n)[5]}, {(*n)[4], (*n)[5], (*n)[2]}};
}

std::optional<AttributeValue> read_value(ValueType type, std::string_view text) {
    if (type == ValueType::word) return std::string(text);
    if (type == ValueType::truth) {
        if (text == "true" || text == "yes" || text == "1") return true;
        if (text == "false" || text == "no" || text == "0") return false;
        return std::nullopt;
    }
    if (type == ValueType::number) {
        const auto number = read_number(text);
        return number ? std::optional<AttributeValue>(*number) : std::nullopt;
    }
    return read_components(type, text);
}

}  // namespace

const std::vector<AttributeDescription>& registry() {
    static const std::vector<AttributeDescription> rows = make_registry_table();
    return rows;
}

bool applies_to(const AttributeDescription& attribute, PhysicalKind kind) {
    const std::string_view letters = traits_of(kind).letters;
    if (letters.empty()) return attribute.kind == "identity";
    return attribute.applies_to.find_first_of(letters) != std::string::npos;
}

const AttributeDescription* describe(std::string_view name) {
    static const auto index = [] {
        std::map<std::string, const AttributeDescription*, std::less<>> by_name;
        for (const AttributeDescription& row : registry()) by_name.emplace(row.name, &row);
        return by_name;
    }();
    const auto found = index.find(name);
    return found != index.end() ? found->second : nullptr;
}

Result<void> validate(std::string_view name, const AttributeValue& value) {
    const AttributeDescription* description = describe(name);
    if (description == nullptr) return unknown_name(name);
    if (value.index() != static_cast<std::size_t>(description->type)) {
        return Error{description->name, std::string("must be ") + type_words[static_cast<int>(description->type)] +
                                            ", got \"" + to_text(value) + "\""};
    }
    switch (description->type) {
        case ValueType::number:
            return validate_number(*description, std::get<double>(value));
        case ValueType::word:
            return validate_word(*description, std::get<std::string>(value));
        case ValueType::truth:
            return {};
        case ValueType::vector:
            return validate_vector(*description, std::get<Vec3>(value));
        case ValueType::tensor:
            return validate_tensor(*description, std::get<Mat3>(value));
    }
    return {};
}

Result<AttributeValue> parse_value(std::string_view name, std::string_view text) {
    const AttributeDescription* description = describe(name);
    if (description == nullptr) return unknown_name(name);
    const auto value = read_value(description->type, trimmed(text));
    if (!value) {
        return Error{description->name, std::string("must be ") + type_words[static_cast<int>(description->type)] +
                                            ", got \"" + std::string(text.substr(0, 64)) + "\""};
    }
    if (auto valid = validate(name, *value); !valid) return valid.error();
    return *value;
}

std::string to_text(const AttributeValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
    if (const auto* v = std::get_if<Vec3>(&value)) {
        return number_text(v->x) + "," + number_text(v->y) + "," + number_text(v->z);
    }
    const Mat3& m = std::get<Mat3>(value);
    return number_text(m(0, 0)) + "," + number_text(m(1, 1)) + "," + number_text(m(2, 2)) + "," + number_text(m(0, 1)) +
           "," + number_text(m(0, 2)) + "," + number_text(m(1, 2));
}

}  // namespace embody::attributes
