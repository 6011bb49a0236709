// SPDX-License-Identifier: MIT
#include "scene/simulation/take.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "foundation/assert.h"

namespace embody::scene {

namespace {

constexpr double samples_per_second = 60;
/// Units of the numbers: docs/time.md.
constexpr double position_units = 32768, rotation_units = 32767, velocity_units = 4096;
/// Differences of a chunk, bytes, and how many times its beginning they are at least when it ends.
constexpr std::size_t min_differences = 1 << 20, differences_per_beginning = 4;
/// Half a nanosecond: the clock is a sum of steps.
constexpr double rounding = 5e-10;
/// A chunk is at most this part of the ring.
constexpr std::size_t chunks_per_ring = 8;

constexpr std::uint8_t state_bits = 3, points_bit = 4, whole_bit = 8, liquid_bit = 16;

std::int64_t to_units(double value, double units) {
    constexpr double most = 1e15;
    return std::isfinite(value) ? std::llround(std::clamp(value * units, -most, most)) : 0;
}

void write_unsigned(std::string& data, std::uint64_t value) {
    while (value >= 0x80) {
        data.push_back(static_cast<char>(value | 0x80));
        value >>= 7;
    }
    data.push_back(static_cast<char>(value));
}

std::uint64_t read_unsigned(const char*& at) {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
        const auto byte = static_cast<std::uint8_t>(*at++);
        value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
        if (byte < 0x80) return value;
    }
}

// Small numbers of either sign are short.
void write_signed(std::string& data, std::int64_t value) {
    write_unsigned(data, (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

std::int64_t read_signed(const char*& at) {
    const std::uint64_t value = read_unsigned(at);
    return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

// `scale`: the units of a value.
std::vector<std::int32_t> in_units(const std::vector<Vec3>& values, double scale) {
    constexpr double most = 2e9;
    std::vector<std::int32_t> numbers;
    numbers.reserve(3 * values.size());
    for (const Vec3 p : values)
        for (const double value : {p.x, p.y, p.z}) {
            const double units = std::isfinite(value) ? value * scale : 0;
            numbers.push_back(static_cast<std::int32_t>(std::lround(std::clamp(units, -most, most))));
        }
    return numbers;
}

// Where points come to by their steps; null where they have none.
RecordedPoints::Places led_on(const RecordedPoints::Places& points, const RecordedPoints::Places& steps) {
    if (!steps) return nullptr;
    auto to = std::make_shared<std::vector<std::int32_t>>(*points);
    for (std::size_t i = 0; i < to->size(); ++i) (*to)[i] += (*steps)[i];
    return to;
}

}  // namespace

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

bool Take::are_same_points(const Track& a, const Track& b) {
    return a.has_points && b.has_points && a.points->size() == b.points->size() && a.membership == b.membership;
}

Take::Track Take::quantised(const EntityMotion& motion, const Track* before, std::uint64_t number, double interval) {
    Track track;
    const Vec3 p = motion.pose.position, v = motion.linear_velocity, w = motion.angular_velocity;
    Quat q = normalized(motion.pose.rotation);
    if (before) {
        const auto& was = before->numbers;
        const Quat last{static_cast<double>(was[3]), static_cast<double>(was[4]), static_cast<double>(was[5]),
                        static_cast<double>(was[6])};
        // Both signs are the same rotation; the nearer one has small differences.
        if (dot(last, q) < 0) q = {-q.x, -q.y, -q.z, -q.w};
    }
    track.numbers = {to_units(p.x, position_units), to_units(p.y, position_units), to_units(p.z, position_units),
                     to_units(q.x, rotation_units), to_units(q.y, rotation_units), to_units(q.z, rotation_units),
                     to_units(q.w, rotation_units), to_units(v.x, velocity_units), to_units(v.y, velocity_units),
                     to_units(v.z, velocity_units), to_units(w.x, velocity_units), to_units(w.y, velocity_units),
                     to_units(w.z, velocity_units)};
    track.state = motion.state;
    track.written = number;
    if (before)
        for (std::size_t i = 0; i < predicted; ++i) track.steps[i] = track.numbers[i] - before->numbers[i];
    if (!motion.points) return track;

    track.has_points = true;
    track.is_liquid = motion.points->is_liquid();
    track.radius = static_cast<float>(motion.points->radius());
    track.membership = motion.points->membership();
    constexpr std::uint8_t asleep = 2;
    const bool had_points = before && before->has_points;
    if (had_points && before->state == asleep && motion.state == asleep && before->membership == track.membership) {
        track.points = before->points;
        return track;
    }
    std::vector<Vec3> values;
    motion.points->read(values);
    track.points = std::make_shared<std::vector<std::int32_t>>(in_units(values, RecordedPoints::units_per_metre));
    if (!had_points) return track;
    if (!are_same_points(track, *before)) {
        // No point has a place before that could be found: its step is that of its velocity.
        motion.points->read_velocities(values);
        if (3 * values.size() == track.points->size() && interval > 0)
            track.point_steps = std::make_shared<std::vector<std::int32_t>>(
                in_units(values, RecordedPoints::units_per_metre * interval));
        return track;
    }
    auto steps = std::make_shared<std::vector<std::int32_t>>(track.points->size());
    for (std::size_t i = 0; i < steps->size(); ++i) (*steps)[i] = (*track.points)[i] - (*before->points)[i];
    track.point_steps = std::move(steps);
    return track;
}

bool Take::is_same(const Track& a, const Track& b) {
    return a.numbers == b.numbers && a.state == b.state && a.has_points == b.has_points && a.radius == b.radius &&
           (a.points == b.points || (a.points && b.points && *a.points == *b.points));
}

// A whole track stands alone; another one is the difference from what `before` leads to.
void Take::write(std::string& data, const Track& track, const Track* before, std::uint64_t number) {
    const bool same_points = before && before->has_points == track.has_points &&
                             (!track.has_points || (are_same_points(track, *before) && before->radius == track.radius));
    const bool is_whole = !same_points;
    data.push_back(static_cast<char>(track.state | (track.has_points ? points_bit : 0) | (is_whole ? whole_bit : 0) |
                                     (track.is_liquid ? liquid_bit : 0)));
    const bool goes_on = !is_whole && before->written + 1 == number;
    for (std::size_t i = 0; i < track.numbers.size(); ++i) {
        std::int64_t expected = is_whole ? 0 : before->numbers[i];
        if (goes_on && i < predicted) expected += before->steps[i];
        write_signed(data, track.numbers[i] - expected);
    }
    if (is_whole)
        for (const std::int64_t step : track.steps) write_signed(data, step);
    if (!track.has_points) return;

    const std::vector<std::int32_t>& points = *track.points;
    if (is_whole) {
        char radius[sizeof(float)];
        std::memcpy(radius, &track.radius, sizeof(float));
        data.append(radius, sizeof(float));
        write_unsigned(data, points.size());
        for (std::size_t i = 0; i < points.size(); ++i) write_signed(data, points[i] - (i < 3 ? 0 : points[i - 3]));
        data.push_back(track.point_steps ? 1 : 0);
        if (track.point_steps)
            for (const std::int32_t step : *track.point_steps) write_signed(data, step);
        return;
    }
    const std::vector<std::int32_t>* steps = goes_on ? before->point_steps.get() : nullptr;
    for (std::size_t i = 0; i < points.size(); ++i)
        write_signed(data, points[i] - (*before->points)[i] - (steps ? (*steps)[i] : 0));
}

Take::Track Take::read(const char*& at, const Track* before, std::uint64_t number) {
    Track track;
    const auto bits = static_cast<std::uint8_t>(*at++);
    const bool is_whole = (bits & whole_bit) != 0;
    EMBODY_ASSERT(is_whole || before != nullptr);
    track.state = bits & state_bits;
    track.has_points = (bits & points_bit) != 0;
    track.is_renewed = is_whole && before != nullptr;
    track.is_liquid = (bits & liquid_bit) != 0;
    track.written = number;
    const bool goes_on = !is_whole && before->written + 1 == number;
    for (std::size_t i = 0; i < track.numbers.size(); ++i) {
        std::int64_t expected = is_whole ? 0 : before->numbers[i];
        if (goes_on && i < predicted) expected += before->steps[i];
        track.numbers[i] = expected + read_signed(at);
    }
    for (std::size_t i = 0; i < predicted; ++i)
        track.steps[i] = is_whole ? read_signed(at) : track.numbers[i] - before->numbers[i];
    if (!track.has_points) return track;

    if (is_whole) {
        std::memcpy(&track.radius, at, sizeof(float));
        at += sizeof(float);
        auto points = std::make_shared<std::vector<std::int32_t>>(read_unsigned(at));
        for (std::size_t i = 0; i < points->size(); ++i)
            (*points)[i] = static_cast<std::int32_t>(read_signed(at) + (i < 3 ? 0 : (*points)[i - 3]));
        track.points = std::move(points);
        if (*at++ != 0) {
            auto steps = std::make_shared<std::vector<std::int32_t>>(track.points->size());
            for (std::int32_t& step : *steps) step = static_cast<std::int32_t>(read_signed(at));
            track.point_steps = std::move(steps);
        }
        return track;
    }
    track.radius = before->radius;
    const std::vector<std::int32_t>& last = *before->points;
    const std::vector<std::int32_t>* expected = goes_on ? before->point_steps.get() : nullptr;
    auto points = std::make_shared<std::vector<std::int32_t>>(last.size());
    auto steps = std::make_shared<std::vector<std::int32_t>>(last.size());
    for (std::size_t i = 0; i < last.size(); ++i) {
        (*steps)[i] = static_cast<std::int32_t>(read_signed(at) + (expected ? (*expected)[i] : 0));
        (*points)[i] = last[i] + (*steps)[i];
    }
    track.points = std::move(points);
    track.point_steps = std::move(steps);
    return track;
}

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
