// SPDX-License-Identifier: MIT
#include "server/state_frame.h"

#include <bit>
#include <cstring>

namespace embody::server {
namespace {

static_assert(std::endian::native == std::endian::little, "frames are little-endian and written as they lie in memory");

constexpr std::uint32_t frame_magic = 0x46424D45;  // "EMBF"
constexpr std::uint16_t frame_version = 1;
constexpr std::size_t header_bytes = 32;
constexpr std::size_t record_bytes = 36;

template <class T>
void append(std::string& frame, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    frame.append(bytes, sizeof(T));
}

void append_record(std::string& frame, const scene::EntityState& state) {
    append(frame, state.entity);
    const Vec3 p = state.pose.position;
    const Quat q = state.pose.rotation;
    for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) append(frame, static_cast<float>(number));
    append(frame, std::uint32_t{state.state});
}

bool same(const scene::EntityState& a, const scene::EntityState& b) { return a.pose == b.pose && a.state == b.state; }

}  // namespace

void StateBoard::publish(const std::vector<scene::EntityState>& states, double time, std::uint64_t step,
                         bool all_changed) {
    ++version_;
    time_ = time;
    step_ = step;
    std::map<scene::EntityIndex, Row> next;
    for (const scene::EntityState& state : states) {
        const auto known = rows_.find(state.entity);
        const bool changed = all_changed || known == rows_.end() || !same(known->second.state, state);
        next.emplace(state.entity, Row{state, changed ? version_ : known->second.changed});
    }
    rows_ = std::move(next);
}

std::string StateBoard::frame_since(std::uint64_t seen) const {
    std::uint32_t count = 0;
    for (const auto& [entity, row] : rows_) count += row.changed > seen;
    if (count == 0) return {};
    std::string frame;
    frame.reserve(header_bytes + count * record_bytes);
    append(frame, frame_magic);
    append(frame, frame_version);
    append(frame, std::uint16_t{0});
    append(frame, count);
    append(frame, std::uint32_t{0});
    append(frame, time_);
    append(frame, step_);
    for (const auto& [entity, row] : rows_) {
        if (row.changed > seen) append_record(frame, row.state);
    }
    return frame;
}

}  // namespace embody::server
