// SPDX-License-Identifier: MIT
// What every fuzz target has: the function that libFuzzer calls, too, and the functions that report errors.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "foundation/result.h"

/// Runs one input. Returns 0; a broken promise ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// A target whose inputs have checksums or lengths may correct them in half of the damaged inputs, so that not every
/// damage is found at once. May change the size up to `capacity`; returns the new one.
extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t capacity);

namespace embody::fuzz {

/// Ends the process where a promise is broken; the driver keeps the input.
inline void require(bool kept, const char* promise) {
    if (kept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

/// An error says where and why.
inline void require_reasons(const Error& error) {
    require(!error.where.empty(), "a refusal names the place");
    require(!error.why.empty(), "a refusal says the reason");
}

/// Reads a little-endian number.
inline std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return word;
}
inline void set_word(std::span<std::uint8_t> bytes, std::size_t at, std::uint64_t word) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (8 * i));
}

}  // namespace embody::fuzz
