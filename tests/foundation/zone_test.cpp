// SPDX-License-Identifier: MIT
#include "foundation/zone.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "foundation/task_pool.h"

namespace embody {
namespace {

struct Taken {
    std::string name, thread;
    std::uint32_t number;
    ZoneClock::time_point begin, end;
};

std::vector<Taken> taken_from(ZoneRecording& recording) {
    std::vector<Taken> all;
    recording.take([&](const ZoneThread& thread, const ZoneRecord& zone) {
        all.push_back({zone.name, thread.name, thread.number, zone.begin, zone.end});
    });
    return all;
}

TEST(Zones, AreRecordedOnlyDuringARecording) {
    { EMBODY_ZONE("before"); }
    ZoneRecording recording;
    EXPECT_TRUE(taken_from(recording).empty());
    EXPECT_EQ(recording.dropped(), 0u);
}

TEST(Zones, LieWithinEachOtherAndCarryTheirNames) {
    ZoneRecording recording;
    {
        EMBODY_ZONE("outer");
        { EMBODY_ZONE("first"); }
        EXPECT_STREQ(innermost_zone(), "outer");
        { EMBODY_ZONE("second"); }
    }
    EXPECT_EQ(innermost_zone(), nullptr);
    const std::vector<Taken> all = taken_from(recording);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].name, "first");
    EXPECT_EQ(all[1].name, "second");
    EXPECT_EQ(all[2].name, "outer");
    EXPECT_LE(recording.start(), all[2].begin);
    EXPECT_LE(all[2].begin, all[0].begin);
    EXPECT_LE(all[0].begin, all[0].end);
    EXPECT_LE(all[0].end, all[1].begin);
    EXPECT_LE(all[1].end, all[2].end);
    EXPECT_TRUE(taken_from(recording).empty());
}

TEST(Zones, ATimedZoneTellsItsLengthWithAndWithoutARecording) {
    TimedZone unrecorded("timed");
    EXPECT_GE(unrecorded.finish(), 0);
    ZoneRecording recording;
    TimedZone zone("timed");
    const double milliseconds = zone.finish();
    const std::vector<Taken> all = taken_from(recording);
    ASSERT_EQ(all.size(), 1u);
    const std::chrono::duration<double, std::milli> recorded = all[0].end - all[0].begin;
    EXPECT_DOUBLE_EQ(milliseconds, recorded.count());
}

TEST(Zones, WhatBeganBeforeTheRecordingIsNotInIt) {
    auto first = std::make_unique<ZoneRecording>();
    auto zone = std::make_unique<Zone>("long");
    first.reset();
    ZoneRecording second;
    zone.reset();
    EXPECT_TRUE(taken_from(second).empty());
}

TEST(Zones, BeyondTheCapacityAreDroppedAndCounted) {
    constexpr std::size_t room = 8;
    ZoneRecording recording(room);
    for (int i = 0; i < 20; ++i) {
        EMBODY_ZONE("many");
    }
    EXPECT_EQ(recording.dropped(), 12u);
    EXPECT_EQ(taken_from(recording).size(), room);
    { EMBODY_ZONE("again"); }
    EXPECT_EQ(taken_from(recording).size(), 1u);
    EXPECT_EQ(recording.dropped(), 12u);
}

// The zone in which a task runs is recorded on the track of every worker.
TEST(Zones, WorkersHaveTracksOfTheirOwn) {
    constexpr int workers = 3, rounds = 50;
    ZoneRecording recording;
    TaskPool pool(workers);
    for (int i = 0; i < rounds; ++i) {
        EMBODY_ZONE("shared");
        pool.run([](int) { EMBODY_ZONE("part"); });
    }
    std::map<std::string, std::map<std::string, int>> count;
    for (const Taken& zone : taken_from(recording)) ++count[zone.thread][zone.name];
    ASSERT_EQ(count.size(), 3u);
    for (const auto& [thread, zones] : count) {
        EXPECT_EQ(zones.at("shared"), rounds) << thread;
        EXPECT_EQ(zones.at("part"), rounds) << thread;
    }
    EXPECT_TRUE(count.contains("worker 1"));
    EXPECT_TRUE(count.contains("worker 2"));
}

// Threads write while another thread takes: each zone is either taken once or counted as dropped.
TEST(Zones, AreTakenWhileThreadsGoOn) {
    constexpr int threads = 3, zones = 20000;
    ZoneRecording recording(64);
    std::atomic<int> running{threads};
    std::vector<std::thread> all;
    for (int i = 0; i < threads; ++i) {
        all.emplace_back([&] {
            for (int k = 0; k < zones; ++k) {
                EMBODY_ZONE("busy");
            }
            --running;
        });
    }
    std::uint64_t count = 0;
    const auto take = [&] {
        recording.take([&](const ZoneThread&, const ZoneRecord& zone) {
            ASSERT_STREQ(zone.name, "busy");
            ASSERT_LE(zone.begin, zone.end);
            ++count;
        });
    };
    while (running > 0) take();
    for (std::thread& thread : all) thread.join();
    take();
    EXPECT_EQ(count + recording.dropped(), static_cast<std::uint64_t>(threads) * zones);
}

}  // namespace
}  // namespace embody
