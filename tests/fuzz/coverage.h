// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace embody::fuzz {

/// Whether the program was built so that it says which of its branches run (-fsanitize-coverage=trace-pc).
bool coverage_is_known();
/// Before an input is run.
void forget_coverage();
/// After it: how many pairs of branches, or how often they ran by powers of two, were never seen in `seen`, to which
/// they are added.
std::size_t add_coverage(std::uint8_t* seen);
/// Bytes of `seen`.
inline constexpr std::size_t coverage_size = 1 << 16;

}  // namespace embody::fuzz
