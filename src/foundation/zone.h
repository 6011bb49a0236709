// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace embody {

using ZoneClock = std::chrono::steady_clock;

/// A named interval of time on one thread. Zones of a thread are nested or follow each other.
struct ZoneRecord {
    const char* name = nullptr;
    ZoneClock::time_point begin, end;
};

/// The thread of a zone. Numbers are given as threads begin their first recorded zone, from 1.
struct ZoneThread {
    std::uint32_t number = 0;
    std::string name;
};

/// Records the zones of all threads while it lives; one at a time in a program. Its memory is bounded: for each thread
/// it holds a given number of zones, and zones that end while it is full are dropped and counted.
class ZoneRecording {
public:
    explicit ZoneRecording(std::size_t zones_of_thread = std::size_t{1} << 14);
    ~ZoneRecording();
    ZoneRecording(const ZoneRecording&) = delete;
    ZoneRecording& operator=(const ZoneRecording&) = delete;

    /// Returns the zones that ended since the last call, thread by thread, each thread's in the order of their ends,
    /// and frees their room. Other threads may go on meanwhile; one caller at a time.
    void take(const std::function<void(const ZoneThread&, const ZoneRecord&)>& visit);
    /// Zones that ended while there was no room, so far.
    [[nodiscard]] std::uint64_t dropped() const;
    [[nodiscard]] ZoneClock::time_point start() const { return start_; }

private:
    ZoneClock::time_point start_;
};

/// Sets the name under which the zones of this thread are shown; call before its first zone.
void name_zone_thread(std::string name);
/// Name of the innermost zone that this thread is in; nullptr where it is in none, or nothing is recorded.
const char* innermost_zone();

namespace zone_details {
inline std::atomic<bool> is_recorded{false};
/// Makes `name` the innermost zone; returns the one before.
const char* enter(const char* name);
void leave(const char* outer, const ZoneRecord& zone);
}  // namespace zone_details

/// From here to the end of the block; `name` must outlive the recording. Costs one relaxed load while nothing is
/// recorded. A nullptr is no zone.
class Zone {
public:
    explicit Zone(const char* name) {
        if (zone_details::is_recorded.load(std::memory_order_relaxed) && name) begin(name);
    }
    ~Zone() {
        if (name_) end();
    }
    Zone(const Zone&) = delete;
    Zone& operator=(const Zone&) = delete;

private:
    void begin(const char* name);
    void end() const;
    const char* name_ = nullptr;  // nullptr: not recorded
    const char* outer_ = nullptr;
    ZoneClock::time_point begin_;
};

/// A zone that also measures its time: reads the clock whether zones are recorded or not, and once for both.
class TimedZone {
public:
    explicit TimedZone(const char* name);
    /// Ends the zone; to be called once. Returns its length, ms.
    double finish();

private:
    ZoneRecord zone_;  // without a name: not recorded
    const char* outer_ = nullptr;
};

}  // namespace embody

#define EMBODY_ZONE_JOINED(a, b) a##b
#define EMBODY_ZONE_VARIABLE(line) EMBODY_ZONE_JOINED(embody_zone_, line)
/// A zone from here to the end of the block; the name is a string literal.
#define EMBODY_ZONE(name) const ::embody::Zone EMBODY_ZONE_VARIABLE(__LINE__)("" name)
