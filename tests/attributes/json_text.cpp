// SPDX-License-Identifier: MIT
#include "attributes/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace embody::attributes {
namespace {

using nlohmann::json;

std::string message_of(const std::string& text) {
    const auto parsed = parse_json(text, "file.json");
    return parsed ? "accepted" : parsed.error().message();
}

TEST(JsonText, NestingIsCountedOutsideOfTextsOnly) {
    const std::size_t max_depth = max_nesting_depth;
    EXPECT_TRUE(nests_too_deep(std::string(max_depth + 1, '[')));
    EXPECT_TRUE(nests_too_deep(R"("\"")" + std::string(max_depth + 1, '{')));
    EXPECT_FALSE(nests_too_deep(std::string(max_depth, '[') + std::string(max_depth, ']')));
    EXPECT_FALSE(nests_too_deep("\"" + std::string(1000, '[') + "\""));
    EXPECT_FALSE(nests_too_deep("\"\\\"" + std::string(1000, '[') + "\""));
    EXPECT_FALSE(nests_too_deep("\"\\"));
    EXPECT_FALSE(nests_too_deep(""));
    EXPECT_NE(message_of(std::string(100, '[')).find("nest more than 64 deep"), std::string::npos);
}

TEST(JsonText, WhatFollowsAByteZeroIsNotPassedOver) {
    // The parser takes a NUL for the end of the text; the search for repeated fields read on, beyond the end of its own
    // lists.
    using namespace std::string_literals;
    for (const std::string& text : {"{}\0]"s, "1\0\""s, "{\"a\": 1}\0\"\\"s, "[]\n\0"s, "\0"s, "[\"a\0b\"]"s})
        EXPECT_NE(message_of(text).find("has a byte 0"), std::string::npos) << message_of(text);
    EXPECT_EQ(message_of("{\n}\0]"s).rfind("file.json, line 2, column 2: is not JSON", 0), 0u)
        << message_of("{\n}\0]"s);
    EXPECT_EQ(message_of(R"(["a\u0000b"])"), "accepted");
}

TEST(JsonText, AFieldThatIsWrittenTwiceIsRefusedByNameAndPlace) {
    struct Case {
        const char* text;
        const char* says;
    };
    const Case cases[] = {
        {R"({"a": 1, "a": 1})", "file.json, line 1, column 10: a: is written a second time in the same object"},
        {"{\n \"mass\": 1,\n \"b\": [],\n \"mass\": 2}", "line 4, column 2: mass: "},
        {R"({"entities": [{"x": 1}, {"y": {"m": 1, "n": 2, "m": 3}}]})", ": entities[1].y.m: is written"},
        {R"([[], [{"a": {}, "b": [1, {"c": 0}], "a": {}}]])", ": [1][0].a: is written"},
        {R"({"a": 1, "\u0061": 2})", ": a: is written"},
        {R"({"": 1, "": 2})", "is written a second time"},
        {R"({"a\"b": 1, "c": {"d": "}"}, "a\"b": 2})", "is written a second time"},
        {R"({"pose": {}, "shape": {"type": "box"}, "pose": {}})", ": pose: is written"},
    };
    for (const Case& wrong : cases)
        EXPECT_NE(message_of(wrong.text).find(wrong.says), std::string::npos) << wrong.text << "\n"
                                                                              << message_of(wrong.text);
}

TEST(JsonText, EqualNamesInDifferentObjectsAndTextsAreRight) {
    for (const char* text :
         {R"({"a": {"a": {"a": 1}}})", R"([{"a": 1}, {"a": 2}])",
          R"({"a": "a", "b": ["a", "a"], "c": {"a": 1, "b": 2}})", R"({"a": [{"a": 1}, {"a": 1}], "A": 1, " a": 2})",
          R"({"a": "{\"b\": 1, \"b\": 2}"})", R"("a")", "3", "[]", "\xef\xbb\xbf{\"a\": 1}"})
        EXPECT_EQ(message_of(text), "accepted") << text;
}

TEST(JsonText, ManyFieldsAreSearchedInOneObject) {
    std::string text = "{";
    for (int i = 0; i < 300000; ++i) text += "\"" + std::to_string(i) + "\": 0,";
    EXPECT_EQ(message_of(text + "\"last\": 0}"), "accepted");
    EXPECT_NE(message_of(text + "\"77\": 0}").find(": 77: is written"), std::string::npos);
}

}  // namespace
}  // namespace embody::attributes
