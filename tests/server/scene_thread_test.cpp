// SPDX-License-Identifier: MIT
#include "server/scene_thread_fixture.h"

namespace embody::server {
namespace {

using nlohmann::json;

TEST_F(SceneThreadTest, WhatIsNoCommandIsRefused) {
    for (const char* message : {"", "{", "[]", "null", "\xff", R"({"id": "a", "command": "hello"})",
                                R"({"id": 1e400, "command": "hello"})", R"({"id": 1})"})
        EXPECT_EQ(ask(message).at("ok"), false) << message;
    EXPECT_EQ(ask(R"({"id": 1, "command": "hello", "haste": 1})").at("error").at("where"), "haste");
    EXPECT_EQ(ask(R"({"id": 7, "command": "hello", "params": [1]})").at("error").at("where"), "params");
}

// Copying or freeing such a value walks a level of the stack for each bracket.
TEST_F(SceneThreadTest, AMillionBracketsAreRefusedAndTheServerGoesOn) {
    const std::string open(1'000'000, '['), close(1'000'000, ']');
    for (const std::string& value : {open, open + close}) {
        const json reply = ask(R"({"id": 1, "command": "scene.load", "params": {"scene": )" + value + "}}");
        EXPECT_EQ(reply.at("ok"), false);
        EXPECT_NE(reply.at("error").at("why").get<std::string>().find("64"), std::string::npos);
    }
    EXPECT_EQ(ask(R"({"id": 2, "command": "hello"})").at("ok"), true);
    EXPECT_EQ(
        ask(R"({"id": 3, "command": "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})").at("id"),
        3)
        << "brackets in a text nest nothing";
}

}  // namespace
}  // namespace embody::server
