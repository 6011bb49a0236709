// SPDX-License-Identifier: MIT
#include "foundation/printable.h"

#include <gtest/gtest.h>

namespace embody {
namespace {

TEST(Printable, ControlCharactersAreWrittenOut) {
    EXPECT_EQ(printable("a\x1b[31mred\nb\r\tc"), "a\\x1b[31mred\\nb\\r\\tc");
    EXPECT_EQ(printable(std::string_view("nul\0!", 5)), "nul\\x00!");
    EXPECT_EQ(printable("\x7f"), "\\u007f");
    EXPECT_EQ(printable("\u009b31m"), "\\u009b31m") << "the one-character form of ESC [";
    EXPECT_EQ(printable("\u2028\u2029"), "\\u2028\\u2029");
}

TEST(Printable, NothingTurnsTheDirectionOfWriting) {
    for (const char* turn :
         {"\u202a", "\u202b", "\u202c", "\u202d", "\u202e", "\u2066", "\u2067", "\u2068", "\u2069"}) {
        const std::string shown = printable(std::string("chair") + turn + "gpj.obj");
        EXPECT_EQ(shown.find(turn), std::string::npos) << shown;
        EXPECT_EQ(shown.substr(0, 9), "chair\\u20") << shown;
    }
}

TEST(Printable, LettersOfAllScriptsStay) {
    for (const char* letters :
         {"", "chair 3", "Tür é ñ", "стол", "椅子", "كرسي", "כיסא", "🪑", "a\\nb", "\u00a0", "\U0010ffff"})
        EXPECT_EQ(printable(letters), letters);
}

TEST(Printable, BytesThatAreNoUtf8AreWrittenOut) {
    EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
    EXPECT_EQ(printable("\x80\xff\xc3("), "\\x80\\xff\\xc3(");
    EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a") << "overlong line end";
    EXPECT_EQ(printable("\xe0\x82\x9b"), "\\xe0\\x82\\x9b") << "overlong control character";
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "surrogate";
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "above U+10FFFF";
    EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80") << "cut off";
}

TEST(Printable, LeavesItsOwnResultUnchanged) {
    std::string all;
    for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
    const std::string once = printable(all);
    EXPECT_EQ(printable(once), once);
    for (const char c : once) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
}

TEST(Printable, LineEndsStayWhereLinesAreMeant) {
    EXPECT_EQ(printable_lines("one\ntwo\x1b\n\nfour"), "one\ntwo\\x1b\n\nfour");
    EXPECT_EQ(printable_lines(""), "");
    EXPECT_EQ(printable_lines("\n"), "\n");
}

}  // namespace
}  // namespace embody
