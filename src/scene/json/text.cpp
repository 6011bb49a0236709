// SPDX-License-Identifier: MIT
#include "scene/json/text.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "scene/json/field_reader.h"
#include "scene/json/nesting.h"

namespace embody::scene {

using nlohmann::json;

namespace {

std::string line_and_column(const std::string& text, std::size_t byte) {
    const std::size_t end = std::min(byte, text.size());
    const auto begin = text.begin();
    const auto stop = begin + static_cast<std::ptrdiff_t>(end);
    const auto line = std::count(begin, stop, '\n') + 1;
    const std::size_t newline = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
    const std::size_t column = newline == std::string::npos ? end : end - newline - 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

/// Walks a text that cannot be read, to tell where and why.
class FaultFinder final : public nlohmann::json_sax<json> {
public:
    std::size_t byte = 0;
    std::string field, token, what;
    bool is_too_large = false;

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(std::int64_t) override { return value(); }
    bool number_unsigned(std::uint64_t) override { return value(); }
    bool number_float(double, const std::string&) override { return value(); }
    bool string(std::string&) override { return value(); }
    bool binary(json::binary_t&) override { return value(); }
    bool start_object(std::size_t) override { return enter(false); }
    bool start_array(std::size_t) override { return enter(true); }
    bool end_object() override { return leave(); }
    bool end_array() override { return leave(); }
    bool key(std::string& name) override {
        levels_.back().name = name;
        return true;
    }
    bool parse_error(std::size_t position, const std::string& last, const nlohmann::detail::exception& fault) override {
        byte = position;
        token = last;
        is_too_large = dynamic_cast<const json::out_of_range*>(&fault) != nullptr;
        // After the parser's own number and place of the error.
        what = fault.what();
        if (const std::size_t at = what.find("syntax error "); at != std::string::npos) what = what.substr(at + 13);
        for (const Level& level : levels_) {
            if (level.is_list)
                field = element_path(field, level.at);
            else if (!level.name.empty())
                field += (field.empty() ? "" : ".") + level.name;
        }
        return false;
    }

private:
    struct Level {
        bool is_list = false;
        std::size_t at = 0;
        std::string name;
    };
    bool value() {
        if (!levels_.empty()) ++levels_.back().at;
        return true;
    }
    bool enter(bool is_list) {
        levels_.push_back({is_list, 0, {}});
        return true;
    }
    bool leave() {
        levels_.pop_back();
        return value();
    }

    std::vector<Level> levels_;
};

Error fault_in(const std::string& text, const std::string& where) {
    FaultFinder finder;
    json::sax_parse(text, &finder);
    const std::string place =
        where + ", " + line_and_column(text, finder.byte) + (finder.field.empty() ? "" : ": " + finder.field);
    if (finder.is_too_large)
        return {place, finder.token + " is larger than a number can be", "write a number between -1.7e308 and 1.7e308"};
    return {place, "is not JSON: " + finder.what, "mend the text there, or save the scene again"};
}

}  // namespace

Result<json> parse_json(const std::string& text, const std::string& where) {
    if (nests_too_deep(text)) return Error{where, "lists and objects nest more than 64 deep: this is no scene"};
    json parsed = json::parse(text, nullptr, false);
    if (parsed.is_discarded()) return fault_in(text, where);
    return parsed;
}

}  // namespace embody::scene
