// SPDX-License-Identifier: MIT
// Format: Oracle, Java SE API, java.util.Properties.load(Reader).
#include "interchange/sweethome/properties_file.h"

#include <cstdint>

#include "interchange/utf8.h"

namespace embody::interchange {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\f'; }

/// Takes the next logical line from `text`: continuations joined, leading blanks dropped.
std::string take_line(std::string_view& text) {
    std::string line;
    while (true) {
        while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view piece = text.substr(0, end);
        text.remove_prefix(end);
        if (text.starts_with("\r\n")) text.remove_prefix(1);
        if (!text.empty()) text.remove_prefix(1);

        // An odd number of backslashes at the end continues the line; a comment never is continued.
        std::size_t slashes = 0;
        while (slashes < piece.size() && piece[piece.size() - 1 - slashes] == '\\') ++slashes;
        const bool comment = line.empty() && (piece.starts_with('#') || piece.starts_with('!'));
        const bool goes_on = slashes % 2 == 1 && !comment;
        line += goes_on ? piece.substr(0, piece.size() - 1) : piece;
        if (!goes_on || text.empty()) return line;
    }
}

/// The four hexadecimal digits at `text[at]`, or -1.
std::int32_t four_hex_digits(std::string_view text, std::size_t at) {
    if (at + 4 > text.size()) return -1;
    std::int32_t value = 0;
    for (const char c : text.substr(at, 4)) {
        const int digit = c >= '0' && c <= '9'   ? c - '0'
                          : c >= 'a' && c <= 'f' ? c - 'a' + 10
                          : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                 : -1;
        if (digit < 0) return -1;
        value = value * 16 + digit;
    }
    return value;
}

/// Escapes resolved, ISO 8859-1 made UTF-8.
std::string unescape(std::string_view text) {
    std::string out;
    std::uint32_t high_surrogate = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::uint32_t code = static_cast<unsigned char>(text[i]);
        if (text[i] == '\\' && i + 1 < text.size()) {
            const char c = text[++i];
            const std::int32_t unicode = c == 'u' ? four_hex_digits(text, i + 1) : -1;
            if (unicode >= 0) i += 4;
            code = unicode >= 0 ? static_cast<std::uint32_t>(unicode)
                   : c == 't'   ? '\t'
                   : c == 'n'   ? '\n'
                   : c == 'r'   ? '\r'
                   : c == 'f'   ? '\f'
                                : static_cast<unsigned char>(c);
        }
        // Java writes what is beyond 16 bits as a pair of surrogates; a lonely one is dropped.
        if (code >= 0xD800 && code < 0xDC00) {
            high_surrogate = code;
            continue;
        }
        if (code >= 0xDC00 && code < 0xE000) {
            if (high_surrogate != 0) append_utf8(out, 0x10000 + ((high_surrogate - 0xD800) << 10) + (code - 0xDC00));
        } else {
            append_utf8(out, code);
        }
        high_surrogate = 0;
    }
    return out;
}

}  // namespace

std::map<std::string, std::string, std::less<>> parse_properties(std::string_view text) {
    std::map<std::string, std::string, std::less<>> properties;
    while (!text.empty()) {
        const std::string line = take_line(text);
        if (line.empty() || line.front() == '#' || line.front() == '!') continue;

        // The key ends at the first '=', ':' or blank that is not escaped.
        std::size_t key_end = 0;
        while (key_end < line.size() && line[key_end] != '=' && line[key_end] != ':' && !is_blank(line[key_end])) {
            key_end += line[key_end] == '\\' ? 2 : 1;
        }
        key_end = std::min(key_end, line.size());
        std::size_t value_begin = key_end;
        while (value_begin < line.size() && is_blank(line[value_begin])) ++value_begin;
        if (value_begin < line.size() && (line[value_begin] == '=' || line[value_begin] == ':')) ++value_begin;
        while (value_begin < line.size() && is_blank(line[value_begin])) ++value_begin;

        const std::string_view view = line;
        properties.insert_or_assign(unescape(view.substr(0, key_end)), unescape(view.substr(value_begin)));
    }
    return properties;
}

}  // namespace embody::interchange
