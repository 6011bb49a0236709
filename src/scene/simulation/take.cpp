// SPDX-License-Identifier: MIT
#include "scene/simulation/take.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "foundation/assert.h"
#include "scene/simulation/take_numbers.h"

namespace embody::scene {

namespace {

constexpr double samples_per_second = 60;
/// Differences of a chunk, bytes, and how many times its beginning they are at least when it ends.
constexpr std::size_t min_differences = 1 << 20, differences_per_beginning = 4;
/// Half a nanosecond: the clock is a sum of steps.
constexpr double rounding = 5e-10;
/// A chunk is at most this part of the ring.
constexpr std::size_t chunks_per_ring = 8;

// Where points come to by their steps; null where they have none.
RecordedPoints::Places led_on(const RecordedPoints::Places& points, const RecordedPoints::Places& steps) {
    if (!steps) return nullptr;
    auto to = std::make_shared<std::vector<std::int32_t>>(*points);
    for (std::size_t i = 0; i < to->size(); ++i) (*to)[i] += (*steps)[i];
    return to;
}

}  // namespace

std::size_t RecordedPoints::count() const { return from_->size() / 3; }

void RecordedPoints::read(std::vector<Vec3>& positions) const {
    positions.clear();
    positions.reserve(from_->size() / 3);
    const bool is_between = to_ && to_->size() == from_->size();
    for (std::size_t i = 0; i + 2 < from_->size(); i += 3) {
        const auto coordinate = [&](std::size_t k) {
            const double from = (*from_)[i + k];
            return (is_between ? from + part_ * ((*to_)[i + k] - from) : from) / units_per_metre;
        };
        positions.emplace_back(coordinate(0), coordinate(1), coordinate(2));
    }
}

// Samples
// --------------------------------------------------------------------------------------------------------------

void Take::begin_chunk() {
    if (!chunks_.empty()) {
        chunks_.back().data.shrink_to_fit();
        closed_bytes_ += chunks_.back().bytes();
    }
    chunks_.emplace_back().number = number_;
    is_open_ = true;
}

void Take::drop_oldest() {
    while (chunks_.size() > 1 && bytes() > max_bytes_) {
        closed_bytes_ -= chunks_.front().bytes();
        if (cursor_.chunk == &chunks_.front()) cursor_ = {};
        chunks_.pop_front();
    }
}

void Take::sample(const Simulation& simulation) {
    const double before = end();
    if (!is_open_) begin_chunk();
    Chunk& chunk = chunks_.back();
    const bool is_first = chunk.samples.empty();
    const physics::StepReport& report = simulation.world().last_report();
    chunk.samples.push_back({report.time, report.step, chunk.data.size()});

    // Removed: a number and the indices. Changed: until an index difference of 0.
    std::vector<EntityIndex> removed;
    std::string changed;
    EntityIndex last = 0;
    auto known = tracks_.begin();
    const auto skip_removed = [&](EntityIndex next) {
        while (known != tracks_.end() && known->first < next) {
            removed.push_back(known->first);
            known = tracks_.erase(known);
        }
    };
    simulation.visit([&](const EntityMotion& motion) {
        skip_removed(motion.entity);
        const bool is_known = known != tracks_.end() && known->first == motion.entity;
        Track track =
            quantised(motion, is_known ? &known->second : nullptr, number_, chunk.samples.back().time - before);
        if (is_known && is_same(track, known->second)) {
            // At rest since the last sample.
            known->second.point_steps = nullptr;
            if (is_first) {
                known->second.steps = {};
                write_unsigned(changed, motion.entity - std::exchange(last, motion.entity));
                write(changed, known->second, nullptr, number_);
                known->second.written = number_;
            }
            ++known;
            return;
        }
        write_unsigned(changed, motion.entity - std::exchange(last, motion.entity));
        write(changed, track, is_known && !is_first ? &known->second : nullptr, number_);
        if (is_known)
            known->second = std::move(track);
        else
            known = tracks_.emplace_hint(known, motion.entity, std::move(track));
        ++known;
    });
    skip_removed(~EntityIndex{0});
    if (is_first) removed.clear();
    write_unsigned(chunk.data, removed.size());
    for (const EntityIndex index : removed) write_unsigned(chunk.data, index);
    chunk.data += changed;
    write_unsigned(chunk.data, 0);
    ++number_;

    if (is_first) chunk.beginning = chunk.data.size();
    const std::size_t differences = chunk.data.size() - chunk.beginning;
    const bool is_long = differences > std::max(min_differences, differences_per_beginning * chunk.beginning);
    if (is_long || chunk.bytes() > max_bytes_ / chunks_per_ring) is_open_ = false;
    drop_oldest();
}

void Take::add_now(const Simulation& simulation) {
    if (!empty() && chunks_.back().samples.back().step == simulation.world().last_report().step) return;
    sample(simulation);
}

void Take::add(const Simulation& simulation) {
    if (!empty()) {
        const double step = simulation.world().settings().time_step;
        const auto steps = std::max<std::int64_t>(1, std::llround(1 / (samples_per_second * step)));
        if (simulation.world().last_report().step <
            chunks_.back().samples.back().step + static_cast<std::uint64_t>(steps))
            return;
    }
    sample(simulation);
}

// Reading
// --------------------------------------------------------------------------------------------------------------

double Take::start() const { return empty() ? 0 : chunks_.front().samples.front().time; }
double Take::end() const { return empty() ? 0 : chunks_.back().samples.back().time; }
std::size_t Take::bytes() const { return empty() ? 0 : closed_bytes_ + chunks_.back().bytes(); }

std::size_t Take::samples() const {
    std::size_t count = 0;
    for (const Chunk& chunk : chunks_) count += chunk.samples.size();
    return count;
}

std::vector<double> Take::times() const {
    std::vector<double> times;
    for (const Chunk& chunk : chunks_)
        for (const Sample& sample : chunk.samples) times.push_back(sample.time);
    return times;
}

Take::Changes Take::decode(const Chunk& chunk, std::size_t sample, const Tracks& tracks) {
    Changes changes;
    const char* at = chunk.data.data() + chunk.samples[sample].at;
    changes.removed.resize(read_unsigned(at));
    for (EntityIndex& index : changes.removed) index = static_cast<EntityIndex>(read_unsigned(at));
    EntityIndex index = 0;
    while (const std::uint64_t difference = read_unsigned(at)) {
        index += static_cast<EntityIndex>(difference);
        const auto known = tracks.find(index);
        changes.written.emplace_back(index,
                                     read(at, known == tracks.end() ? nullptr : &known->second, chunk.number + sample));
    }
    return changes;
}

void Take::apply(Tracks& tracks, Changes changes) {
    for (const EntityIndex index : changes.removed) tracks.erase(index);
    for (auto& [index, track] : changes.written) tracks.insert_or_assign(index, std::move(track));
}

void Take::place_cursor(double time) const {
    const auto is_after = [&](const auto& sample) { return sample.time > time + rounding; };
    auto chunk = std::ranges::find_if(chunks_, [&](const Chunk& each) { return is_after(each.samples.front()); });
    if (chunk != chunks_.begin()) --chunk;
    const auto after = std::ranges::find_if(chunk->samples, is_after);
    const auto sample = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - chunk->samples.begin()) - 1);
    if (cursor_.chunk != &*chunk || sample < cursor_.sample) {
        cursor_ = {&*chunk, 0, {}, {}};
        apply(cursor_.tracks, decode(*chunk, 0, cursor_.tracks));
    }
    while (cursor_.sample < sample) {
        Changes next = cursor_.next ? std::move(*cursor_.next) : decode(*chunk, cursor_.sample + 1, cursor_.tracks);
        cursor_.next.reset();
        apply(cursor_.tracks, std::move(next));
        ++cursor_.sample;
    }
}

Moment Take::moment(const Cursor& cursor, double time, const std::set<EntityIndex>* only) {
    const std::vector<Sample>& samples = cursor.chunk->samples;
    const Sample& now = samples[cursor.sample];
    Moment moment{now.time, now.step, cursor.sample > 0 ? now.time - samples[cursor.sample - 1].time : 0, {}};
    double part = 0;
    if (cursor.next) {
        const double interval = samples[cursor.sample + 1].time - now.time;
        if (moment.interval <= 0) moment.interval = interval;
        part = interval > 0 ? std::clamp((time - now.time) / interval, 0.0, 1.0) : 0;
        moment.time += part * interval;
    }
    std::map<EntityIndex, const Track*> nexts;
    if (part > 0)
        for (const auto& [index, track] : cursor.next->written) nexts[index] = &track;
    for (const auto& [index, track] : cursor.tracks) {
        if (only && !only->contains(index)) continue;
        const auto found = nexts.find(index);
        const Track* next = found == nexts.end() ? nullptr : found->second;
        const auto number = [&](std::size_t i) {
            const auto value = static_cast<double>(track.numbers[i]);
            return next ? value + part * (static_cast<double>(next->numbers[i]) - value) : value;
        };
        EntityMoment& made = moment.entities.emplace_back();
        made.motion.entity = index;
        made.motion.state = track.state;
        made.motion.pose.position = Vec3{number(0), number(1), number(2)} / position_units;
        made.motion.pose.rotation = normalized(Quat{number(3), number(4), number(5), number(6)});
        made.motion.linear_velocity = Vec3{number(7), number(8), number(9)} / velocity_units;
        made.motion.angular_velocity = Vec3{number(10), number(11), number(12)} / velocity_units;
        if (!track.has_points) continue;
        if (track.written == cursor.chunk->number + cursor.sample) made.point_steps = track.point_steps;
        RecordedPoints::Places to = next ? next->points : nullptr;
        if (next && next->is_renewed) to = led_on(track.points, made.point_steps);
        made.points =
            std::make_shared<RecordedPoints>(track.points, std::move(to), part, track.radius, track.is_liquid);
        made.motion.points = made.points.get();
    }
    return moment;
}

Moment Take::at(double time, const std::set<EntityIndex>* only) const {
    EMBODY_ASSERT(!empty());
    place_cursor(time);
    const std::vector<Sample>& samples = cursor_.chunk->samples;
    if (cursor_.sample + 1 < samples.size() && !cursor_.next)
        cursor_.next = decode(*cursor_.chunk, cursor_.sample + 1, cursor_.tracks);
    return moment(cursor_, time, only);
}

void Take::cut(double time) {
    if (empty()) return;
    place_cursor(time);
    while (&chunks_.back() != cursor_.chunk) {
        chunks_.pop_back();
        closed_bytes_ -= chunks_.back().bytes();
    }
    Chunk& chunk = chunks_.back();
    if (cursor_.sample + 1 < chunk.samples.size()) chunk.data.resize(chunk.samples[cursor_.sample + 1].at);
    chunk.samples.resize(cursor_.sample + 1);
    number_ = chunk.number + chunk.samples.size();
    tracks_ = cursor_.tracks;
    cursor_ = {};
    is_open_ = false;
}

}  // namespace embody::scene
