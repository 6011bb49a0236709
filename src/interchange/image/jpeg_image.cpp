// SPDX-License-Identifier: MIT
// The only place that includes libjpeg-turbo. It reports errors by longjmp(), which skips destructors: the code below
// attempt() has none.
#include "interchange/image/jpeg_image.h"

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
// Included after <cstdio>, which they need.
#include <jerror.h>
#include <jpeglib.h>

#include <new>
#include <string>

#include "interchange/one_line.h"

namespace embody::interchange {
namespace {

// A progressive image of a few kilobytes may ask for as many passes over all of its pixels as it has bytes; cameras and
// editors write about ten.
constexpr int max_scans = 200;

/// libjpeg's objects for one image.
class JpegReader {
public:
    explicit JpegReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
        info_.err = jpeg_std_error(&errors_);
        info_.client_data = this;
        errors_.error_exit = on_error;
        errors_.emit_message = on_message;
        progress_.progress_monitor = on_progress;
        // Fails only where the library is of another version than its header.
        created_ = attempt([](JpegReader& reader, std::uint8_t*) { jpeg_create_decompress(&reader.info_); }, nullptr);
    }
    ~JpegReader() {
        if (created_) jpeg_destroy_decompress(&info_);
    }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    Result<ImageHeader> read_header() {
        if (!created_ || !attempt(read_markers, nullptr)) return damage();
        return ImageHeader{ImageFormat::jpeg, static_cast<int>(info_.image_width), static_cast<int>(info_.image_height),
                           false};
    }

    /// Call after read_header().
    Result<Image> read_image(const ImageHeader& header) {
        Image image{header.width, header.height, {}};
        image.rgba.resize(4 * static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height));
        if (!attempt(read_pixels, image.rgba.data())) return damage();
        if (info_.out_color_space == JCS_CMYK) make_rgb(image.rgba, info_.saw_Adobe_marker != FALSE);
        return image;
    }

private:
    static void read_markers(JpegReader& reader, std::uint8_t*) {
        jpeg_mem_src(&reader.info_, reader.bytes_.data(), reader.bytes_.size());
        jpeg_read_header(&reader.info_, TRUE);
    }

    static void read_pixels(JpegReader& reader, std::uint8_t* rgba) {
        jpeg_decompress_struct& info = reader.info_;
        const bool inks = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
        info.out_color_space = inks ? JCS_CMYK : JCS_EXT_RGBA;
        info.progress = &reader.progress_;
        jpeg_start_decompress(&info);
        while (info.output_scanline < info.output_height) {
            JSAMPROW row = rgba + std::size_t{4} * info.output_width * info.output_scanline;
            jpeg_read_scanlines(&info, &row, 1);
        }
    }

    /// Cyan, magenta, yellow and black to the screen's colours, without profiles. Adobe's programs store inks inverted.
    static void make_rgb(std::vector<std::uint8_t>& pixels, bool inverted) {
        for (std::size_t i = 0; i < pixels.size(); i += 4) {
            const auto light = [&](std::size_t ink) { return inverted ? pixels[i + ink] : 255 - pixels[i + ink]; };
            const int white = light(3);
            for (std::size_t c = 0; c < 3; ++c) pixels[i + c] = static_cast<std::uint8_t>(light(c) * white / 255);
            pixels[i + 3] = 255;
        }
    }

    /// False where libjpeg left `step` with an error.
    bool attempt(void (*step)(JpegReader&, std::uint8_t*), std::uint8_t* pixels) {
        if (setjmp(back_) != 0) return false;
        step(*this, pixels);
        return true;
    }

    [[nodiscard]] Error damage() const {
        if (errors_.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
        return {"image", "is a damaged JPEG: " + one_line(message_.data())};
    }

    static JpegReader& reader_of(j_common_ptr info) { return *static_cast<JpegReader*>(info->client_data); }
    static void on_error(j_common_ptr info) {
        info->err->format_message(info, reader_of(info).message_.data());
        std::longjmp(reader_of(info).back_, 1);
    }
    static void on_message(j_common_ptr, int) {}
    static void on_progress(j_common_ptr info) {
        if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= max_scans) return;
        JpegReader& reader = reader_of(info);
        std::snprintf(reader.message_.data(), reader.message_.size(), "it has more than %d scans", max_scans);
        std::longjmp(reader.back_, 1);
    }

    std::span<const std::uint8_t> bytes_;
    jpeg_decompress_struct info_{};
    jpeg_error_mgr errors_{};
    jpeg_progress_mgr progress_{};
    bool created_ = false;
    std::jmp_buf back_{};
    std::array<char, JMSG_LENGTH_MAX> message_{};
};

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
    return bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

Result<ImageHeader> read_jpeg_header(std::span<const std::uint8_t> bytes) { return JpegReader(bytes).read_header(); }

Result<Image> decode_jpeg(std::span<const std::uint8_t> bytes) {
    JpegReader reader(bytes);
    const auto header = reader.read_header();
    if (!header) return header.error();
    return reader.read_image(*header);
}

}  // namespace embody::interchange
