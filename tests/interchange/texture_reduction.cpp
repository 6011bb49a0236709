// SPDX-License-Identifier: MIT
#include "interchange/compact/texture_reduction.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "interchange/image/image_codec.h"

namespace embody::interchange {
namespace {

/// A picture whose alpha is a function of the pixel's index; a `noisy` one does not compress.
RawImage picture(int side, const std::function<int(int)>& alpha, bool noisy = false) {
    Image image{side, side, {}};
    std::mt19937 random(5);
    for (int i = 0; i < side * side; ++i) {
        const auto shade = [&] { return static_cast<std::uint8_t>(noisy ? random() : 128); };
        image.rgba.insert(image.rgba.end(), {shade(), shade(), shade(), static_cast<std::uint8_t>(alpha(i))});
    }
    return {"picture", encode_png(image)};
}

int solid(int) { return 255; }

TEST(TextureReduction, RefusesWhatIsNoPictureOrBreaksOff) {
    EXPECT_FALSE(reduce_texture({"text", {'n', 'o'}}, 64));
    RawImage cut = picture(32, [](int i) { return i % 256; });
    cut.bytes.resize(cut.bytes.size() / 2);
    EXPECT_FALSE(reduce_texture(cut, 64));
}

TEST(TextureReduction, LeavesSmallPicturesAsTheyAreAndTellsTheirTransparency) {
    const auto reduced = [](const std::function<int(int)>& alpha) {
        const RawImage image = picture(32, alpha);
        const auto stored = reduce_texture(image, 64);
        EXPECT_TRUE(stored);
        EXPECT_EQ(stored->bytes, image.bytes);
        EXPECT_EQ(stored->mime_type, "image/png");
        return stored->transparency;
    };
    EXPECT_EQ(reduced(solid), Transparency::opaque);
    EXPECT_EQ(reduced([](int i) { return i % 2 == 0 ? 0 : 255; }), Transparency::cut_out) << "leaves";
    EXPECT_EQ(reduced([](int) { return 128; }), Transparency::blended) << "glass";
    EXPECT_EQ(reduced([](int i) { return i % 2 == 0   ? 0
                                         : i % 4 == 1 ? 128
                                                      : 255; }), Transparency::blended)
        << "a fourth is neither clear nor solid";
}

TEST(TextureReduction, MakesLargePicturesSmallerAndKeepsTheirAlpha) {
    const auto opaque = reduce_texture(picture(100, solid), 50);
    ASSERT_TRUE(opaque) << opaque.error().message();
    EXPECT_EQ(opaque->mime_type, "image/jpeg");
    const auto header = read_image_header(opaque->bytes);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->width, 50);
    const auto glass = reduce_texture(picture(100, [](int) { return 128; }), 50);
    ASSERT_TRUE(glass);
    EXPECT_EQ(glass->mime_type, "image/png") << "a JPEG has no alpha";
    const auto pixels = decode_image(glass->bytes);
    ASSERT_TRUE(pixels);
    EXPECT_EQ(pixels->width, 50);
    EXPECT_NEAR(pixels->rgba[3], 128, 1);
    // A PNG of the same size that does not compress.
    const auto noise = reduce_texture(picture(300, solid, true), 512);
    ASSERT_TRUE(noise);
    EXPECT_EQ(noise->mime_type, "image/jpeg");
}

}  // namespace
}  // namespace embody::interchange
