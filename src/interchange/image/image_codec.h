// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/result.h"

namespace embody::interchange {

/// Pixels by rows from the upper left, 8 bit sRGB, red green blue alpha, not premultiplied.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 × width × height
};

enum class ImageFormat : std::uint8_t { other, png, jpeg };

struct ImageHeader {
    ImageFormat format = ImageFormat::other;
    int width = 0, height = 0;
    bool has_alpha = false;  ///< the file stores an alpha channel; it may still be 1 everywhere
};

/// The format by the first bytes; an error where they are no PNG, JPEG, BMP, TGA, GIF or SGI image.
Result<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

/// Decodes PNG, JPEG, BMP, TGA, GIF (first frame) or SGI. Refuses more than 64 million pixels before it makes room for
/// them.
Result<Image> decode_image(std::span<const std::uint8_t> bytes);

std::vector<std::uint8_t> encode_png(const Image& image);
/// Without alpha; `quality` 1 … 100.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

/// Averaged down (or interpolated up) to exactly this size, colours weighted by alpha.
Image resized(const Image& image, int width, int height);

}  // namespace embody::interchange
