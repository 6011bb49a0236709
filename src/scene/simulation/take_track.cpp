// SPDX-License-Identifier: MIT
// An entity's sample in a take, in whole numbers and as a difference from the one before.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "foundation/assert.h"
#include "scene/simulation/take.h"
#include "scene/simulation/take_numbers.h"

namespace embody::scene {

namespace {

constexpr std::uint8_t state_bits = 3, points_bit = 4, whole_bit = 8, liquid_bit = 16;

std::int64_t to_units(double value, double units) {
    constexpr double most = 1e15;
    return std::isfinite(value) ? std::llround(std::clamp(value * units, -most, most)) : 0;
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

}  // namespace

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

}  // namespace embody::scene
