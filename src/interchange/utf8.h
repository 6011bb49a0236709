// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace embody::interchange {

/// Appends a code point, below 0x110000.
void append_utf8(std::string& out, std::uint32_t code);

/// Whether all of it is well-formed: shortest forms, no surrogates, nothing above U+10FFFF (RFC 3629).
bool is_utf8(std::string_view text);

/// `text` where it is UTF-8, else its bytes read by code page 437, as old zip programs write names (PKWARE,
/// APPNOTE.TXT, appendix D).
std::string utf8_or_cp437(std::string_view text);

}  // namespace embody::interchange
