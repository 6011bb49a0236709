// SPDX-License-Identifier: MIT
#pragma once

#include "interchange/image/image_codec.h"

namespace embody::interchange {

bool is_png(std::span<const std::uint8_t> bytes);

/// The header of a PNG: the chunks before the pixels. Transparency may be a channel or a colour that is named
/// transparent.
Result<ImageHeader> read_png_header(std::span<const std::uint8_t> bytes);

/// Any colour type, depth and interlacing; 16 bits are rounded to 8. Gamma and colour profiles are ignored, as glTF
/// 2.0 wants (section 3.8.3). The caller has checked the size.
Result<Image> decode_png(std::span<const std::uint8_t> bytes);

}  // namespace embody::interchange
