// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "physics/collision/broad_phase/moving_box.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Eight boxes side by side: one comparison of a query reads all of them.
struct alignas(32) BoxNode {
    static constexpr std::uint32_t lanes = 8;
    float lower[3][lanes], upper[3][lanes];
    float min_displacement[3][lanes], max_displacement[3][lanes];  ///< MovingBox

    BoxNode() {
        for (std::uint32_t lane = 0; lane < lanes; ++lane) clear(lane);
    }
    /// Makes a box that nothing overlaps.
    void clear(std::uint32_t lane) {
        for (int k = 0; k < 3; ++k) {
            lower[k][lane] = min_displacement[k][lane] = 3e38f;
            upper[k][lane] = max_displacement[k][lane] = -3e38f;
        }
    }
    [[nodiscard]] bool is_clear(std::uint32_t lane) const { return lower[0][lane] > upper[0][lane]; }
    void set(std::uint32_t lane, const MovingBox& moving) {
        for (int k = 0; k < 3; ++k) {
            lower[k][lane] = moving.box.lower[k];
            upper[k][lane] = moving.box.upper[k];
            min_displacement[k][lane] = moving.min_displacement[k];
            max_displacement[k][lane] = moving.max_displacement[k];
        }
    }
    [[nodiscard]] bool moves(std::uint32_t lane) const {
        bool any = false;
        for (int k = 0; k < 3; ++k) any = any || min_displacement[k][lane] != 0 || max_displacement[k][lane] != 0;
        return any && !is_clear(lane);
    }
    [[nodiscard]] MovingBox box(std::uint32_t lane) const;
    /// The box around the boxes of the mask's lanes.
    [[nodiscard]] MovingBox joined(std::uint32_t mask = 0xFF) const;
    /// Bit i: box i overlaps `box`; both at rest.
    [[nodiscard]] std::uint32_t overlap_mask(const FloatBox& box) const;
    /// Bit i: box i meets `moving`.
    [[nodiscard]] std::uint32_t meeting_mask(const MovingBox& moving) const;
};

/// Tree of boxes, eight to a node, without pointers: the boxes lie sorted along a space-filling curve (G. Morton,
/// 1966), large ones apart from small ones, and node i of a level holds the nodes 8 i … 8 i + 7 of the level below. It
/// is sorted anew when moving boxes have spread its nodes; new boxes wait behind the sorted ones until then.
class BoxTree {
public:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    /// `value` is the caller's index, unique within the tree.
    void insert(std::uint32_t value, const MovingBox& box);
    void remove(std::uint32_t value);
    void set(std::uint32_t value, const MovingBox& box);
    /// Brings the upper levels in step with the boxes; to be called after changes and before queries.
    void refresh();

    /// Leaf nodes, and a mask of their boxes that are new or have changed since forget_changes().
    [[nodiscard]] std::uint32_t leaf_count() const { return static_cast<std::uint32_t>(leaves_.size()); }
    [[nodiscard]] const BoxNode& leaf(std::uint32_t node) const { return leaves_[node]; }
    [[nodiscard]] std::uint32_t changed_mask(std::uint32_t node) const { return changed_[node]; }
    [[nodiscard]] std::uint32_t used_mask(std::uint32_t node) const;
    [[nodiscard]] std::uint32_t value(std::uint32_t node, std::uint32_t lane) const {
        return values_[node * BoxNode::lanes + lane];
    }
    [[nodiscard]] bool are_all_changed() const;
    void change_all();
    void forget_changes() { changed_.assign(changed_.size(), 0); }

    /// Calls visit(node, mask) for each leaf node, from `first` on, with boxes that `box` meets; ascending in node.
    template <class Visit>
    void query(const MovingBox& box, Visit&& visit, std::uint32_t first = 0) const {
        if (has_moving() || box.moves()) {
            walk([&box](const BoxNode& node) { return node.meeting_mask(box); }, visit, first);
        } else {
            walk([&box](const BoxNode& node) { return node.overlap_mask(box.box); }, visit, first);
        }
    }
    /// Whether any box travels.
    [[nodiscard]] bool has_moving() const { return moving_ > 0; }
    /// As above, for boxes in the mask that `meets(node)` returns.
    template <class Meets, class Visit>
    void walk(Meets&& meets, Visit&& visit, std::uint32_t first = 0) const {
        struct Place {
            std::uint32_t level, node;
        };
        Place waiting[BoxNode::lanes * max_levels];
        int count = 0;
        if (sorted_leaves_ > 0) waiting[count++] = {static_cast<std::uint32_t>(levels_.size()), 0};
        while (count > 0) {
            const Place place = waiting[--count];
            const BoxNode& node = place.level == 0 ? leaves_[place.node] : levels_[place.level - 1][place.node];
            std::uint32_t mask = meets(node);
            if (mask == 0) continue;
            if (place.level == 0) {
                visit(place.node, mask);
                continue;
            }
            const std::uint32_t level = place.level - 1, first_there = first >> (3 * level);
            for (; mask != 0; mask &= ~std::bit_floor(mask)) {
                const std::uint32_t child =
                    place.node * BoxNode::lanes + static_cast<std::uint32_t>(std::bit_width(mask) - 1);
                if (child < first_there) break;
                waiting[count++] = {level, child};
            }
        }
        for (std::uint32_t i = std::max(first, sorted_leaves_); i < leaf_count(); ++i) {
            if (const std::uint32_t mask = meets(leaves_[i])) visit(i, mask);
        }
    }

    /// Calls visit(box, depth) for every box as it was when the tree was last refreshed: those around others from depth
    /// 0 downwards, then the inserted ones.
    template <class Visit>
    void visit_boxes(Visit&& visit) const {
        int depth = 0;
        const auto visit_nodes = [&](const std::vector<BoxNode>& nodes) {
            for (const BoxNode& node : nodes) {
                for (std::uint32_t lane = 0; lane < BoxNode::lanes; ++lane) {
                    if (!node.is_clear(lane)) visit(node.box(lane).swept(), depth);
                }
            }
            ++depth;
        };
        for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) visit_nodes(*level);
        visit_nodes(leaves_);
    }

private:
    static constexpr int max_levels = 12;  // 8^11 boxes
    struct Entry {
        std::uint64_t key;
        std::uint32_t value, slot;
    };
    [[nodiscard]] bool wants_sorting() const;
    void sort();
    void place_sorted();
    void join_levels();
    void set_slot(std::uint32_t slot, const MovingBox& box);

    std::vector<BoxNode> leaves_;                // sorted ones, then those with new boxes
    std::vector<std::uint8_t> changed_, stale_;  // by leaf: bits of its boxes; bits that its parents do not have yet
    std::vector<std::uint32_t> values_;          // by slot, 8 a leaf
    std::vector<std::uint32_t> slots_;           // by value
    std::vector<std::vector<BoxNode>> levels_;   // above the sorted leaves, upwards
    std::vector<std::vector<std::uint8_t>> stale_above_;
    std::uint32_t sorted_leaves_ = 0;
    std::uint32_t used_ = 0, sorted_used_ = 0;  // boxes now; when last sorted
    std::uint32_t moving_ = 0;                  // boxes that travel
    bool is_stale_ = false;
    std::vector<float> area_;                  // by sorted leaf, m²
    double total_area_ = 0, sorted_area_ = 0;  // of the sorted leaves now; when last sorted

    std::vector<Entry> entries_, other_entries_;  // scratch of sort
    std::vector<MovingBox> boxes_;
    std::vector<std::uint8_t> old_changed_;
};

inline MovingBox BoxNode::box(std::uint32_t lane) const {
    MovingBox moving;
    for (int k = 0; k < 3; ++k) {
        moving.box.lower[k] = lower[k][lane];
        moving.box.upper[k] = upper[k][lane];
        moving.min_displacement[k] = min_displacement[k][lane];
        moving.max_displacement[k] = max_displacement[k][lane];
    }
    return moving;
}

inline std::uint32_t BoxNode::overlap_mask(const FloatBox& box) const {
#if defined(__SSE2__)
    std::uint32_t mask = 0;
    for (int half = 0; half < 2; ++half) {
        __m128 apart = _mm_setzero_ps();
        for (int k = 0; k < 3; ++k) {
            const __m128 low = _mm_load_ps(lower[k] + 4 * half), high = _mm_load_ps(upper[k] + 4 * half);
            apart = _mm_or_ps(apart, _mm_or_ps(_mm_cmpgt_ps(low, _mm_set1_ps(box.upper[k])),
                                               _mm_cmplt_ps(high, _mm_set1_ps(box.lower[k]))));
        }
        mask |= static_cast<std::uint32_t>(_mm_movemask_ps(apart) ^ 0xF) << (4 * half);
    }
    return mask;
#else
    std::uint32_t mask = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        bool meets = true;
        for (int k = 0; k < 3; ++k) meets = meets && lower[k][lane] <= box.upper[k] && upper[k][lane] >= box.lower[k];
        mask |= static_cast<std::uint32_t>(meets) << lane;
    }
    return mask;
#endif
}

inline std::uint32_t BoxNode::meeting_mask(const MovingBox& moving) const {
#if defined(__SSE2__)
    std::uint32_t mask = 0;
    for (int half = 0; half < 2; ++half) {
        __m128 apart = _mm_setzero_ps();
        const auto load = [half](const float* row) { return _mm_load_ps(row + 4 * half); };
        for (int k = 0; k < 3; ++k) {
            const __m128 gap_below = _mm_sub_ps(load(lower[k]), _mm_set1_ps(moving.box.upper[k]));
            const __m128 gap_above = _mm_sub_ps(_mm_set1_ps(moving.box.lower[k]), load(upper[k]));
            const __m128 rise = _mm_sub_ps(_mm_set1_ps(moving.max_displacement[k]), load(min_displacement[k]));
            const __m128 fall = _mm_sub_ps(load(max_displacement[k]), _mm_set1_ps(moving.min_displacement[k]));
            apart = _mm_or_ps(apart, _mm_or_ps(_mm_cmpgt_ps(gap_below, _mm_max_ps(_mm_setzero_ps(), rise)),
                                               _mm_cmpgt_ps(gap_above, _mm_max_ps(_mm_setzero_ps(), fall))));
        }
        mask |= static_cast<std::uint32_t>(_mm_movemask_ps(apart) ^ 0xF) << (4 * half);
    }
    return mask;
#else
    std::uint32_t mask = 0;
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
        mask |= static_cast<std::uint32_t>(box(lane).meets(moving)) << lane;
    return mask;
#endif
}

}  // namespace embody::physics::collision
