// SPDX-License-Identifier: MIT
#pragma once

#include "interchange/image/image_codec.h"

namespace embody::interchange {

bool is_jpeg(std::span<const std::uint8_t> bytes);

Result<ImageHeader> read_jpeg_header(std::span<const std::uint8_t> bytes);

/// Baseline and progressive, gray, colour and CMYK of 8 bits. The missing end of a file that breaks off is
/// gray. Colour profiles and the camera's orientation are ignored, as glTF 2.0 wants (section 3.8.3). The caller
/// has checked the size.
Result<Image> decode_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace embody::interchange
