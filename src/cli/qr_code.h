// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace embody::cli {

enum class QrColors : std::uint8_t { of_the_terminal, dark_on_light };

/// The QR code of a text in UTF-8 half blocks, two modules a character, with its quiet zone; each line ends with a line
/// feed. `of_the_terminal`: light modules are drawn, for light text on dark ground. Empty where the text is too long.
std::string qr_code(const std::string& text, QrColors colors);

}  // namespace embody::cli
