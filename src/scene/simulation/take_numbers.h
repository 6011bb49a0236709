// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace embody::scene {

/// Units of the numbers: docs/time.md.
inline constexpr double position_units = 32768, rotation_units = 32767, velocity_units = 4096;

/// Seven bits a byte, the lowest first.
inline void write_unsigned(std::string& data, std::uint64_t value) {
    while (value >= 0x80) {
        data.push_back(static_cast<char>(value | 0x80));
        value >>= 7;
    }
    data.push_back(static_cast<char>(value));
}

inline std::uint64_t read_unsigned(const char*& at) {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
        const auto byte = static_cast<std::uint8_t>(*at++);
        value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
        if (byte < 0x80) return value;
    }
}

/// Small numbers of either sign are short.
inline void write_signed(std::string& data, std::int64_t value) {
    write_unsigned(data, (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

inline std::int64_t read_signed(const char*& at) {
    const std::uint64_t value = read_unsigned(at);
    return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace embody::scene
