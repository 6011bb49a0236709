// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/random.h"

namespace embody::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// No mutation makes an input larger.
inline constexpr std::size_t largest_input = 256 << 10;

/// `input` with one to eight kinds of damage: bits, bytes and words replaced by values that often cause errors, numbers
/// in digits replaced by others, blocks copied, moved, removed or taken from `other`, the end cut off. The same random
/// numbers cause the same damage.
Bytes damaged(const Bytes& input, std::span<const std::uint8_t> other, Random& random);

}  // namespace embody::fuzz
