// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace embody {

/// `text` on one line, without power over a terminal or a log: what would move the cursor, change colours, end the line
/// or turn the direction of writing is written as "\n", "\x1b" or "\u202e", and bytes that are no UTF-8 as "\xff". All
/// other letters stay as they are. What is printable already is not changed.
std::string printable(std::string_view text);

/// The same of text of several lines: line ends ("\n") stay.
std::string printable_lines(std::string_view text);

}  // namespace embody
