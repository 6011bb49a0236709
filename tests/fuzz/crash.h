// SPDX-License-Identifier: MIT
#pragma once

#include <array>

namespace embody::fuzz {

/// How a child that ran inputs ended, told by itself; it lies in memory that the parent sees.
struct LastWords {
    std::array<char, 64> signal;  ///< "SIGSEGV", or what the sanitizer calls it
    std::array<char, 96> module;  ///< file name of the library or program whose code failed; empty: not known
};

/// From now on the process says in `last_words` whose code failed before a signal ends it: the innermost one on the
/// stack that is neither the C or C++ library nor a sanitizer.
void watch_crashes(LastWords* last_words);

}  // namespace embody::fuzz
