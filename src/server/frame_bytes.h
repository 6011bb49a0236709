// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace embody::server {

static_assert(std::endian::native == std::endian::little, "frames are little-endian and written as they lie in memory");

/// Appends a number's bytes to a binary frame.
template <class T>
void append(std::string& frame, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    frame.append(bytes, sizeof(T));
}

/// Bytes as text of the alphabet of RFC 4648, section 4.
inline std::string base64(const std::string& bytes) {
    static constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(i + k > bytes.size() ? '=' : alphabet[three >> (18 - 6 * k) & 63]);
    }
    return text;
}

}  // namespace embody::server
