// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace embody::interchange {

/// A library's message about a file, fit for one line of an error: it may quote the file, line ends, broken UTF-8 and
/// all.
/// At most 200 characters, ASCII.
inline std::string one_line(std::string_view text) {
    constexpr std::size_t max_length = 200;
    std::string line;
    for (const char c : text.substr(0, max_length)) {
        if (c > ' ' && c <= '~') {
            line += c;
        } else if (!line.empty() && line.back() != ' ') {
            line += ' ';
        }
    }
    return text.size() > max_length ? line + " ..." : line;
}

}  // namespace embody::interchange
