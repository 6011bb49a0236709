// SPDX-License-Identifier: MIT
// Format: G. Turk, The PLY Polygon File Format, 1994.
#include "interchange/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "interchange/one_line.h"

namespace embody::interchange {
namespace {

constexpr std::size_t max_elements = 100, max_properties = 1000;

std::optional<PlyType> type_named(std::string_view name) {
    using enum PlyType;
    // The names of 1994, and those that came later.
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{{{"char", int8},
                                                                          {"uchar", uint8},
                                                                          {"short", int16},
                                                                          {"ushort", uint16},
                                                                          {"int", int32},
                                                                          {"uint", uint32},
                                                                          {"float", float32},
                                                                          {"double", float64},
                                                                          {"int8", int8},
                                                                          {"uint8", uint8},
                                                                          {"int16", int16},
                                                                          {"uint16", uint16},
                                                                          {"int32", int32},
                                                                          {"uint32", uint32},
                                                                          {"float32", float32},
                                                                          {"float64", float64}}};
    const auto found = std::ranges::find(names, name, &std::pair<std::string_view, PlyType>::first);
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string_view::npos) return words;
        line.remove_prefix(begin);
        const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

/// Reads the header line by line.
class HeaderReader {
public:
    explicit HeaderReader(std::string_view file) : file_(file) {}

    Result<PlyHeader> read() {
        if (next_line() != "ply") return fail("is not \"ply\", as the first line of a PLY file is");
        bool has_format = false;
        while (true) {
            if (at_ >= file_.size()) return fail("is the last one: end_header is missing");
            const std::string_view line = next_line();
            const auto words = words_of(line);
            if (words.empty() || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "comment") {
                take_comment(line, words);
                continue;
            }
            const bool is_format = words[0] == "format";
            if (const auto taken = is_format ? take_format(words) : take_declaration(words); !taken)
                return taken.error();
            has_format = has_format || is_format;
        }
        if (!has_format) return fail("ends a header without a format");
        header_.size = at_;
        header_.lines = line_;
        if (const auto held = check_counts(); !held) return held.error();
        return std::move(header_);
    }

private:
    /// Without its end, which may be that of Unix, Windows or old Macintosh.
    std::string_view next_line() {
        const std::size_t end = std::min(file_.find_first_of("\r\n", at_), file_.size());
        std::string_view line = file_.substr(at_, end - at_);
        at_ = std::min(end + 1, file_.size());
        if (end < file_.size() && file_[end] == '\r' && at_ < file_.size() && file_[at_] == '\n') ++at_;
        ++line_;
        const std::size_t last = line.find_last_not_of(" \t");
        return last == std::string_view::npos ? std::string_view() : line.substr(0, last + 1);
    }

    [[nodiscard]] Error fail(std::string why) const { return {"line " + std::to_string(line_), std::move(why)}; }

    void take_comment(std::string_view line, const std::vector<std::string_view>& words) {
        if (words.size() < 3 || words[1] != "TextureFile" || !header_.texture.empty()) return;
        header_.texture = std::string(line.substr(static_cast<std::size_t>(words[2].data() - line.data())));
    }

    Result<void> take_format(const std::vector<std::string_view>& words) {
        const std::string_view name = words.size() < 2 ? std::string_view() : words[1];
        if (name == "ascii") {
            header_.encoding = PlyEncoding::ascii;
        } else if (name == "binary_little_endian") {
            header_.encoding = PlyEncoding::little_endian;
        } else if (name == "binary_big_endian") {
            header_.encoding = PlyEncoding::big_endian;
        } else {
            return fail("names no format of PLY: " + one_line(name));
        }
        return {};
    }

    /// "element NAME COUNT", "property TYPE NAME" or "property list COUNT_TYPE TYPE NAME".
    Result<void> take_declaration(const std::vector<std::string_view>& words) {
        if (words[0] == "element" && words.size() == 3) {
            PlyElement element{std::string(words[1]), 0, {}};
            const char* end = words[2].data() + words[2].size();
            if (const auto read = std::from_chars(words[2].data(), end, element.count);
                read.ec != std::errc() || read.ptr != end) {
                return fail("has no count of elements: " + one_line(words[2]));
            }
            if (header_.elements.size() >= max_elements) return fail("declares too many elements");
            header_.elements.push_back(std::move(element));
            return {};
        }
        const bool is_list = words.size() == 5 && words[1] == "list";
        // Other words are comments without "comment", as Blender wrote them once.
        if (words[0] != "property" && words[0] != "element") return {};
        if (words[0] != "property" || (words.size() != 3 && !is_list)) return fail("is not understood");
        if (header_.elements.empty()) return fail("declares a property before any element");
        PlyProperty property{std::string(words.back()), PlyType::float32, {}};
        for (std::size_t word = is_list ? 2 : 1; word + 1 < words.size(); ++word) {
            const auto type = type_named(words[word]);
            if (!type) return fail("names no type of PLY: " + one_line(words[word]));
            if (is_list && word == 2) property.count_type = type;
            property.type = *type;
        }
        if (property.count_type >= PlyType::float32) return fail("counts a list in fractions");
        auto& properties = header_.elements.back().properties;
        if (properties.size() >= max_properties) return fail("declares too many properties");
        properties.push_back(std::move(property));
        return {};
    }

    /// A number takes two characters in a text at least; so a few bytes cannot promise billions.
    Result<void> check_counts() const {
        std::uint64_t left = file_.size() + 1 - at_;
        for (const PlyElement& element : header_.elements) {
            std::uint64_t min_bytes = 0;
            for (const PlyProperty& property : element.properties) {
                const bool is_text = header_.encoding == PlyEncoding::ascii;
                min_bytes += is_text ? 2 : size_of(property.count_type.value_or(property.type));
            }
            if (min_bytes > 0 && element.count > left / min_bytes) {
                return Error{
                    "element " + one_line(element.name),
                    "is said to be there " + std::to_string(element.count) + " times, more than the file holds",
                    "is the file complete?"};
            }
            left -= min_bytes * element.count;
        }
        return {};
    }

    std::string_view file_;
    std::size_t at_ = 0, line_ = 0;
    PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyElement::find(std::initializer_list<std::string_view> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
        if (std::ranges::find(names, std::string_view(properties[i].name)) != names.end()) return i;
    }
    return std::nullopt;
}

Result<PlyHeader> read_ply_header(std::string_view file) { return HeaderReader(file).read(); }

}  // namespace embody::interchange
