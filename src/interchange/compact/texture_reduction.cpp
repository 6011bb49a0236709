// SPDX-License-Identifier: MIT
#include "interchange/compact/texture_reduction.h"

#include <algorithm>
#include <cmath>

#include "interchange/image/image_codec.h"

namespace embody::interchange {
namespace {

constexpr std::size_t large_png = 128 << 10;  // bytes; an opaque one above becomes JPEG
constexpr int jpeg_quality = 88;

Transparency transparency_of(const Image& image) {
    std::size_t clear = 0, between = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
        if (image.rgba[i] < 16)
            ++clear;
        else if (image.rgba[i] < 240)
            ++between;
    }
    const std::size_t pixels = image.rgba.size() / 4;
    if (clear == 0 && between == 0) return Transparency::opaque;
    return clear > 0 && between * 5 < pixels ? Transparency::cut_out : Transparency::blended;
}

}  // namespace

Result<StoredTexture> reduce_texture(const RawImage& image, int largest) {
    const auto header = read_image_header(image.bytes);
    if (!header) return header.error();
    if (header->format == ImageFormat::other) return Error{image.name, "is neither PNG nor JPEG"};
    StoredTexture stored;
    stored.mime_type = header->format == ImageFormat::jpeg ? "image/jpeg" : "image/png";

    // Small enough, and its pixels need no test: it stays as it is.
    const bool too_large = std::max(header->width, header->height) > largest;
    const bool heavy_png = header->format == ImageFormat::png && image.bytes.size() > large_png;
    if (!too_large && !heavy_png && !header->has_alpha) {
        stored.bytes = image.bytes;
        return stored;
    }
    auto pixels = decode_image(image.bytes);
    if (!pixels) return pixels.error();
    stored.transparency = transparency_of(*pixels);
    if (!too_large && !(heavy_png && stored.transparency == Transparency::opaque)) {
        stored.bytes = image.bytes;
        return stored;
    }

    if (too_large) {
        const double ratio = static_cast<double>(largest) / std::max(pixels->width, pixels->height);
        const auto scaled = [ratio](int side) { return std::max(1, static_cast<int>(std::lround(side * ratio))); };
        *pixels = resized(*pixels, scaled(pixels->width), scaled(pixels->height));
    }
    const bool opaque = stored.transparency == Transparency::opaque;
    stored.bytes = opaque ? encode_jpeg(*pixels, jpeg_quality) : encode_png(*pixels);
    stored.mime_type = opaque ? "image/jpeg" : "image/png";
    if (stored.bytes.empty()) return Error{image.name, "cannot be written in the reduced size"};
    return stored;
}

}  // namespace embody::interchange
