// SPDX-License-Identifier: MIT
#include "attributes/field_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace embody::attributes {
namespace {

using nlohmann::json;

constexpr double infinity = std::numeric_limits<double>::infinity();

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

// The refusal of one field, without its path; empty where the field was read.
std::string refusal(const std::string& field, const std::function<void(FieldReader&)>& read) {
    const std::string message = error_of(("{" + field + "}").c_str(), read), place = "a.json: list[2].";
    return message.starts_with(place) ? message.substr(place.size()) : message;
}

TEST(FieldReader, WholeNumbersAreInTheirRangeAndHaveNoFraction) {
    std::uint32_t count = 7;
    int signless = 8;
    const auto read = [&](FieldReader& reader) { reader.whole("count", count, 1, 10); };
    EXPECT_EQ(refusal(R"("count": 0)", read), "count: must be from 1.0 to 10.0, got 0.0");
    EXPECT_EQ(refusal(R"("count": 11)", read), "count: must be from 1.0 to 10.0, got 11.0");
    EXPECT_EQ(refusal(R"("count": 2.5)", read), "count: must be a whole number, got 2.5");
    EXPECT_EQ(refusal(R"("count": null)", read), "count: must be a number, got nothing (null)");
    EXPECT_EQ(refusal(R"("count": true)", read), "count: must be a number, got true or false");
    EXPECT_EQ(count, 7u);
    EXPECT_EQ(refusal(R"("count": 3.0)", read), "");
    EXPECT_EQ(count, 3u);
    const auto read_int = [&](FieldReader& reader) { reader.whole("count", signless, 0, 5); };
    EXPECT_EQ(refusal(R"("count": -1)", read_int), "count: must be from 0.0 to 5.0, got -1.0");
    EXPECT_EQ(signless, 8);
    EXPECT_EQ(refusal(R"("count": 5)", read_int), "");
    EXPECT_EQ(signless, 5);
    const auto read_any = [&](FieldReader& reader) { reader.whole("count", count); };
    EXPECT_EQ(refusal(R"("count": 4294967295)", read_any), "");
    EXPECT_EQ(count, 4294967295u);
    EXPECT_NE(refusal(R"("count": 4294967296)", read_any), "");
}

TEST(FieldReader, RangesThatAreOpenOnOneSideSaySo) {
    double value = 0;
    std::optional<double> maybe;
    EXPECT_EQ(refusal(R"("x": 0)", [&](FieldReader& reader) { reader.number("x", value, positive); }),
              "x: must be greater than 0, got 0.0");
    EXPECT_EQ(refusal(R"("x": 2)",
                      [&](FieldReader& reader) {
                          reader.number("x", value, {-infinity, 1});
                      }),
              "x: must be 1.0 or less, got 2.0");
    std::optional<Error> error;
    EXPECT_FALSE(read_number(json(infinity), "x", value, error)) << "which no text says, but a program may";
    ASSERT_TRUE(error);
    EXPECT_EQ(error->message(), "x: must be a finite number");
    EXPECT_EQ(refusal(R"("x": "3")", [&](FieldReader& reader) { reader.number("x", maybe); }),
              "x: must be a number, got text");
    EXPECT_FALSE(maybe.has_value());
    EXPECT_EQ(refusal(R"("x": -3)", [&](FieldReader& reader) { reader.number("x", maybe); }), "");
    EXPECT_EQ(maybe, -3);
}

TEST(FieldReader, TruthAndChoicesAreAmongWhatIsAllowed) {
    bool truth = true;
    const auto read_truth = [&](FieldReader& reader) { reader.truth("on", truth); };
    EXPECT_EQ(refusal(R"("on": 0)", read_truth), "on: must be true or false, got a number");
    EXPECT_TRUE(truth);
    EXPECT_EQ(refusal(R"("on": false)", read_truth), "");
    EXPECT_FALSE(truth);
    std::size_t index = 9;
    const auto read_choice = [&](FieldReader& reader) { reader.choice("side", index, {"left", "right"}); };
    EXPECT_EQ(refusal(R"("side": "rihgt")", read_choice),
              "side: \"rihgt\" is not one of: left, right (did you mean \"right\"?)");
    EXPECT_EQ(refusal(R"("side": "elephant")", read_choice), "side: \"elephant\" is not one of: left, right");
    EXPECT_EQ(refusal(R"("side": 1)", read_choice), "side: must be text, got a number");
    EXPECT_EQ(index, 9u);
    EXPECT_EQ(refusal(R"("side": "right")", read_choice), "");
    EXPECT_EQ(index, 1u);
}

TEST(FieldReader, RotationsAreAnAxisWithDegreesOrFourNumbers) {
    Quat rotation{0, 0, 0, 1};
    const auto read = [&](FieldReader& reader) { reader.rotation("turn", rotation); };
    EXPECT_EQ(refusal(R"("turn": [0, 0, 0])", read),
              "turn: must be four numbers [x, y, z, w] or {\"axis\": [x, y, z], \"degrees\": angle}");
    EXPECT_EQ(refusal(R"("turn": [0, 0, 0, 0])", read), "turn: must not be zero: no rotation is [0, 0, 0, 1]");
    EXPECT_EQ(refusal(R"("turn": [0, "1", 0, 0])", read), "turn[1]: must be a number, got text");
    EXPECT_EQ(refusal(R"("turn": {"degrees": 90})", read),
              "turn.axis: is missing: the axis of the rotation, [x, y, z]");
    EXPECT_EQ(refusal(R"("turn": {"axis": [0, 1, 0]})", read), "turn.degrees: is missing: the angle of the rotation");
    EXPECT_EQ(refusal(R"("turn": {"axis": [0, 0, 0], "degrees": 90})", read), "turn.axis: must not be zero");
    EXPECT_EQ(refusal(R"("turn": {"axis": [0, 1], "degrees": 90})", read),
              "turn.axis: must be three numbers [x, y, z]");
    EXPECT_EQ(refusal(R"("turn": {"axis": [0, 1, 0], "degrees": 90, "radians": 1})", read),
              "turn.radians: is not a field here (fields here: axis, degrees)");
    EXPECT_EQ(rotation, (Quat{0, 0, 0, 1})) << "what is refused changes nothing";
    // The same quarter turn, by an axis of any length and by angles that differ by whole turns.
    for (const char* quarter : {R"({"axis": [0, 1, 0], "degrees": 90})", R"({"axis": [0, 1e300, 0], "degrees": 90})",
                                R"({"axis": [0, 1e-300, 0], "degrees": 810})", "[0, 1, 0, 1]", "[0, 5, 0, 5]"}) {
        rotation = {};
        EXPECT_EQ(refusal(std::string("\"turn\": ") + quarter, read), "") << quarter;
        EXPECT_LT(length(rotate(rotation, {0, 0, 1}) - Vec3{1, 0, 0}), 1e-12) << quarter;
        EXPECT_NEAR(dot(rotation, rotation), 1, 1e-12) << quarter;
    }
}

TEST(FieldReader, PlacesHaveAPositionAndARotation) {
    Transform place{{1, 2, 3}, {0, 0, 0, 1}};
    const auto read = [&](FieldReader& reader) { reader.transform("pose", place); };
    EXPECT_EQ(refusal(R"("pose": [])", read), "pose: must be an object {…}, got a list");
    EXPECT_EQ(refusal(R"("pose": {"position": [1, 2, 3, 4]})", read), "pose.position: must be three numbers [x, y, z]");
    EXPECT_EQ(refusal(R"("pose": {"position": [9, 9, 9], "rotation": 1})", read),
              "pose.rotation: must be four numbers [x, y, z, w] or {\"axis\": [x, y, z], \"degrees\": angle}");
    EXPECT_EQ(refusal(R"("pose": {"postion": [9, 9, 9]})", read),
              "pose.postion: is not a field here (did you mean \"position\"?)");
    EXPECT_EQ(place.position, (Vec3{1, 2, 3})) << "nothing of one that is wrong is taken";
    EXPECT_EQ(refusal(R"("pose": {"position": [4, 5, 6]})", read), "");
    EXPECT_EQ(place.position, (Vec3{4, 5, 6}));
    std::optional<Vec3> maybe;
    EXPECT_EQ(refusal(R"("at": [1, 2, null])", [&](FieldReader& reader) { reader.vector("at", maybe); }),
              "at[2]: must be a number, got nothing (null)");
    EXPECT_FALSE(maybe.has_value());
    EXPECT_EQ(refusal(R"("at": [1, 2, 3])", [&](FieldReader& reader) { reader.vector("at", maybe); }), "");
    EXPECT_EQ(maybe, (Vec3{1, 2, 3}));
}

// A wrong field leaves the value unchanged, and the first error stays.
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
