// SPDX-License-Identifier: MIT
// The only place that includes libpng. It reports errors by longjmp(), which skips destructors: the code below
// attempt() has none.
#include "interchange/image/png_image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>

#include "interchange/one_line.h"

namespace embody::interchange {
namespace {

constexpr png_uint_32 max_png_side = 32768;
constexpr png_alloc_size_t max_chunk_bytes = 8 << 20;  // unpacked, of one text or colour profile
constexpr png_uint_32 max_chunks = 128;                // that libpng keeps

/// libpng's objects for one image, and where it reads from.
class PngReader {
public:
    explicit PngReader(std::span<const std::uint8_t> bytes) : left_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
        info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, &info_, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, this, read_some);
        png_set_user_limits(png_, max_png_side, max_png_side);
        png_set_chunk_malloc_max(png_, max_chunk_bytes);
        png_set_chunk_cache_max(png_, max_chunks);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    Result<ImageHeader> read_header() {
        if (!attempt([](PngReader& reader, std::uint8_t*) { png_read_info(reader.png_, reader.info_); }, nullptr)) {
            return damage();
        }
        const int color = png_get_color_type(png_, info_);
        const bool transparent = (color & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
        return ImageHeader{ImageFormat::png, static_cast<int>(png_get_image_width(png_, info_)),
                           static_cast<int>(png_get_image_height(png_, info_)), transparent};
    }

    /// Call after read_header().
    Result<Image> read_image(const ImageHeader& header) {
        Image image{header.width, header.height, {}};
        image.rgba.resize(4 * static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height));
        if (!attempt(read_pixels, image.rgba.data())) return damage();
        return image;
    }

private:
    static void read_pixels(PngReader& reader, std::uint8_t* rgba) {
        // Every stored form becomes four channels of 8 bits.
        png_set_expand(reader.png_);
        png_set_scale_16(reader.png_);
        png_set_gray_to_rgb(reader.png_);
        png_set_add_alpha(reader.png_, 0xFF, PNG_FILLER_AFTER);
        const int passes = png_set_interlace_handling(reader.png_);
        png_read_update_info(reader.png_, reader.info_);
        const std::size_t row = 4 * std::size_t{png_get_image_width(reader.png_, reader.info_)};
        if (png_get_rowbytes(reader.png_, reader.info_) != row) png_error(reader.png_, "unknown channels");

        // Each pass of an interlaced image fills in more of every row.
        const std::size_t height = png_get_image_height(reader.png_, reader.info_);
        for (int pass = 0; pass < passes; ++pass) {
            for (std::size_t y = 0; y < height; ++y) png_read_row(reader.png_, rgba + y * row, nullptr);
        }
    }

    /// False where libpng left `step` with an error.
    bool attempt(void (*step)(PngReader&, std::uint8_t*), std::uint8_t* pixels) {
        if (setjmp(back_) != 0) return false;
        step(*this, pixels);
        return true;
    }

    [[nodiscard]] Error damage() const { return {"image", "is a damaged PNG: " + one_line(message_.data())}; }

    static void on_error(png_structp png, const char* message) {
        auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
        std::strncpy(reader->message_.data(), message, reader->message_.size() - 1);
        std::longjmp(reader->back_, 1);
    }
    static void on_warning(png_structp, const char*) {}
    static void read_some(png_structp png, png_bytep out, size_t count) {
        auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
        if (count > reader->left_.size()) png_error(png, "it ends early");
        std::memcpy(out, reader->left_.data(), count);
        reader->left_ = reader->left_.subspan(count);
    }

    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::span<const std::uint8_t> left_;
    std::jmp_buf back_{};
    std::array<char, 128> message_{};
};

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) { return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0; }

Result<ImageHeader> read_png_header(std::span<const std::uint8_t> bytes) { return PngReader(bytes).read_header(); }

Result<Image> decode_png(std::span<const std::uint8_t> bytes) {
    PngReader reader(bytes);
    const auto header = reader.read_header();
    if (!header) return header.error();
    return reader.read_image(*header);
}

}  // namespace embody::interchange
