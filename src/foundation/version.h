// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// Semantic version of the program and its library; the same as in CMakeLists.txt (a test compares them).
inline constexpr const char* version_text = "0.1.0";

}  // namespace embody
