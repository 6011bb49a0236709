// SPDX-License-Identifier: MIT
#include "scene/file/json/print.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

namespace embody::scene {

using nlohmann::json;

namespace {

// Fields that name a thing come first, the others in alphabetical order.
constexpr std::array<std::string_view, 10> first_fields = {
    "embody_scene", "title", "description", "index", "id", "type", "name", "model", "settings", "next_index"};

std::size_t rank(std::string_view field) {
    return static_cast<std::size_t>(std::find(first_fields.begin(), first_fields.end(), field) - first_fields.begin());
}

std::string plain_text(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

// Printed on one line if it has only numbers and words, or lists of numbers within a short line.
bool is_flat(const json& value) {
    if (!value.is_structured()) return true;
    return std::all_of(value.begin(), value.end(), [](const json& inner) { return !inner.is_structured(); });
}

void print(const json& value, std::size_t depth, std::string& out);

// Long lists of numbers are wrapped by count, so that a heightfield is not a single line of a megabyte.
void print_list(const json& list, std::size_t depth, std::string& out) {
    const bool one_line = is_flat(list) && list.size() <= 16;
    const std::size_t a_line = is_flat(list) ? 16 : list.size() > 64 && is_flat(list.front()) ? 4 : 1;
    out += '[';
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!one_line && i % a_line == 0) {
            out += '\n';
            out.append(depth + 1, ' ');
        } else if (i > 0) {
            out += ' ';
        }
        print(list[i], depth + 1, out);
        if (i + 1 < list.size()) out += ',';
    }
    if (!one_line && !list.empty()) {
        out += '\n';
        out.append(depth, ' ');
    }
    out += ']';
}

void print_object(const json& object, std::size_t depth, std::string& out) {
    std::vector<const std::string*> names;
    for (const auto& [name, value] : object.items()) names.push_back(&object.find(name).key());
    std::stable_sort(names.begin(), names.end(),
                     [](const std::string* a, const std::string* b) { return rank(*a) < rank(*b); });
    const bool one_line = is_flat(object) && object.size() <= 4;
    out += '{';
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (one_line) {
            if (i > 0) out += ' ';
        } else {
            out += '\n';
            out.append(depth + 1, ' ');
        }
        out += plain_text(json(*names[i])) + ": ";
        print(object[*names[i]], depth + 1, out);
        if (i + 1 < names.size()) out += ',';
    }
    if (!one_line && !names.empty()) {
        out += '\n';
        out.append(depth, ' ');
    }
    out += '}';
}

void print(const json& value, std::size_t depth, std::string& out) {
    if (value.is_array()) {
        print_list(value, depth, out);
    } else if (value.is_object()) {
        print_object(value, depth, out);
    } else {
        out += plain_text(value);
    }
}

}  // namespace

std::string print_json(const json& value) {
    std::string out;
    print(value, 0, out);
    out += '\n';
    return out;
}

}  // namespace embody::scene
