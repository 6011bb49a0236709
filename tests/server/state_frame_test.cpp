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
    const std::string frame = board.frame_since(0).bytes;
    ASSERT_EQ(frame.size(), 32u + 36u);
    EXPECT_EQ(frame.substr(0, 4), "EMBF");
    EXPECT_EQ(read<std::uint16_t>(frame, 4), 2);
    EXPECT_EQ(read<std::uint32_t>(frame, 8), 1u);
    EXPECT_EQ(read<double>(frame, 16), 0.25);
    EXPECT_EQ(read<std::uint64_t>(frame, 24), 15u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32), 7u);
    EXPECT_EQ(read<float>(frame, 36), 1.5f);
    EXPECT_EQ(read<float>(frame, 32 + 28), 1.0f);  // w
    EXPECT_EQ(read<std::uint8_t>(frame, 32 + 32), 2);
}

TEST(StateFrame, AFrameWithoutNewsIsEmpty) {
    StateBoard board;
    EXPECT_EQ(board.frame_since(0).bytes, "");
    board.publish({entity(1, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 0, 0)}, 0.1, 1, false);
    EXPECT_EQ(board.frame_since(seen).bytes, "");
}

TEST(StateFrame, ASlowClientGetsEveryChangeOfTheFramesItMissed) {
    StateBoard board;
    board.publish({entity(1, 0, 0), entity(2, 0, 0), entity(3, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 1, 0), entity(2, 0, 0), entity(3, 0, 0)}, 0.1, 1, false);
    board.publish({entity(1, 1, 0), entity(2, 5, 0), entity(3, 0, 0)}, 0.2, 2, false);
    const std::string frame = board.frame_since(seen).bytes;
    ASSERT_EQ(read<std::uint32_t>(frame, 8), 2u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32), 1u);
    EXPECT_EQ(read<std::uint32_t>(frame, 32 + 36), 2u);
}

TEST(StateFrame, AResetSendsEverything) {
    StateBoard board;
    board.publish({entity(1, 0, 0), entity(2, 0, 0)}, 0, 0, false);
    const std::uint64_t seen = board.version();
    board.publish({entity(1, 0, 0), entity(2, 0, 0)}, 0, 0, true);
    EXPECT_EQ(read<std::uint32_t>(board.frame_since(seen).bytes, 8), 2u);
}

/// Points whose positions the test sets.
struct SamplePoints final : scene::ShownPoints {
    std::vector<Vec3> at;
    void read(std::vector<Vec3>& positions) const override { positions = at; }
    [[nodiscard]] double radius() const override { return 0.01; }
};

scene::EntityState pointed(scene::EntityIndex index, const SamplePoints& points, std::uint8_t state) {
    scene::EntityState made = entity(index, 0, state);
    made.points = &points;
    return made;
}

TEST(PointSets, HaveTheLayoutOfTheProtocolAndLoseLessThanAStep) {
    SamplePoints points;
    points.at = {{-1, 0.5, 2}, {1, 0.75, 2}, {0.3, 0.6, 2}};
    StateBoard board;
    board.publish({pointed(9, points, 0)}, 0, 0, false);
    const std::string frame = board.frame_since(0).bytes;
    const std::size_t set = 32 + 36;
    ASSERT_EQ(frame.size(), set + 40 + 3 * 6 + 2);
    EXPECT_EQ(read<std::uint32_t>(frame, 12), 1u);
    EXPECT_EQ(read<std::uint8_t>(frame, 32 + 33), 1);
    EXPECT_EQ(read<std::uint32_t>(frame, set), 9u);
    EXPECT_EQ(read<std::uint32_t>(frame, set + 4), 3u);
    EXPECT_FLOAT_EQ(read<float>(frame, set + 32), 0.01f);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float lower = read<float>(frame, set + 8 + 4 * axis), size = read<float>(frame, set + 20 + 4 * axis);
            const double q = read<std::uint16_t>(frame, set + 40 + 6 * i + 2 * axis) / 65535.0;
            EXPECT_NEAR(lower + q * size, points.at[i][static_cast<int>(axis)], 2.0 / 65535);
        }
    }
}

TEST(PointSets, AreSentAfterMovesAndToClientsThatConnectLater) {
    SamplePoints points;
    points.at = {{0, 0, 0}, {1, 1, 1}};
    StateBoard board;
    board.publish({pointed(1, points, 0)}, 0, 0, false);
    std::uint64_t seen = board.version();
    board.publish({pointed(1, points, 0)}, 0.1, 1, false);
    EXPECT_EQ(board.frame_since(seen).bytes, "");
    points.at[1].x = 1.5;
    board.publish({pointed(1, points, 0)}, 0.2, 2, false);
    const std::string moved = board.frame_since(seen).bytes;
    EXPECT_EQ(read<std::uint32_t>(moved, 8), 0u);
    EXPECT_EQ(read<std::uint32_t>(moved, 12), 1u);

    // Asleep: one last frame with the new state, then nothing.
    seen = board.version();
    board.publish({pointed(1, points, 2)}, 0.3, 3, false);
    EXPECT_EQ(read<std::uint32_t>(board.frame_since(seen).bytes, 12), 0u);
    seen = board.version();
    board.publish({pointed(1, points, 2)}, 0.4, 4, false);
    EXPECT_EQ(board.frame_since(seen).bytes, "");
    EXPECT_EQ(read<std::uint32_t>(board.frame_since(0).bytes, 12), 1u);

    // The entity is one body again.
    board.publish({entity(1, 0, 2)}, 0.5, 5, false);
    const std::string solid = board.frame_since(seen).bytes;
    EXPECT_EQ(read<std::uint32_t>(solid, 12), 0u);
    EXPECT_EQ(read<std::uint8_t>(solid, 32 + 33), 0);
}

TEST(PointSets, OfFiveThousandGrainsTakeThirtyKilobytesAFrame) {
    SamplePoints points;
    points.at.resize(5000, {1, 2, 3});
    StateBoard board;
    board.publish({pointed(1, points, 0)}, 0, 0, false);
    EXPECT_EQ(board.frame_since(0).bytes.size(), 32u + 36 + 40 + 30000);
}

}  // namespace
}  // namespace embody::server
