// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace embody::fuzz {

/// Whether the program was built to report its executed branches (-fsanitize-coverage=trace-pc).
bool coverage_is_known();
/// Resets the counters; to be called before an input is run.
void forget_coverage();
/// To be called after an input was run: returns how many pairs of branches, or powers of two of their counts, are not
/// in `seen`, and adds them to it.
std::size_t add_coverage(std::uint8_t* seen);
/// Size of `seen`, bytes.
inline constexpr std::size_t coverage_size = 1 << 16;

}  // namespace embody::fuzz
