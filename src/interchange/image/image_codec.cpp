// SPDX-License-Identifier: MIT
// The only place where stb's image libraries are compiled. stb reads the formats that are not worth a library of their
// own; docs/decisions/0015-image-decoders.md says why not the rest.
#include "interchange/image/image_codec.h"

#include <limits>

#include "interchange/image/jpeg_image.h"
#include "interchange/image/png_image.h"
#include "interchange/image/sgi_image.h"

// Formats that are not wanted are left out; the libraries' own warnings are theirs.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_ONLY_GIF
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 32768
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <stb_image_resize.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace embody::interchange {
namespace {

constexpr std::int64_t max_pixels = 64'000'000;

bool fits_int(std::size_t size) { return size <= static_cast<std::size_t>(std::numeric_limits<int>::max()); }

void append_bytes(void* out, void* data, int size) {
    auto* bytes = static_cast<std::vector<std::uint8_t>*>(out);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes->insert(bytes->end(), begin, begin + size);
}

Result<Image> decode_by_stb(std::span<const std::uint8_t> bytes) {
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels =
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, STBI_rgb_alpha);
    if (pixels == nullptr) return Error{"image", std::string("is damaged: ") + stbi_failure_reason()};
    const auto count = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Image image{width, height, std::vector<std::uint8_t>(pixels, pixels + count)};
    stbi_image_free(pixels);
    return image;
}

}  // namespace

Result<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes) {
    if (is_png(bytes)) return read_png_header(bytes);
    if (is_jpeg(bytes)) return read_jpeg_header(bytes);
    if (const auto sgi = read_sgi_header(bytes)) return *sgi;
    ImageHeader header;
    int channels = 0;
    // stb accepts a BMP without pixels.
    if (!fits_int(bytes.size()) ||
        stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &header.width, &header.height, &channels) ==
            0 ||
        header.width < 1 || header.height < 1) {
        return Error{"image", "is no PNG, JPEG, BMP, TGA, GIF or SGI image", "save it as PNG or JPEG"};
    }
    header.has_alpha = channels == 2 || channels == 4;
    return header;
}

Result<Image> decode_image(std::span<const std::uint8_t> bytes) {
    const auto header = read_image_header(bytes);
    if (!header) return header.error();
    if (std::int64_t{header->width} * header->height > max_pixels) {
        return Error{"image",
                     std::to_string(header->width) + " × " + std::to_string(header->height) + " pixels are too many"};
    }
    if (header->format == ImageFormat::png) return decode_png(bytes);
    if (header->format == ImageFormat::jpeg) return decode_jpeg(bytes);
    return read_sgi_header(bytes) ? decode_sgi(bytes) : decode_by_stb(bytes);
}

std::vector<std::uint8_t> encode_png(const Image& image) {
    std::vector<std::uint8_t> bytes;
    stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, 4, image.rgba.data(), 4 * image.width);
    return bytes;
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
    std::vector<std::uint8_t> bytes;
    stbi_write_jpg_to_func(append_bytes, &bytes, image.width, image.height, 4, image.rgba.data(), quality);
    return bytes;
}

Image resized(const Image& image, int width, int height) {
    Image out{width, height,
              std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
    stbir_resize_uint8_srgb(image.rgba.data(), image.width, image.height, 0, out.rgba.data(), width, height, 0, 4, 3,
                            0);
    return out;
}

}  // namespace embody::interchange
