// SPDX-License-Identifier: MIT
// Textures: PNG, JPEG, BMP, TGA, GIF, SGI.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "../target.h"
#include "interchange/image/image_codec.h"

using namespace embody;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span bytes(data, size);
    const auto header = interchange::read_image_header(bytes);
    if (!header) fuzz::require(!header.error().why.empty(), "a refusal says the reason");
    // Large images are slow and test nothing more.
    if (header && std::int64_t{header->width} * header->height > 4'000'000 && header->width < 60'000) return 0;
    const auto image = interchange::decode_image(bytes);
    if (!image) {
        fuzz::require(!image.error().why.empty(), "a refusal says the reason");
        return 0;
    }
    fuzz::require(header.ok(), "what can be decoded has a header");
    fuzz::require(image->width > 0 && image->height > 0, "an image has pixels");
    fuzz::require(image->width == header->width && image->height == header->height, "header and image have one size");
    fuzz::require(image->rgba.size() ==
                      std::size_t{4} * static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height),
                  "there is a colour for each pixel");
    if (image->rgba.size() > 65'536) return 0;
    const auto again = interchange::decode_image(interchange::encode_png(*image));
    fuzz::require(again.ok() && again->rgba == image->rgba, "PNG keeps every pixel");
    const auto small = interchange::resized(*image, 7, 5);
    fuzz::require(small.rgba.size() == 140, "a resized image has its size");
    return 0;
}

/// Corrects the checksums of a PNG's chunks.
extern "C" std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size, std::size_t /*capacity*/) {
    if (size < 8 || std::memcmp(data, "\x89PNG", 4) != 0) return size;
    for (std::size_t at = 8; at + 12 <= size;) {
        const std::size_t length = std::size_t{data[at]} << 24 | std::size_t{data[at + 1]} << 16 |
                                   std::size_t{data[at + 2]} << 8 | data[at + 3];
        if (length > size - at - 12) break;
        const uLong sum = crc32(0, data + at + 4, static_cast<uInt>(length + 4));
        for (std::size_t i = 0; i < 4; ++i) data[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
        at += 12 + length;
    }
    return size;
}
