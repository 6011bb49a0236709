// SPDX-License-Identifier: MIT
#include "foundation/base64.h"

#include <gtest/gtest.h>

#include "foundation/random.h"

namespace embody {
namespace {

TEST(Base64, IsThatOfTheStandard) {
    // RFC 4648, section 10.
    const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                           {"f", "Zg=="},
                                                           {"fo", "Zm8="},
                                                           {"foo", "Zm9v"},
                                                           {"foob", "Zm9vYg=="},
                                                           {"fooba", "Zm9vYmE="},
                                                           {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, text] : vectors) {
        EXPECT_EQ(to_base64(bytes), text);
        EXPECT_EQ(from_base64(text), bytes);
    }
}

TEST(Base64, OfAnyBytesIsReadBack) {
    Random random(1);
    for (int i = 0; i < 500; ++i) {
        std::string bytes(random.below(100), '\0');
        for (char& byte : bytes) byte = static_cast<char>(random.below(256));
        EXPECT_EQ(from_base64(to_base64(bytes)), bytes);
    }
}

TEST(Base64, ThatIsNoWholeOneIsRefused) {
    for (const char* text :
         {"Z", "Zg", "Zg=", "Zh==", "Zm9=", "=m9v", "Zg==Zm9v", "Zm 9", "Zm9v\n", "Z===", "====", "Zm9*"})
        EXPECT_FALSE(from_base64(text)) << text;
}

}  // namespace
}  // namespace embody
