// SPDX-License-Identifier: MIT
#include "foundation/base64.h"

#include <array>
#include <cstdint>

namespace embody {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t not_in_it = 64;

constexpr std::array<std::uint8_t, 256> make_values() {
    std::array<std::uint8_t, 256> values{};
    values.fill(not_in_it);
    for (std::size_t i = 0; i < alphabet.size(); ++i)
        values[static_cast<std::uint8_t>(alphabet[i])] = static_cast<std::uint8_t>(i);
    return values;
}

}  // namespace

std::string to_base64(std::string_view bytes) {
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

std::optional<std::string> from_base64(std::string_view text) {
    static constexpr std::array<std::uint8_t, 256> values = make_values();
    if (text.size() % 4 != 0) return std::nullopt;
    const std::size_t filled = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3);
    for (std::size_t i = 0; i < text.size(); i += 4) {
        const std::size_t missing = i + 4 == text.size() ? filled : 0;
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint8_t value = k < 4 - missing ? values[static_cast<std::uint8_t>(text[i + k])] : 0;
            if (value == not_in_it) return std::nullopt;
            three = three << 6 | value;
        }
        if ((three & ((1U << 8 * missing) - 1)) != 0) return std::nullopt;
        for (std::size_t k = 0; k < 3 - missing; ++k) bytes.push_back(static_cast<char>(three >> (16 - 8 * k) & 0xFF));
    }
    return bytes;
}

}  // namespace embody
