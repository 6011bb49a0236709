// SPDX-License-Identifier: MIT
#include "server/state_frame.h"

#include <algorithm>
#include <cmath>

#include "server/frame_bytes.h"

namespace embody::server {
namespace {

constexpr std::uint32_t frame_magic = 0x46424D45;  // "EMBF"
constexpr std::uint16_t frame_version = 2;
constexpr std::size_t header_bytes = 32;
constexpr std::size_t record_bytes = 36;
constexpr std::size_t points_head_bytes = 40;
constexpr std::uint8_t asleep = 2;

void append_record(std::string& frame, const scene::EntityState& state, bool has_points) {
    append(frame, state.entity);
    const Vec3 p = state.pose.position;
    const Quat q = state.pose.rotation;
    for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) append(frame, static_cast<float>(number));
    append(frame, state.state);
    append(frame, static_cast<std::uint8_t>(has_points ? 1 : 0));
    append(frame, std::uint16_t{0});
}

// Positions in 65535ths of the box around them: steps of 15 µm for a box of a metre.
std::string points_record(scene::EntityIndex entity, const std::vector<Vec3>& positions,
                          const scene::ShownPoints& points) {
    constexpr double steps = 65535;
    Bounds bounds;
    for (const Vec3 p : positions) bounds.add(p);
    if (bounds.is_empty()) bounds = {{}, {}};
    std::string record;
    record.reserve(points_head_bytes + 6 * positions.size() + 2);
    append(record, entity);
    append(record, static_cast<std::uint32_t>(positions.size()));
    const Vec3f lower = to_vec3f(bounds.lower), size = to_vec3f(bounds.size());
    for (const float number : {lower.x, lower.y, lower.z, size.x, size.y, size.z, static_cast<float>(points.radius())})
        append(record, number);
    append(record, std::uint32_t{points.is_liquid() ? 1U : 0U});
    const auto quantised = [&](double position, float from, float extent) {
        if (!(extent > 0)) return std::uint16_t{0};
        return static_cast<std::uint16_t>(std::lround(std::clamp((position - from) / extent, 0.0, 1.0) * steps));
    };
    for (const Vec3 p : positions) {
        append(record, quantised(p.x, lower.x, size.x));
        append(record, quantised(p.y, lower.y, size.y));
        append(record, quantised(p.z, lower.z, size.z));
    }
    if (positions.size() % 2 != 0) append(record, std::uint16_t{0});
    return record;
}

bool same(const scene::EntityState& a, const scene::EntityState& b) { return a.pose == b.pose && a.state == b.state; }

}  // namespace

void StateBoard::publish(const std::vector<scene::EntityState>& states, double time, std::uint64_t step,
                         bool all_changed) {
    // Only this thread replaces the table.
    const Table& before = *table_;
    auto next = std::make_shared<Table>();
    next->version = before.version + 1;
    next->time = time;
    next->step = step;
    next->rows.reserve(states.size());
    auto known = before.rows.begin();
    for (const scene::EntityState& state : states) {
        while (known != before.rows.end() && known->state.entity < state.entity) ++known;
        const bool is_known = known != before.rows.end() && known->state.entity == state.entity && !all_changed;
        next->rows.push_back(next_row(state, is_known ? &*known : nullptr, next->version));
    }
    const std::lock_guard lock(mutex_);
    table_ = std::move(next);
}

StateBoard::Row StateBoard::next_row(const scene::EntityState& state, const Row* known, std::uint64_t version) {
    const bool has_points = state.points != nullptr;
    const bool is_same = known != nullptr && same(known->state, state) && (known->points != nullptr) == has_points;
    Row row{state, is_same ? known->changed : version, nullptr, version};
    row.state.points = nullptr;
    if (!has_points) return row;

    // What was asleep and still is has not moved; for others the bytes are compared.
    if (is_same && state.state == asleep && known->state.jump == state.jump) {
        row.points = known->points;
        row.points_changed = known->points_changed;
        return row;
    }
    state.points->read(scratch_);
    row.points = std::make_shared<std::string>(points_record(state.entity, scratch_, *state.points));
    if (known != nullptr && known->points && *known->points == *row.points) row.points_changed = known->points_changed;
    return row;
}

std::shared_ptr<const StateBoard::Table> StateBoard::table() const {
    const std::lock_guard lock(mutex_);
    return table_;
}

StateBoard::Frame StateBoard::frame_since(std::uint64_t seen) const {
    const std::shared_ptr<const Table> now = table();
    std::uint32_t count = 0, sets = 0;
    std::size_t bytes = header_bytes;
    for (const Row& row : now->rows) {
        if (row.changed > seen) ++count, bytes += record_bytes;
        if (row.points_changed > seen && row.points) ++sets, bytes += row.points->size();
    }
    if (count == 0 && sets == 0) return {{}, now->version};
    std::string frame;
    frame.reserve(bytes);
    append(frame, frame_magic);
    append(frame, frame_version);
    append(frame, std::uint16_t{0});
    append(frame, count);
    append(frame, sets);
    append(frame, now->time);
    append(frame, now->step);
    for (const Row& row : now->rows) {
        if (row.changed > seen) append_record(frame, row.state, row.points != nullptr);
    }
    for (const Row& row : now->rows) {
        if (row.points_changed > seen && row.points) frame += *row.points;
    }
    return {std::move(frame), now->version};
}

}  // namespace embody::server
