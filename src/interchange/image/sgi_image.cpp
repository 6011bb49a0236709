// SPDX-License-Identifier: MIT
// Format: P. Haeberli, The SGI Image File Format, version 1.00, Silicon Graphics.
#include "interchange/image/sgi_image.h"

#include <algorithm>

namespace embody::interchange {
namespace {

constexpr std::size_t header_size = 512;
constexpr std::size_t max_sgi_side = 32768;

/// Big-endian numbers of the file; where it ends before them, 0.
std::size_t number_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
    if (at + size > bytes.size()) return 0;
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
    return value;
}

struct Form {
    bool run_lengths = false;
    std::size_t width = 0, height = 0, channels = 0;
};

std::optional<Form> form_of(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t magic = 474;
    if (bytes.size() < header_size || number_at(bytes, 0, 2) != magic) return std::nullopt;
    const std::size_t dimensions = number_at(bytes, 4, 2);
    Form form{bytes[2] == 1, number_at(bytes, 6, 2), dimensions < 2 ? 1 : number_at(bytes, 8, 2),
              dimensions < 3 ? 1 : number_at(bytes, 10, 2)};
    const bool usual = bytes[2] <= 1 && bytes[3] == 1 && number_at(bytes, 104, 4) == 0;
    const bool has_pixels = form.width > 0 && form.height > 0 && form.channels > 0 && form.channels <= 4;
    if (!usual || !has_pixels || std::max(form.width, form.height) > max_sgi_side) return std::nullopt;
    return form;
}

/// A row of one channel from its runs: a count of bytes to copy (high bit set) or to repeat. False where it ends early.
bool unpack_row(std::span<const std::uint8_t> packed, std::span<std::uint8_t> row) {
    std::size_t at = 0;
    while (!row.empty()) {
        if (at >= packed.size()) return false;
        const std::uint8_t code = packed[at++];
        const std::size_t count = code & 0x7F;
        if (count == 0) return false;
        const bool copied = (code & 0x80) != 0;
        if (count > row.size() || at + (copied ? count : 1) > packed.size()) return false;
        if (copied) {
            std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(at), count, row.begin());
        } else {
            std::fill_n(row.begin(), count, packed[at]);
        }
        at += copied ? count : 1;
        row = row.subspan(count);
    }
    return true;
}

/// The bytes of row `index`, counted over all channels; empty where the file does not hold them.
std::span<const std::uint8_t> row_bytes(std::span<const std::uint8_t> bytes, const Form& form, std::size_t index) {
    std::size_t start = header_size + index * form.width, size = form.width;
    if (form.run_lengths) {
        const std::size_t rows = form.height * form.channels;
        start = number_at(bytes, header_size + 4 * index, 4);
        size = number_at(bytes, header_size + 4 * (rows + index), 4);
    }
    if (start > bytes.size() || size > bytes.size() - start) return {};
    return bytes.subspan(start, size);
}

}  // namespace

std::optional<ImageHeader> read_sgi_header(std::span<const std::uint8_t> bytes) {
    const auto form = form_of(bytes);
    if (!form) return std::nullopt;
    return ImageHeader{ImageFormat::other, static_cast<int>(form->width), static_cast<int>(form->height),
                       form->channels == 2 || form->channels == 4};
}

Result<Image> decode_sgi(std::span<const std::uint8_t> bytes) {
    const auto form = form_of(bytes);
    if (!form) return Error{"image", "is no SGI image of one byte a channel"};
    const auto [run_lengths, width, height, channels] = *form;
    Image image{static_cast<int>(width), static_cast<int>(height), {}};
    image.rgba.assign(4 * width * height, 255);

    // Rows come channel after channel, from the bottom up; one or two channels are gray.
    std::vector<std::uint8_t> row(width);
    for (std::size_t index = 0; index < height * channels; ++index) {
        const auto stored = row_bytes(bytes, *form, index);
        const bool complete = run_lengths ? unpack_row(stored, row) : stored.size() == width;
        if (!complete) return Error{"image", "ends before its last row"};
        if (!run_lengths) std::copy(stored.begin(), stored.end(), row.begin());
        const std::size_t channel = index / height, y = height - 1 - index % height;
        const bool gray = channels < 3;
        for (std::size_t x = 0; x < width; ++x) {
            std::uint8_t* pixel = &image.rgba[4 * (y * width + x)];
            if (gray && channel == 0) {
                std::fill_n(pixel, 3, row[x]);
            } else {
                pixel[gray ? 3 : channel] = row[x];
            }
        }
    }
    return image;
}

}  // namespace embody::interchange
