// SPDX-License-Identifier: MIT
#include "attributes/json_text.h"

#include <algorithm>
#include <deque>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <vector>

namespace embody::attributes {

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

/// Where a walk over a JSON text is, such as "entities[3].pose".
class FieldPath {
public:
    void enter(bool is_list) { levels_.push_back({is_list, 0, {}}); }
    void leave() { levels_.pop_back(); }
    void name(std::string_view field) { levels_.back().field = field; }
    /// A value of a list or an object has ended.
    void next() {
        if (!levels_.empty()) ++levels_.back().at;
    }
    [[nodiscard]] bool is_in_object() const { return !levels_.empty() && !levels_.back().is_list; }
    [[nodiscard]] std::string text() const {
        std::string path;
        for (const Level& level : levels_) {
            if (level.is_list)
                path += "[" + std::to_string(level.at) + "]";
            else if (!level.field.empty())
                path += (path.empty() ? "" : ".") + level.field;
        }
        return path;
    }

private:
    struct Level {
        bool is_list = false;
        std::size_t at = 0;
        std::string field;
    };
    std::vector<Level> levels_;
};

/// Walks a text that cannot be parsed, to find the place and the reason.
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
        path_.name(name);
        return true;
    }
    bool parse_error(std::size_t position, const std::string& last, const nlohmann::detail::exception& fault) override {
        byte = position;
        token = last;
        is_too_large = dynamic_cast<const json::out_of_range*>(&fault) != nullptr;
        // Message without the parser's own error number and position.
        what = fault.what();
        if (const std::size_t at = what.find("syntax error "); at != std::string::npos) what = what.substr(at + 13);
        field = path_.text();
        return false;
    }

private:
    bool value() {
        path_.next();
        return true;
    }
    bool enter(bool is_list) {
        path_.enter(is_list);
        return true;
    }
    bool leave() {
        path_.leave();
        return value();
    }

    FieldPath path_;
};

/// Finds a field that an object names twice; the parser would silently keep one of them. The text is valid JSON.
class RepetitionFinder {
public:
    explicit RepetitionFinder(std::string_view text) : text_(text) {}

    struct Repetition {
        std::size_t byte = 0;
        std::string field;
    };
    std::optional<Repetition> find() {
        for (at_ = 0; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (c == '{' || c == '[') {
                path_.enter(c == '[');
                starts_.push_back(names_.size());
                is_name_next_ = c == '{';
            } else if (c == '}' || c == ']') {
                if (const auto found = close(c == '}')) return found;
            } else if (c == ',') {
                path_.next();
                is_name_next_ = path_.is_in_object();
            } else if (c == '"') {
                take_string();
            }
        }
        return std::nullopt;
    }

private:
    struct Name {
        std::string_view text;
        std::size_t byte;
    };

    void take_string() {
        const std::size_t begin = at_++;
        bool is_escaped = false;
        for (; text_[at_] != '"'; ++at_) {
            if (text_[at_] != '\\') continue;
            is_escaped = true;
            ++at_;
        }
        if (!is_name_next_) return;
        is_name_next_ = false;
        std::string_view name = text_.substr(begin + 1, at_ - begin - 1);
        // "\u0061" is "a".
        if (is_escaped) name = unescaped_.emplace_back(json::parse(text_.substr(begin, at_ + 1 - begin)));
        path_.name(name);
        names_.push_back({name, begin + 1});
    }

    std::optional<Repetition> close(bool is_object) {
        const auto first = names_.begin() + static_cast<std::ptrdiff_t>(starts_.back());
        starts_.pop_back();
        std::sort(first, names_.end(),
                  [](const Name& a, const Name& b) { return std::tie(a.text, a.byte) < std::tie(b.text, b.byte); });
        const auto twice =
            std::adjacent_find(first, names_.end(), [](const Name& a, const Name& b) { return a.text == b.text; });
        if (is_object && twice != names_.end()) {
            path_.name((twice + 1)->text);
            return Repetition{(twice + 1)->byte, path_.text()};
        }
        names_.erase(first, names_.end());
        path_.leave();
        is_name_next_ = false;
        return std::nullopt;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    bool is_name_next_ = false;
    FieldPath path_;
    std::vector<Name> names_;          ///< of the open objects, one after the other
    std::vector<std::size_t> starts_;  ///< in names_, of every open object and list
    std::deque<std::string> unescaped_;
};

Error fault_in(const std::string& text, const std::string& where) {
    FaultFinder finder;
    json::sax_parse(text, &finder);
    const std::string place =
        where + ", " + line_and_column(text, finder.byte) + (finder.field.empty() ? "" : ": " + finder.field);
    if (finder.is_too_large)
        return {place, finder.token + " is larger than a number can be", "write a number between -1.7e308 and 1.7e308"};
    return {place, "is not JSON: " + finder.what,
            "mend the text there, or save it again with the program that made it"};
}

}  // namespace

bool nests_too_deep(std::string_view text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
            continue;
        }
        if (c == '"') quoted = true;
        if (c == '[' || c == '{') ++depth;
        if (c == ']' || c == '}') --depth;
        if (depth > max_nesting_depth) return true;
    }
    return false;
}

Result<json> parse_json(const std::string& text, const std::string& where) {
    // The parser takes a NUL for the end of the text and ignores the rest.
    if (const std::size_t nul = text.find('\0'); nul != std::string::npos) {
        return Error{where + ", " + line_and_column(text, nul + 1), "is not JSON: has a byte 0",
                     "mend the text there, or save it again with the program that made it"};
    }
    if (nests_too_deep(text))
        return Error{where, "lists and objects nest more than " + std::to_string(max_nesting_depth) + " deep"};
    json parsed = json::parse(text, nullptr, false);
    if (parsed.is_discarded()) return fault_in(text, where);
    if (const auto repetition = RepetitionFinder(text).find()) {
        return Error{where + ", " + line_and_column(text, repetition->byte) + ": " + repetition->field,
                     "is written a second time in the same object", "keep one of the two"};
    }
    return parsed;
}

Result<json> read_json(const std::filesystem::path& file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return Error{file.string(), "is a folder", "name a file"};
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return Error{file.string(), "cannot be opened"};
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (stream.bad()) return Error{file.string(), "cannot be read"};
    return parse_json(text, file.string());
}

}  // namespace embody::attributes
