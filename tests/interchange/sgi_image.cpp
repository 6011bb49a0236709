// SPDX-License-Identifier: MIT
#include "interchange/image/sgi_image.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace embody::interchange {
namespace {

/// A header of the format, then `body`.
std::vector<std::uint8_t> sgi(bool run_lengths, std::uint8_t channels, std::uint8_t width, std::uint8_t height,
                              const std::vector<std::uint8_t>& body) {
    std::vector<std::uint8_t> bytes(512 + body.size(), 0);
    bytes[0] = 1;
    bytes[1] = 218;
    bytes[2] = run_lengths ? 1 : 0;
    bytes[3] = 1;
    bytes[5] = 3;
    bytes[7] = width;
    bytes[9] = height;
    bytes[11] = channels;
    std::ranges::copy(body, bytes.begin() + 512);
    return bytes;
}

TEST(SgiImage, ReadsRowsFromTheBottomChannelAfterChannel) {
    // 2 × 2: below black and red, above green and white.
    const auto image = decode_image(sgi(false, 3, 2, 2, {0, 255, 0, 255, 0, 0, 255, 255, 0, 0, 0, 255}));
    ASSERT_TRUE(image) << image.error().message();
    const std::vector<std::uint8_t> expected{0, 255, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 255, 0, 0, 255};
    EXPECT_EQ(image->rgba, expected);
}

TEST(SgiImage, UnpacksRunsAndGrayWithAlpha) {
    // 3 × 1, gray and alpha: starts 528 and 531, lengths 3 and 5; 7 three times, then 1 2 3 as they are.
    const auto image =
        decode_image(sgi(true, 2, 3, 1, {0, 0, 2, 16, 0, 0, 2, 19, 0, 0, 0, 3, 0, 0, 0, 5, 3, 7, 0, 0x83, 1, 2, 3, 0}));
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->rgba, (std::vector<std::uint8_t>{7, 7, 7, 1, 7, 7, 7, 2, 7, 7, 7, 3}));
}

TEST(SgiImage, RefusesWhatEndsEarlyOrPointsOutside) {
    EXPECT_FALSE(decode_image(sgi(false, 3, 2, 2, {0, 255, 0})));
    EXPECT_FALSE(decode_image(sgi(true, 1, 3, 1, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF})));
    EXPECT_FALSE(decode_image(sgi(true, 1, 3, 1, {0, 0, 2, 8, 0, 0, 0, 2, 9, 7})));  // nine where three fit
    EXPECT_FALSE(decode_image(sgi(true, 1, 3, 1, {0, 0, 2, 8, 0, 0, 0, 1, 3})));     // a run without its byte
    EXPECT_FALSE(decode_image(sgi(true, 1, 3, 1, {0, 0, 2, 8, 0, 0, 0, 2, 0, 0})));  // ends at once
    EXPECT_FALSE(read_sgi_header(sgi(false, 5, 2, 2, {})));
    EXPECT_FALSE(read_sgi_header(sgi(false, 3, 0, 2, {})));
    EXPECT_FALSE(read_sgi_header({}));
}

}  // namespace
}  // namespace embody::interchange
