// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "interchange/image/image_codec.h"

namespace embody::interchange {

/// The header of an SGI image (.rgb, .rgba, .bw); empty where the bytes are none.
std::optional<ImageHeader> read_sgi_header(std::span<const std::uint8_t> bytes);

/// Decodes an SGI image of one byte a channel, verbatim or run-length coded; one to four channels. read_sgi_header()
/// must accept it.
Result<Image> decode_sgi(std::span<const std::uint8_t> bytes);

}  // namespace embody::interchange
