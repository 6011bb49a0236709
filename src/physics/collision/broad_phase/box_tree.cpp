// SPDX-License-Identifier: MIT
#include "physics/collision/broad_phase/box_tree.h"

#include <algorithm>
#include <array>
#include <utility>

#include "foundation/assert.h"

namespace embody::physics::collision {

namespace {

constexpr std::uint32_t lanes = BoxNode::lanes;

float half_area(const FloatBox& b) {
    const float x = b.upper[0] - b.lower[0], y = b.upper[1] - b.lower[1], z = b.upper[2] - b.lower[2];
    return x < 0 ? 0 : x * y + y * z + z * x;
}

// The lowest 20 bits of v, two zeros between each.
std::uint64_t spread(std::uint64_t v) {
    v &= 0xFFFFF;
    v = (v | v << 32) & 0x1F00000000FFFFull;
    v = (v | v << 16) & 0x1F0000FF0000FFull;
    v = (v | v << 8) & 0x100F00F00F00F00Full;
    v = (v | v << 4) & 0x10C30C30C30C30C3ull;
    return (v | v << 2) & 0x1249249249249249ull;
}

// Groups boxes by size in 16 classes by factors of four: one large box would make all boxes above it large.
std::uint64_t size_class(const FloatBox& b) {
    float size = 0;
    for (int k = 0; k < 3; ++k) size = std::max(size, b.upper[k] - b.lower[k]);
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(size) >> 23) - 127;
    return static_cast<std::uint64_t>(std::clamp((exponent + 12) / 2, 0, 15));
}

/// The position of a box along the curve through the space that holds all their centres.
class Curve {
public:
    explicit Curve(const std::vector<MovingBox>& boxes) {
        float high[3] = {-3e38f, -3e38f, -3e38f};
        for (const MovingBox& b : boxes) {
            for (int k = 0; k < 3; ++k) {
                low_[k] = std::min(low_[k], center(b.box, k));
                high[k] = std::max(high[k], center(b.box, k));
            }
        }
        float extent = 1e-30f;
        for (int k = 0; k < 3; ++k) extent = std::max(extent, high[k] - low_[k]);
        scale_ = 1048575.0f / extent;
    }
    [[nodiscard]] std::uint64_t key(const FloatBox& b) const {
        std::uint64_t key = size_class(b) << 60;
        for (int k = 0; k < 3; ++k) {
            const float cell = std::clamp((center(b, k) - low_[k]) * scale_, 0.0f, 1048575.0f);
            key |= spread(static_cast<std::uint64_t>(cell)) << k;
        }
        return key;
    }

private:
    static float center(const FloatBox& b, int k) { return 0.5f * b.lower[k] + 0.5f * b.upper[k]; }
    float low_[3] = {3e38f, 3e38f, 3e38f};
    float scale_ = 1;
};

// Sorts by key, equal ones in their old order; by digits of 11 bits, without digits that are the same in all keys.
template <class Entry>
void sort_by_key(std::vector<Entry>& entries, std::vector<Entry>& scratch) {
    constexpr int bits = 11;  // 2048 counters stay in the first cache
    scratch.resize(entries.size());
    for (int shift = 0; shift < 64; shift += bits) {
        std::array<std::uint32_t, 1u << bits> first{};
        const auto digit = [shift](const Entry& e) { return e.key >> shift & ((1u << bits) - 1); };
        for (const Entry& e : entries) ++first[digit(e)];
        if (first[digit(entries[0])] == entries.size()) continue;
        std::uint32_t next = 0;
        for (std::uint32_t& f : first) next += std::exchange(f, next);
        for (const Entry& e : entries) scratch[first[digit(e)]++] = e;
        entries.swap(scratch);
    }
}

}  // namespace

MovingBox BoxNode::joined(std::uint32_t mask) const {
    MovingBox all = BoxNode().box(0);
    for (int k = 0; k < 3; ++k) {
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            if (!(mask >> lane & 1u)) continue;
            all.box.lower[k] = std::min(all.box.lower[k], lower[k][lane]);
            all.box.upper[k] = std::max(all.box.upper[k], upper[k][lane]);
            all.min_displacement[k] = std::min(all.min_displacement[k], min_displacement[k][lane]);
            all.max_displacement[k] = std::max(all.max_displacement[k], max_displacement[k][lane]);
        }
    }
    return all;
}

std::uint32_t BoxTree::used_mask(std::uint32_t node) const {
    std::uint32_t mask = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        mask |= static_cast<std::uint32_t>(value(node, lane) != none) << lane;
    }
    return mask;
}

void BoxTree::set_slot(std::uint32_t slot, const MovingBox& box) {
    const std::uint32_t node = slot / lanes, lane = slot % lanes;
    moving_ += static_cast<std::uint32_t>(box.moves()) - static_cast<std::uint32_t>(leaves_[node].moves(lane));
    leaves_[node].set(lane, box);
    changed_[node] = static_cast<std::uint8_t>(changed_[node] | 1u << lane);
    stale_[node] = 1;
    is_stale_ = true;
}

void BoxTree::insert(std::uint32_t value, const MovingBox& box) {
    if (value >= slots_.size()) slots_.resize(value + 1, none);
    EMBODY_ASSERT(slots_[value] == none);
    // Boxes that are removed and inserted again and again, with no query between, leave gaps behind.
    constexpr std::uint32_t max_gaps = 4, fewest_slots = 64;  // slots for each box, and beside
    if (leaf_count() * lanes > max_gaps * used_ + fewest_slots) sort();

    // The last leaf may have room; a sorted one stays as it is.
    const std::uint32_t last = leaf_count() - 1;
    std::uint32_t lane = lanes;
    if (leaf_count() > sorted_leaves_) {
        while (lane > 0 && values_[last * lanes + lane - 1] == none) --lane;
    }
    if (lane == lanes) {
        leaves_.emplace_back();
        changed_.push_back(0);
        stale_.push_back(0);
        values_.resize(values_.size() + lanes, none);
        lane = 0;
    }
    slots_[value] = (leaf_count() - 1) * lanes + lane;
    values_[slots_[value]] = value;
    ++used_;
    set_slot(slots_[value], box);
}

void BoxTree::remove(std::uint32_t value) {
    const std::uint32_t slot = slots_[value], node = slot / lanes, lane = slot % lanes;
    EMBODY_ASSERT(slot != none && values_[slot] == value);
    moving_ -= static_cast<std::uint32_t>(leaves_[node].moves(lane));
    leaves_[node].clear(lane);
    changed_[node] = static_cast<std::uint8_t>(changed_[node] & ~(1u << lane));
    stale_[node] = 1;
    is_stale_ = true;
    values_[slot] = slots_[value] = none;
    --used_;
}

void BoxTree::set(std::uint32_t value, const MovingBox& box) { set_slot(slots_[value], box); }

bool BoxTree::are_all_changed() const {
    std::uint32_t count = 0;
    for (const std::uint8_t mask : changed_) count += static_cast<std::uint32_t>(std::popcount(mask));
    return count == used_;
}

void BoxTree::change_all() {
    for (std::uint32_t node = 0; node < leaf_count(); ++node) {
        changed_[node] = static_cast<std::uint8_t>(used_mask(node));
    }
}

// Sort when many boxes wait, many were removed, or the sorted leaves have grown by half.
bool BoxTree::wants_sorting() const {
    const std::uint32_t waiting = leaf_count() - sorted_leaves_;
    return waiting > 8 + sorted_leaves_ / 16 || used_ < sorted_used_ / 2 || total_area_ > 1.5 * sorted_area_;
}

void BoxTree::refresh() {
    if (!is_stale_) return;
    is_stale_ = false;
    join_levels();
    if (wants_sorting()) sort();
}

// Propagates the changes of the leaves upwards.
void BoxTree::join_levels() {
    for (std::uint32_t node = 0; node < sorted_leaves_; ++node) {
        if (!stale_[node]) continue;
        stale_[node] = 0;
        const MovingBox box = leaves_[node].joined();
        const float area = half_area(box.box);
        total_area_ += static_cast<double>(area) - area_[node];
        area_[node] = area;
        levels_[0][node / lanes].set(node % lanes, box);
        stale_above_[0][node / lanes] = 1;
    }
    for (std::size_t level = 0; level + 1 < levels_.size(); ++level) {
        for (std::uint32_t node = 0; node < levels_[level].size(); ++node) {
            if (!stale_above_[level][node]) continue;
            stale_above_[level][node] = 0;
            levels_[level + 1][node / lanes].set(node % lanes, levels_[level][node].joined());
            stale_above_[level + 1][node / lanes] = 1;
        }
    }
}

void BoxTree::sort() {
    entries_.clear();
    boxes_.clear();
    for (std::uint32_t slot = 0; slot < values_.size(); ++slot) {
        if (values_[slot] == none) continue;
        entries_.push_back({0, values_[slot], static_cast<std::uint32_t>(boxes_.size())});
        boxes_.push_back(leaves_[slot / lanes].box(slot % lanes));
        const bool has_changed = changed_[slot / lanes] >> slot % lanes & 1u;
        old_changed_.resize(boxes_.size());
        old_changed_[boxes_.size() - 1] = has_changed;
    }
    if (!entries_.empty()) {
        const Curve curve(boxes_);
        for (Entry& entry : entries_) entry.key = curve.key(boxes_[entry.slot].box);
        sort_by_key(entries_, other_entries_);
    }
    place_sorted();
}

void BoxTree::place_sorted() {
    const std::size_t count = entries_.size();
    sorted_leaves_ = static_cast<std::uint32_t>((count + lanes - 1) / lanes);
    leaves_.assign(sorted_leaves_, {});
    changed_.assign(sorted_leaves_, 0);
    stale_.assign(sorted_leaves_, 1);
    area_.assign(sorted_leaves_, 0);
    values_.assign(sorted_leaves_ * lanes, none);
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        const Entry& entry = entries_[slot];
        leaves_[slot / lanes].set(slot % lanes, boxes_[entry.slot]);
        changed_[slot / lanes] =
            static_cast<std::uint8_t>(changed_[slot / lanes] | old_changed_[entry.slot] << slot % lanes);
        values_[slot] = entry.value;
        slots_[entry.value] = slot;
    }

    // One level above the leaves at least, up to one of a single node.
    std::size_t nodes = sorted_leaves_, level = 0;
    while (nodes > 0 && (nodes > 1 || level == 0)) {
        nodes = (nodes + lanes - 1) / lanes;
        if (level == levels_.size()) levels_.emplace_back(), stale_above_.emplace_back();
        levels_[level].assign(nodes, {});
        stale_above_[level].assign(nodes, 0);
        ++level;
    }
    levels_.resize(level);
    stale_above_.resize(level);
    used_ = sorted_used_ = static_cast<std::uint32_t>(count);
    total_area_ = 0;
    join_levels();
    sorted_area_ = total_area_;
}

}  // namespace embody::physics::collision
