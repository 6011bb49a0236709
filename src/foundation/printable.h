// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace embody {

/// `text` on one line that cannot control a terminal or a log: characters that move the cursor, change colours, end the
/// line or change the direction of writing are written as "\n", "\x1b" or "\u202e", and bytes that are not UTF-8 as
/// "\xff". All other letters stay as they are. A text that is already printable is not changed.
std::string printable(std::string_view text);

/// As printable() for text of several lines: line ends ("\n") stay.
std::string printable_lines(std::string_view text);

}  // namespace embody
