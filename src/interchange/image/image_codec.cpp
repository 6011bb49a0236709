// SPDX-License-Identifier: MIT
// The one place where stb's image libraries are compiled.
#include "interchange/image/image_codec.h"

#include <limits>

#include "interchange/image/sgi_image.h"

// What is not wanted stays out; the libraries' own warnings are theirs.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_HDR
#define STBI_NO_PIC
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

constexpr std::int64_t most_pixels = 64'000'000;

bool fits_int(std::size_t size) { return size <= static_cast<std::size_t>(std::numeric_limits<int>::max()); }

ImageFormat format_of(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > 8 && bytes[0] == 0x89 && bytes[1] == 'P' && bytes[2] == 'N' && bytes[3] == 'G')
        return ImageFormat::png;
    if (bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF) return ImageFormat::jpeg;
    return ImageFormat::other;
}

void append_bytes(void* out, void* data, int size) {
    auto* bytes = static_cast<std::vector<std::uint8_t>*>(out);
    const auto* begin = static_cast<const std::uint8_t*>(data);
    bytes->insert(bytes->end(), begin, begin + size);
}

}  // namespace

Result<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes) {
    if (const auto sgi = read_sgi_header(bytes)) return *sgi;
    ImageHeader header{.format = format_of(bytes)};
    int channels = 0;
    if (!fits_int(bytes.size()) || stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &header.width,
                                                         &header.height, &channels) == 0) {
        return Error{"image", "is no PNG, JPEG, BMP, TGA, GIF, PSD, PNM or SGI image"};
    }
    header.has_alpha = channels == 2 || channels == 4;
    return header;
}

Result<Image> decode_image(std::span<const std::uint8_t> bytes) {
    const auto header = read_image_header(bytes);
    if (!header) return header.error();
    if (std::int64_t{header->width} * header->height > most_pixels) {
        return Error{"image",
                     std::to_string(header->width) + " × " + std::to_string(header->height) + " pixels are too many"};
    }
    if (read_sgi_header(bytes)) return decode_sgi(bytes);
    int width = 0, height = 0, channels = 0;
    stbi_uc* pixels =
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, STBI_rgb_alpha);
    if (pixels == nullptr) return Error{"image", std::string("is damaged: ") + stbi_failure_reason()};
    const auto count = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Image image{width, height, std::vector<std::uint8_t>(pixels, pixels + count)};
    stbi_image_free(pixels);
    return image;
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
