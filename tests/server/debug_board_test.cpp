// SPDX-License-Identifier: MIT
#include "server/debug_board.h"

#include <chrono>
#include <cstring>
#include <map>
#include <thread>

#include "server/scene_thread_fixture.h"

namespace embody::server {
namespace {

using nlohmann::json;

/// A debug frame, decoded according to docs/protocol.md.
struct Read {
    std::uint32_t flags = 0, lines_left_out = 0, points_left_out = 0;
    double time = 0;
    std::map<int, std::size_t> lines, points;  ///< by meaning

    explicit Read(const std::string& bytes) {
        std::size_t at = 0;
        const auto take = [&](auto& number) {
            std::memcpy(&number, bytes.data() + at, sizeof(number));
            at += sizeof(number);
        };
        std::uint32_t magic = 0, batches = 0;
        std::uint16_t version = 0, zero = 0;
        take(magic), take(version), take(zero), take(flags), take(batches), take(lines_left_out), take(points_left_out),
            take(time);
        EXPECT_EQ(magic, 0x44424D45u);
        EXPECT_EQ(bytes.substr(0, 4), "EMBD");
        EXPECT_EQ(version, 1);
        EXPECT_EQ(at, 32u);
        for (std::uint32_t i = 0; i < batches; ++i) {
            std::uint8_t meaning = 0, dim = 0;
            std::uint16_t number = 0;
            std::uint32_t line_count = 0, point_count = 0;
            take(meaning), take(dim), take(number), take(line_count), take(point_count);
            lines[meaning] += line_count;
            points[meaning] += point_count;
            at += 24 * std::size_t{line_count} + 12 * std::size_t{point_count};
        }
        EXPECT_EQ(at, bytes.size());
    }
};

class DebugFrames : public SceneThreadTest {
protected:
    void SetUp() override {
        const json box = {{"type", "box"}, {"half_extents", {0.5, 0.5, 0.5}}};
        run("entity.add", {{"entity", {{"shape", box}, {"pose", {{"position", {0, 0.5, 0}}}}}}});
    }
    std::shared_ptr<const std::string> frame(ClientId client = 1) {
        // The frame follows the reply.
        for (int i = 0; i < 1000; ++i) {
            if (auto found = thread_->take_debug_frame(client)) return found;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return nullptr;
    }
};

TEST_F(DebugFrames, GoToClientsThatAskedAndContainWhatTheyAskedFor) {
    run("simulation.step", {{"count", 3}});
    EXPECT_EQ(thread_->take_debug_frame(1), nullptr);
    run("debug.draw", {{"show", {"shapes", "contacts"}}});
    const auto bytes = frame();
    ASSERT_TRUE(bytes);
    const Read read(*bytes);
    EXPECT_EQ(read.flags, 1u | 4u);
    EXPECT_NEAR(read.time, 3.0 / 60, 1e-12);
    // The new scene's floor is a box, too; the other box rests on four contact points and is slow.
    EXPECT_EQ(read.lines, (std::map<int, std::size_t>{{0, 12}, {3, 12}, {6, 0}, {7, 4}}));
    EXPECT_EQ(read.points, (std::map<int, std::size_t>{{0, 0}, {3, 0}, {6, 4}, {7, 0}}));
    EXPECT_EQ(read.lines_left_out + read.points_left_out, 0u);
    EXPECT_EQ(thread_->take_debug_frame(2), nullptr);
}

TEST_F(DebugFrames, BelongToOneClientAndEndWhenItSaysSoOrLeaves) {
    run("debug.draw", {{"show", {"bounds"}}}, 1);
    run("debug.draw", {{"show", {"masses"}}}, 2);
    EXPECT_EQ(Read(*frame(1)).flags, 2u);
    EXPECT_EQ(Read(*frame(2)).flags, 64u);
    run("debug.draw", {{"show", json::array()}}, 1);
    thread_->forget(2);
    run("simulation.step", {{"count", 1}});
    run("simulation.step", {{"count", 1}});
    EXPECT_EQ(thread_->take_debug_frame(1), nullptr);
    EXPECT_EQ(thread_->take_debug_frame(2), nullptr);
}

TEST_F(DebugFrames, RefuseWhatIsUnknownByName) {
    EXPECT_EQ(error_of("debug.draw", {{"show", {"shapes", "souls"}}}), "show[1]: is nothing that can be shown");
    EXPECT_EQ(error_of("debug.draw", {{"show", "shapes"}}), "show: must be a list of names");
    EXPECT_EQ(error_of("debug.draw", {{"show", {"shapes"}}, {"colour", 1}}), "colour: is no parameter of debug.draw");
    EXPECT_EQ(error_of("debug.draw", {{"show", {3}}}), "show[0]: is nothing that can be shown");
}

}  // namespace
}  // namespace embody::server
