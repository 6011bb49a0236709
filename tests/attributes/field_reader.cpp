// SPDX-License-Identifier: MIT
#include "attributes/field_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <nlohmann/json.hpp>

namespace embody::attributes {
namespace {

using nlohmann::json;

std::string error_of(const char* text, const std::function<void(FieldReader&)>& read) {
    const json document = json::parse(text);
    FieldReader reader(document, "a.json: list[2]");
    read(reader);
    return reader.finish() ? std::string() : reader.error()->message();
}

TEST(FieldReader, NamesFileFieldAndWhatIsWrong) {
    std::string word;
    std::vector<std::string> words;
    std::array<double, 2> pair{};
    double number = 0;
    const auto read = [&](FieldReader& reader) {
        reader.require({"number"});
        reader.number("number", number, {1, 2});
        reader.word("word", word);
        reader.words("words", words);
        reader.numbers("pair", pair, not_negative);
        reader.list("list");
        reader.object("object");
    };
    EXPECT_EQ(error_of("[]", read), "a.json: list[2]: must be an object {…}, got a list");
    EXPECT_EQ(error_of("{}", read), "a.json: list[2].number: is missing");
    EXPECT_EQ(error_of(R"({"number": "1"})", read), "a.json: list[2].number: must be a number, got text");
    EXPECT_EQ(error_of(R"({"number": 3})", read), "a.json: list[2].number: must be from 1.0 to 2.0, got 3.0");
    const auto with = [&](const std::string& field) {
        return error_of(("{\"number\": 1, " + field + "}").c_str(), read);
    };
    EXPECT_EQ(with(R"("word": "")"), "a.json: list[2].word: must not be empty");
    EXPECT_EQ(with(R"("word": 1)"), "a.json: list[2].word: must be text, got a number");
    EXPECT_EQ(with(R"("words": "x")"), "a.json: list[2].words: must be a list, got text");
    EXPECT_EQ(with(R"("words": ["x", 1])"), "a.json: list[2].words[1]: must be text, got a number");
    EXPECT_EQ(with(R"("pair": [1])"), "a.json: list[2].pair: must be 2 numbers");
    EXPECT_EQ(with(R"("pair": [1, -1])"), "a.json: list[2].pair[1]: must be 0.0 or more, got -1.0");
    EXPECT_EQ(with(R"("list": {})"), "a.json: list[2].list: must be a list, got an object");
    EXPECT_EQ(with(R"("object": [])"), "a.json: list[2].object: must be an object {…}, got a list");
    EXPECT_EQ(with(R"("wrod": "x")"), "a.json: list[2].wrod: is not a field here (did you mean \"word\"?)");
    EXPECT_EQ(with(R"("word": "x", "words": ["y"], "pair": [1, 2], "list": [], "object": {})"), "");
    EXPECT_EQ(word, "x");
    EXPECT_EQ(words, std::vector<std::string>{"y"});
}

// What is wrong leaves the value as it was, and the first error stays.
TEST(FieldReader, KeepsTheFirstErrorOfAllThatShareOne) {
    const json document = json::parse(R"({"a": "x", "b": {"c": 1}})");
    std::optional<Error> error;
    FieldReader outer(document, "", error);
    double a = 7;
    EXPECT_FALSE(outer.number("a", a));
    EXPECT_EQ(a, 7);
    bool c = false;
    FieldReader inner(document["b"], outer.path("b"), outer.error());
    EXPECT_FALSE(inner.truth("c", c));
    EXPECT_FALSE(inner.finish());
    ASSERT_TRUE(error);
    EXPECT_EQ(error->where, "a");
}

}  // namespace
}  // namespace embody::attributes
