// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace embody::interchange {

/// Key and value pairs of a Java .properties file (java.util.Properties.load): ISO 8859-1 with \uXXXX escapes, '#' and
/// '!' comments, lines continued by a backslash. Values are UTF-8. Every text is some properties file, so nothing can
/// fail; a later value of the same key wins.
std::map<std::string, std::string, std::less<>> parse_properties(std::string_view text);

}  // namespace embody::interchange
