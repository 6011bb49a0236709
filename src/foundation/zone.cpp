// SPDX-License-Identifier: MIT
#include "foundation/zone.h"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "foundation/assert.h"

namespace embody {

namespace {

// The zones of one thread that were not yet taken: a ring that its thread fills and the recording empties.
struct ThreadZones {
    ThreadZones(ZoneThread which, std::size_t room) : thread(std::move(which)), ring(room) {}

    void add(const ZoneRecord& zone) {
        const std::size_t at = filled.load(std::memory_order_relaxed);
        if (at - taken.load(std::memory_order_acquire) == ring.size()) {
            dropped.fetch_add(1, std::memory_order_relaxed);
            return;
        }
        ring[at % ring.size()] = zone;
        filled.store(at + 1, std::memory_order_release);
    }

    const ZoneThread thread;
    std::vector<ZoneRecord> ring;
    std::atomic<std::size_t> filled{0}, taken{0};  // zones so far
    std::atomic<std::uint64_t> dropped{0};
};

// The present recording. Threads keep their own ThreadZones by a shared pointer, so that either may end first.
struct Registry {
    std::mutex mutex;
    std::vector<std::shared_ptr<ThreadZones>> threads;
    std::uint64_t recording = 0;  // number of the present or last one
    std::size_t room = 0;         // zones of a thread
};

Registry& registry() {
    static Registry only;
    return only;
}

std::atomic<std::uint64_t> present_recording{0};  // Registry::recording, for a look without the mutex

struct ThisThread {
    std::string name;
    const char* innermost = nullptr;
    std::shared_ptr<ThreadZones> zones;
    std::uint64_t recording = 0;  // that `zones` belongs to
};

ThisThread& this_thread() {
    thread_local ThisThread only;
    return only;
}

void join_recording(ThisThread& thread) {
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    const auto number = static_cast<std::uint32_t>(all.threads.size() + 1);
    const std::string name = thread.name.empty() ? "thread " + std::to_string(number) : thread.name;
    thread.zones = std::make_shared<ThreadZones>(ZoneThread{number, name}, all.room);
    thread.recording = all.recording;
    all.threads.push_back(thread.zones);
}

}  // namespace

ZoneRecording::ZoneRecording(std::size_t zones_of_thread) {
    EMBODY_ASSERT(zones_of_thread > 0);
    Registry& all = registry();
    {
        const std::lock_guard lock(all.mutex);
        all.threads.clear();
        all.room = zones_of_thread;
        present_recording.store(++all.recording, std::memory_order_relaxed);
    }
    start_ = ZoneClock::now();
    zone_details::is_recorded.store(true, std::memory_order_release);
}

ZoneRecording::~ZoneRecording() {
    zone_details::is_recorded.store(false, std::memory_order_relaxed);
    const std::lock_guard lock(registry().mutex);
    registry().threads.clear();
}

void ZoneRecording::take(const std::function<void(const ZoneThread&, const ZoneRecord&)>& visit) {
    std::vector<std::shared_ptr<ThreadZones>> threads;
    {
        const std::lock_guard lock(registry().mutex);
        threads = registry().threads;
    }
    for (const std::shared_ptr<ThreadZones>& zones : threads) {
        const std::size_t last = zones->filled.load(std::memory_order_acquire);
        for (std::size_t i = zones->taken.load(std::memory_order_relaxed); i != last; ++i) {
            const ZoneRecord& zone = zones->ring[i % zones->ring.size()];
            // A zone that began before the recording is left out.
            if (zone.begin >= start_) visit(zones->thread, zone);
        }
        zones->taken.store(last, std::memory_order_release);
    }
}

std::uint64_t ZoneRecording::dropped() const {
    std::uint64_t sum = 0;
    const std::lock_guard lock(registry().mutex);
    for (const std::shared_ptr<ThreadZones>& zones : registry().threads)
        sum += zones->dropped.load(std::memory_order_relaxed);
    return sum;
}

void name_zone_thread(std::string name) { this_thread().name = std::move(name); }

const char* innermost_zone() {
    return zone_details::is_recorded.load(std::memory_order_relaxed) ? this_thread().innermost : nullptr;
}

const char* zone_details::enter(const char* name) { return std::exchange(this_thread().innermost, name); }

void zone_details::leave(const char* outer, const ZoneRecord& zone) {
    ThisThread& thread = this_thread();
    thread.innermost = outer;
    if (!is_recorded.load(std::memory_order_acquire)) return;
    if (thread.recording != present_recording.load(std::memory_order_relaxed)) join_recording(thread);
    thread.zones->add(zone);
}

void Zone::begin(const char* name) {
    name_ = name;
    outer_ = zone_details::enter(name);
    begin_ = ZoneClock::now();
}

void Zone::end() const { zone_details::leave(outer_, {name_, begin_, ZoneClock::now()}); }

TimedZone::TimedZone(const char* name) {
    if (zone_details::is_recorded.load(std::memory_order_relaxed)) {
        outer_ = zone_details::enter(name);
        zone_.name = name;
    }
    zone_.begin = ZoneClock::now();
}

double TimedZone::finish() {
    zone_.end = ZoneClock::now();
    if (zone_.name) zone_details::leave(outer_, zone_);
    return std::chrono::duration<double, std::milli>(zone_.end - zone_.begin).count();
}

}  // namespace embody
