// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace embody {

/// Bytes as text of the alphabet of RFC 4648, section 4.
std::string to_base64(std::string_view bytes);

/// The bytes of such a text; none where it is no whole one: another character, a length that is no multiple of four,
/// wrong filling, or bits that no byte has.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace embody
