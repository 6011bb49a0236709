// SPDX-License-Identifier: MIT
#include "interchange/image/image_codec.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
// After <cstdio>, which jpeglib.h needs.
#include <jpeglib.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

namespace embody::interchange {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// A PNG of these rows: `depth` bits per channel, big-endian.
struct PngForm {
    png_uint_32 width = 0, height = 0;
    int depth = 8, color = PNG_COLOR_TYPE_RGB, interlace = PNG_INTERLACE_NONE;
    std::vector<png_color> palette = {};
    Bytes transparent = {};  ///< alpha of the palette's first colours
};

Bytes png_of(const PngForm& form, Bytes rows) {
    Bytes out;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &out,
        [](png_structp writer, png_bytep data, size_t size) {
            auto* bytes = static_cast<Bytes*>(png_get_io_ptr(writer));
            bytes->insert(bytes->end(), data, data + size);
        },
        nullptr);
    png_set_IHDR(png, info, form.width, form.height, form.depth, form.color, form.interlace,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!form.palette.empty()) png_set_PLTE(png, info, form.palette.data(), static_cast<int>(form.palette.size()));
    if (!form.transparent.empty())
        png_set_tRNS(png, info, form.transparent.data(), static_cast<int>(form.transparent.size()), nullptr);
    png_set_gAMA(png, info, 1.0);  // the decoder ignores this
    png_write_info(png, info);
    std::vector<png_bytep> pointers;
    for (std::size_t y = 0; y < form.height; ++y) pointers.push_back(rows.data() + y * png_get_rowbytes(png, info));
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return out;
}

struct JpegForm {
    int width = 16, height = 16, channels = 3;
    J_COLOR_SPACE stored_as = JCS_YCbCr, given_as = JCS_RGB;
    bool progressive = false, adobe = false;
    Bytes marker = {};  ///< content of an APP1 marker
};

/// A JPEG of one colour.
Bytes jpeg_of(const JpegForm& form, const Bytes& color) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&info, &out, &size);
    info.image_width = static_cast<JDIMENSION>(form.width);
    info.image_height = static_cast<JDIMENSION>(form.height);
    info.input_components = form.channels;
    info.in_color_space = form.given_as;
    jpeg_set_defaults(&info);
    jpeg_set_colorspace(&info, form.stored_as);
    info.write_Adobe_marker = form.adobe ? TRUE : FALSE;
    jpeg_set_quality(&info, 100, TRUE);
    if (form.progressive) jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    if (!form.marker.empty())
        jpeg_write_marker(&info, JPEG_APP0 + 1, form.marker.data(), static_cast<unsigned>(form.marker.size()));
    Bytes row;
    for (int x = 0; x < form.width; ++x) row.insert(row.end(), color.begin(), color.end());
    for (int y = 0; y < form.height; ++y) {
        JSAMPROW start = row.data();
        jpeg_write_scanlines(&info, &start, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    Bytes bytes(out, out + size);
    std::free(out);
    return bytes;
}

/// The image's first pixel; the whole image must have its colour but for rounding.
std::array<int, 4> color_of(const Result<Image>& image) {
    if (!image) {
        ADD_FAILURE() << image.error().message();
        return {};
    }
    const auto& p = image->rgba;
    for (std::size_t i = 4; i < p.size(); ++i) EXPECT_NEAR(p[i], p[i % 4], 2) << i;
    return {p[0], p[1], p[2], p[3]};
}

void expect_near(const std::array<int, 4>& a, const std::array<int, 4>& b) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], 3) << "channel " << c;
}

TEST(ImageCodec, RefusesPnmPsdAndWhatIsNoImage) {
    // stb_image reads beyond the rows of the first one, which has 16 bits per channel.
    const std::string pixels(64, '\x7f');
    for (const std::string& text : {"P6 4 4 65535\n" + pixels, "P6 4 4 255\n" + pixels, "P5 4 4 65535\n" + pixels,
                                    std::string("8BPS\0\1\0\0\0\0\0\0\0\3\0\0\0\4\0\0\0\4\0\10\0\3", 26) + pixels,
                                    std::string("#?RADIANCE\n"), std::string(), std::string("hello")}) {
        EXPECT_FALSE(read_image_header(bytes_of(text))) << text.substr(0, 12);
        EXPECT_FALSE(decode_image(bytes_of(text))) << text.substr(0, 12);
    }
}

TEST(ImageCodec, RefusesABmpWithoutPixels) {
    // stb_image accepts it as an image of zero width or height, which cannot be used.
    for (const auto& [width, height] : {std::pair{0, 3}, {3, 0}, {0, 0}}) {
        Bytes bmp = bytes_of(std::string("BM\x5a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0", 18) + std::string(8, '\0') +
                             std::string("\1\0\x18\0", 4) + std::string(60, '\0'));
        bmp[18] = static_cast<std::uint8_t>(width);
        bmp[22] = static_cast<std::uint8_t>(height);
        EXPECT_FALSE(read_image_header(bmp)) << width << " × " << height;
        EXPECT_FALSE(decode_image(bmp)) << width << " × " << height;
    }
}

TEST(ImageCodec, RefusesImagesThatBreakOff) {
    const Bytes png = encode_png({2, 2, Bytes(16, 100)});
    for (std::size_t size = 0; size + 16 < png.size(); ++size)
        EXPECT_FALSE(decode_image(std::span(png).first(size))) << size;
    const Bytes jpeg = jpeg_of({}, {10, 20, 30});
    for (std::size_t size = 0; size < 300; ++size) EXPECT_FALSE(decode_image(std::span(jpeg).first(size))) << size;
    // An image whose pixels break off is drawn up to there, as browsers do.
    EXPECT_TRUE(decode_image(std::span(jpeg).first(jpeg.size() - 4)));
}

TEST(ImageCodec, RefusesTooManyPixelsBeforeTheyAreHeld) {
    // A header of 30000 × 30000 without any pixels.
    Bytes png = encode_png({1, 1, Bytes(4, 0)});
    Bytes jpeg = jpeg_of({}, {0, 0, 0});
    const std::array<std::uint8_t, 2> side{0x75, 0x30};
    std::ranges::copy(side, png.begin() + 18);
    std::ranges::copy(side, png.begin() + 22);
    // The checksum of the header, which libpng verifies.
    png_uint_32 crc = 0;
    const auto remember = [&crc](std::uint8_t byte) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
    };
    crc = 0xFFFFFFFFu;
    std::for_each(png.begin() + 12, png.begin() + 29, remember);
    crc = ~crc;
    for (int i = 0; i < 4; ++i) png[static_cast<std::size_t>(29 + i)] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    const std::array<std::uint8_t, 2> start_of_frame{0xFF, 0xC0};
    const auto frame = std::ranges::search(jpeg, start_of_frame).begin();
    std::ranges::copy(side, frame + 5);
    std::ranges::copy(side, frame + 7);
    for (const Bytes& image : {png, jpeg}) {
        const auto decoded = decode_image(image);
        ASSERT_FALSE(decoded);
        EXPECT_EQ(decoded.error().why, "30000 × 30000 pixels are too many");
    }
}

TEST(ImageCodec, DamagedImagesAreRefusedOrDecoded) {
    const std::vector<Bytes> wholes{
        encode_png({8, 8, Bytes(256, 77)}), jpeg_of({}, {200, 100, 50}), jpeg_of({.progressive = true}, {200, 100, 50}),
        jpeg_of({.channels = 4, .stored_as = JCS_YCCK, .given_as = JCS_CMYK, .adobe = true}, {1, 2, 3, 4})};
    std::mt19937 random(5);
    for (const Bytes& whole : wholes) {
        for (int trial = 0; trial < 2000; ++trial) {
            Bytes damaged = whole;
            for (int k = 0; k < 4; ++k) damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
            if (trial % 3 == 0) damaged.resize(random() % damaged.size());
            const auto image = decode_image(damaged);
            if (image) {
                EXPECT_EQ(image->rgba.size(), 4u * static_cast<std::size_t>(image->width * image->height));
            } else {
                EXPECT_FALSE(image.error().why.empty());
            }
        }
    }
}

TEST(ImageCodec, RefusesAJpegOfEndlessScans) {
    Bytes jpeg = jpeg_of({.progressive = true}, {10, 20, 30});
    // The last scan, repeated many times.
    const std::array<std::uint8_t, 2> start_of_scan{0xFF, 0xDA};
    const auto last = std::ranges::find_end(jpeg, start_of_scan).begin();
    const Bytes scan(last, jpeg.end() - 2);
    jpeg.resize(jpeg.size() - 2);
    for (int i = 0; i < 1000; ++i) jpeg.insert(jpeg.end(), scan.begin(), scan.end());
    const auto image = decode_image(jpeg);
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().why, "is a damaged JPEG: it has more than 200 scans");
}

TEST(ImageCodec, PngOf16BitsIsRoundedTo8) {
    const Bytes png = png_of({.width = 2, .height = 1, .depth = 16}, {0, 0, 0x80, 0x7F, 0xFF, 0xFF,  //
                                                                      0x12, 0xFF, 0x01, 0x00, 0x7F, 0x00});
    const auto image = decode_image(png);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->rgba, (Bytes{0, 128, 255, 255, 0x13, 1, 127, 255}));
    EXPECT_FALSE(read_image_header(png)->has_alpha);
}

TEST(ImageCodec, PngOfAPaletteHasItsColoursAndTransparency) {
    const PngForm form{.width = 4,
                       .height = 1,
                       .depth = 2,
                       .color = PNG_COLOR_TYPE_PALETTE,
                       .palette = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}},
                       .transparent = {0, 128}};
    const Bytes png = png_of(form, {0b00'01'10'00});
    const auto image = decode_image(png);
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->rgba, (Bytes{255, 0, 0, 0, 0, 255, 0, 128, 0, 0, 255, 255, 255, 0, 0, 0}));
    EXPECT_TRUE(read_image_header(png)->has_alpha);
    EXPECT_FALSE(decode_image(png_of(form, {0b11'11'11'11})).ok() && image->rgba.empty());  // index out of range
}

TEST(ImageCodec, InterlacedAndGrayPngsAreWhole) {
    Bytes rows;
    for (int i = 0; i < 81; ++i) rows.push_back(static_cast<std::uint8_t>(3 * i));
    const auto image = decode_image(
        png_of({.width = 9, .height = 9, .color = PNG_COLOR_TYPE_GRAY, .interlace = PNG_INTERLACE_ADAM7}, rows));
    ASSERT_TRUE(image) << image.error().message();
    for (std::size_t i = 0; i < 81; ++i) {
        EXPECT_EQ(image->rgba[4 * i], rows[i]);
        EXPECT_EQ(image->rgba[4 * i + 2], rows[i]);
        EXPECT_EQ(image->rgba[4 * i + 3], 255);
    }
}

TEST(ImageCodec, JpegsOfEveryKindHaveTheirColour) {
    expect_near(color_of(decode_image(jpeg_of({}, {200, 100, 50}))), {200, 100, 50, 255});
    expect_near(color_of(decode_image(jpeg_of({.progressive = true}, {200, 100, 50}))), {200, 100, 50, 255});
    const JpegForm gray{.channels = 1, .stored_as = JCS_GRAYSCALE, .given_as = JCS_GRAYSCALE};
    expect_near(color_of(decode_image(jpeg_of(gray, {90}))), {90, 90, 90, 255});
    // Full magenta and half black, and the same in the form of Adobe's programs.
    const JpegForm inks{.channels = 4, .stored_as = JCS_CMYK, .given_as = JCS_CMYK};
    expect_near(color_of(decode_image(jpeg_of(inks, {0, 255, 0, 128}))), {127, 0, 127, 255});
    const JpegForm adobe{.channels = 4, .stored_as = JCS_YCCK, .given_as = JCS_CMYK, .adobe = true};
    expect_near(color_of(decode_image(jpeg_of(adobe, {255, 0, 255, 127}))), {127, 0, 127, 255});
}

TEST(ImageCodec, IgnoresTheCamerasOrientation) {
    // Exif with orientation 6: rotate by 90 degrees.
    const std::string exif("Exif\0\0MM\0*\0\0\0\10\0\1\1\22\0\3\0\0\0\1\0\6\0\0\0\0\0\0", 32);
    const auto image = decode_image(jpeg_of({.width = 24, .height = 8, .marker = bytes_of(exif)}, {1, 2, 3}));
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 24);
    EXPECT_EQ(image->height, 8);
}

TEST(ImageCodec, BmpTgaAndGifAreStillRead) {
    const std::string bmp = std::string("BM\x3a\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\1\0\0\0\1\0\0\0\1\0\x18\0", 30) +
                            std::string(24, '\0') + std::string("\x32\x64\xc8\0", 4);
    const std::string tga = std::string("\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x18\0", 18) + "\x32\x64\xc8";
    const std::string gif("GIF89a\1\0\1\0\x80\0\0\xc8\x64\x32\0\0\0,\0\0\0\0\1\0\1\0\0\2\2\x44\1\0;", 35);
    for (const std::string& text : {bmp, tga, gif}) {
        expect_near(color_of(decode_image(bytes_of(text))), {200, 100, 50, 255});
    }
}

}  // namespace
}  // namespace embody::interchange
