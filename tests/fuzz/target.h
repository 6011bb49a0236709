// SPDX-License-Identifier: MIT
// What every fuzz target has: the function that libFuzzer calls, too, and the ways to say that something is wrong.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "foundation/result.h"

/// One input. Returns 0; what must not be ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// A target whose inputs have checksums or lengths may set them right in half of the damaged ones, so that the damage
/// is not all found at the door. May change the size up to `capacity`; returns the new one.
extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t capacity);

namespace embody::fuzz {

/// Ends the process where a promise is not kept; the driver keeps the input.
inline void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

/// A refusal says where and why.
inline void require_reasons(const Error& error) {
    require(!error.where.empty(), "a refusal names the place");
    require(!error.why.empty(), "a refusal says the reason");
}

/// Little-endian numbers of formats.
inline std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return word;
}
inline void set_word(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t word) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
}

}  // namespace embody::fuzz
