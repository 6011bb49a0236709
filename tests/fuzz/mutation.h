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

/// `input` damaged in one to eight ways: bits, bytes and words exchanged for those that programs stumble over, numbers
/// written in digits exchanged for others, blocks copied, moved, removed or taken from `other`, the end cut off. The
/// same random numbers give the same damage.
Bytes damaged(const Bytes& input, std::span<const std::uint8_t> other, Random& random);

}  // namespace embody::fuzz
