// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace embody::fuzz {

/// How a child that ran inputs ended, reported by itself in memory that the parent can read.
struct LastWords {
    std::array<char, 64> signal;  ///< "SIGSEGV", or the sanitizer's name of the error
    std::array<char, 96> module;  ///< file name of the library or program whose code failed; empty: unknown
};

/// From this call on the process records in `last_words` whose code failed before a signal ends it: the innermost frame
/// of the stack that belongs neither to the C or C++ library nor to a sanitizer.
void watch_crashes(LastWords* last_words);

}  // namespace embody::fuzz
