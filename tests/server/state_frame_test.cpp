// SPDX-License-Identifier: MIT
#include "server/state_frame.h"

#include <gtest/gtest.h>

#include <cstring>

namespace embody::server {
namespace {

template <class T>
T read(const std::string& frame, std::size_t offset) {
    T value{};
    std::memcpy(&value, frame.data() + offset, sizeof(T));
    return value;
}

scene::EntityState entity(scene::EntityIndex index, double x, std::uint8_t state) {
    scene::EntityState made;
    made.entity = index;
    made.pose.position = {x, 2, 3};
    made.state = state;
    return made;
}

TEST(StateFrame, HasTheLayoutOfTheProtocol) {
    StateBoard board;
    board.publish({entity(7, 1.5, 2)}, 0.25, 15, false);
    const std::string frame = board.frame_since(0);
    ASSERT_EQ(frame.size(), 32u + 36u);
    EXPECT_EQ(frame.substr(0, 4), "EMBF");
    EXPECT_EQ(read<std::uint16_t>(frame, 4), 1);
    EXPECT_EQ(read<std::uint32_t>(frame, 8), 1u);
    EXPECT_EQ(read<double>(frame, 16), 0.25);
    EXPECT_EQ(read<std::uint64_t>(frame, 24), 15u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32), 7u);
    EXPECT_EQ(read<float>(frame, 36), 1.5f);
    EXPECT_EQ(read<float>(frame, 32 + 28), 1.0f);  // w
    EXPECT_EQ(read<std::uint8_t>(frame, 32 + 32), 2);
}

TEST(StateFrame, NothingNewIsNoFrame) {
    StateBoard board;
    EXPECT_EQ(board.frame_since(0), "");
    board.publish({entity(1, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 0, 0)}, 0.1, 1, false);
    EXPECT_EQ(board.frame_since(seen), "");
}

TEST(StateFrame, ASlowClientGetsEveryChangeOfTheFramesItMissed) {
    StateBoard board;
    board.publish({entity(1, 0, 0), entity(2, 0, 0), entity(3, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 1, 0), entity(2, 0, 0), entity(3, 0, 0)}, 0.1, 1, false);
    board.publish({entity(1, 1, 0), entity(2, 5, 0), entity(3, 0, 0)}, 0.2, 2, false);
    const std::string frame = board.frame_since(seen);
    ASSERT_EQ(read<std::uint32_t>(frame, 8), 2u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32), 1u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32 + 36), 2u);
}

TEST(StateFrame, AResetSendsEverything) {
    StateBoard board;
    board.publish({entity(1, 0, 0), entity(2, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 0, 0), entity(2, 0, 0)}, 0, 0, true);
    EXPECT_EQ(read<std::uint32_t>(board.frame_since(seen), 8), 2u);
}

}  // namespace
}  // namespace embody::server
