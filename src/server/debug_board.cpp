// SPDX-License-Identifier: MIT
#include "server/debug_board.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "physics/inter/debug_draw.h"
#include "server/frame_bytes.h"

namespace embody::server {
namespace {

using nlohmann::json;

constexpr std::uint32_t frame_magic = 0x44424D45;  // "EMBD"
constexpr std::uint16_t frame_version = 1;
/// A frame is at most about 3 MB.
physics::DebugDrawOptions options_of(std::uint32_t flags, const std::vector<std::uint64_t>& only) {
    return {.flags = flags, .max_lines = 60'000, .max_points = 120'000, .only = only};
}

/// Collects lines and points by their meaning.
class FrameDraw final : public physics::DebugDraw {
public:
    void line(Vec3 from, Vec3 to, physics::DebugColor color) override {
        Batch& batch = batch_of(color);
        append_place(batch.lines, from);
        append_place(batch.lines, to);
    }
    void point(Vec3 at, physics::DebugColor color) override { append_place(batch_of(color).points, at); }

    [[nodiscard]] std::string frame(std::uint32_t flags, const physics::DebugDrawCount& count, double time) const {
        std::string frame;
        append(frame, frame_magic);
        append(frame, frame_version);
        append(frame, std::uint16_t{0});
        append(frame, flags);
        append(frame, static_cast<std::uint32_t>(batches_.size()));
        append(frame, static_cast<std::uint32_t>(count.lines_left_out));
        append(frame, static_cast<std::uint32_t>(count.points_left_out));
        append(frame, time);
        for (const auto& [key, batch] : batches_) {
            append(frame, key);
            append(frame, static_cast<std::uint32_t>(batch.lines.size() / line_bytes));
            append(frame, static_cast<std::uint32_t>(batch.points.size() / place_bytes));
            frame += batch.lines;
            frame += batch.points;
        }
        return frame;
    }

private:
    struct Batch {
        std::string lines, points;
    };
    static constexpr std::size_t place_bytes = 12, line_bytes = 2 * place_bytes;

    static void append_place(std::string& bytes, Vec3 place) {
        for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(place[k]));
    }
    // The key is the first four bytes of the batch: meaning, whether it is dim, number.
    Batch& batch_of(physics::DebugColor color) {
        const std::uint32_t dim = color.is_dim ? 1 : 0, number = color.number;
        return batches_[static_cast<std::uint32_t>(color.meaning) | dim << 8 | number << 16];
    }

    std::map<std::uint32_t, Batch> batches_;
};

Result<std::uint32_t> flag_named(const json& name, const std::string& where) {
    std::string all;
    for (std::size_t bit = 0; bit < physics::debug_draw_names.size(); ++bit) {
        if (name == physics::debug_draw_names[bit]) return std::uint32_t{1} << bit;
        all += (all.empty() ? "" : ", ") + std::string(physics::debug_draw_names[bit]);
    }
    return Error{where, "is nothing that can be shown", "use some of " + all};
}

// Indices of entities, ascending.
Result<std::vector<std::uint64_t>> read_entities(const json& list) {
    if (!list.is_array()) return Error{"of", "must be a list of entities' indices", ""};
    std::vector<std::uint64_t> entities;
    for (const json& each : list) {
        if (!each.is_number_unsigned()) return Error{"of", "must be a list of entities' indices", ""};
        entities.push_back(each.get<std::uint64_t>());
    }
    std::ranges::sort(entities);
    return entities;
}

}  // namespace

Result<void> DebugBoard::choose(scene::ClientId client, const json& params) {
    for (const auto& [field, value] : params.items()) {
        if (field != "show" && field != "of") return Error{field, "is no parameter of debug.draw", "use show and of"};
    }
    const json show = params.value("show", json());
    if (!show.is_array()) return Error{"show", "must be a list of names", ""};
    std::uint32_t flags = 0;
    for (std::size_t i = 0; i < show.size(); ++i) {
        const auto flag = flag_named(show[i], "show[" + std::to_string(i) + "]");
        if (!flag) return flag.error();
        flags |= *flag;
    }
    const auto only = read_entities(params.value("of", json::array()));
    if (!only) return only.error();
    if (flags == 0) {
        forget(client);
        return {};
    }
    const std::lock_guard lock(mutex_);
    wishes_[client] = {flags, *only, nullptr};
    return {};
}

void DebugBoard::forget(scene::ClientId client) {
    const std::lock_guard lock(mutex_);
    wishes_.erase(client);
}

bool DebugBoard::is_wanted() const {
    const std::lock_guard lock(mutex_);
    return !wishes_.empty();
}

void DebugBoard::publish(const scene::Session& session) {
    // Each choice is drawn once, however many clients made it, and without holding the lock.
    using Choice = std::pair<std::uint32_t, std::vector<std::uint64_t>>;
    std::map<Choice, std::shared_ptr<const std::string>> frames;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [client, wish] : wishes_) frames[{wish.flags, wish.only}] = nullptr;
    }
    for (auto& [choice, frame] : frames) {
        FrameDraw draw;
        const physics::DebugDrawCount count = session.debug_draw(draw, options_of(choice.first, choice.second));
        frame = std::make_shared<const std::string>(draw.frame(choice.first, count, session.simulated_time()));
    }
    // A choice that was made meanwhile has no frame yet.
    const std::lock_guard lock(mutex_);
    for (auto& [client, wish] : wishes_)
        if (const auto found = frames.find({wish.flags, wish.only}); found != frames.end()) wish.frame = found->second;
}

std::shared_ptr<const std::string> DebugBoard::take(scene::ClientId client) {
    const std::lock_guard lock(mutex_);
    const auto found = wishes_.find(client);
    return found == wishes_.end() ? nullptr : std::exchange(found->second.frame, nullptr);
}

}  // namespace embody::server
