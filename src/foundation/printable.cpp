// SPDX-License-Identifier: MIT
#include "foundation/printable.h"

#include <cstdint>
#include <cstdio>

namespace embody {
namespace {

struct CodePoint {
    std::uint32_t code = 0;
    std::size_t bytes = 0;  ///< 0: the text here is not UTF-8
};

/// The code point at the start of `text`, which is not empty. RFC 3629: overlong forms, surrogates and code points
/// above U+10FFFF are not UTF-8.
CodePoint first_code_point(std::string_view text) {
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
    std::uint32_t code = lead & (0x7Fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return {};
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    const bool is_overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (is_overlong || is_surrogate || code > 0x10FFFF) return {};
    return {code, bytes};
}

bool is_control(std::uint32_t code) {
    const bool is_c0_or_c1 = code < 0x20 || (code >= 0x7F && code <= 0x9F);
    const bool ends_line = code == 0x2028 || code == 0x2029;
    // Embeddings, overrides and isolates: they change the direction in which the text after them is shown.
    const bool turns_direction = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return is_c0_or_c1 || ends_line || turns_direction;
}

void append_escape(std::string& out, const char* form, std::uint32_t number) {
    char escape[8];
    std::snprintf(escape, sizeof escape, form, number);
    out += escape;
}

void append_control(std::string& out, std::uint32_t code) {
    switch (code) {
        case '\n':
            out += "\\n";
            return;
        case '\r':
            out += "\\r";
            return;
        case '\t':
            out += "\\t";
            return;
        default:
            // From U+007F on in the form that JSON uses too.
            append_escape(out, code < 0x7F ? "\\x%02x" : "\\u%04x", code);
    }
}

}  // namespace

std::string printable(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const CodePoint point = first_code_point(text);
        if (point.bytes == 0) {
            append_escape(out, "\\x%02x", static_cast<unsigned char>(text.front()));
        } else if (is_control(point.code)) {
            append_control(out, point.code);
        } else {
            out += text.substr(0, point.bytes);
        }
        text.remove_prefix(point.bytes == 0 ? 1 : point.bytes);
    }
    return out;
}

std::string printable_lines(std::string_view text) {
    std::string out;
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
        out += printable(text.substr(0, end)) + '\n';
        text.remove_prefix(end + 1);
    }
    return out + printable(text);
}

}  // namespace embody
