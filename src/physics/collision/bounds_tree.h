// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "math/bounds.h"

namespace embody::physics {

/// Binary tree of boxes whose leaves come and go. Same calls in the same order, same tree.
class BoundsTree {
public:
    static constexpr std::uint32_t none = 0xFFFFFFFFu;

    /// Returns the leaf, valid until removed.
    std::uint32_t insert(const Bounds& bounds, std::uint32_t value);
    void remove(std::uint32_t leaf);
    [[nodiscard]] const Bounds& bounds(std::uint32_t node) const { return nodes_[node].bounds; }
    [[nodiscard]] int height() const { return root_ == none ? 0 : nodes_[root_].height; }

    /// Calls visit(value) for each leaf that overlaps `box`.
    template <class Visit>
    void query(const Bounds& box, Visit&& visit) const {
        walk([&box](const Bounds& b) { return overlaps(b, box); }, visit);
    }
    /// Calls visit(value) for each leaf for which, like for all boxes above it, `meets(bounds)` holds.
    template <class Meets, class Visit>
    void walk(Meets&& meets, Visit&& visit) const {
        std::vector<std::uint32_t>& waiting = waiting_;
        const std::size_t floor = waiting.size();
        if (root_ != none) waiting.push_back(root_);
        while (waiting.size() > floor) {
            const Node& node = nodes_[waiting.back()];
            waiting.pop_back();
            if (!meets(node.bounds)) continue;
            if (node.is_leaf()) {
                visit(node.value);
            } else {
                waiting.push_back(node.right);
                waiting.push_back(node.left);
            }
        }
    }

private:
    struct Node {
        Bounds bounds;
        std::uint32_t parent = none, left = none, right = none;
        std::uint32_t value = 0;
        int height = 1;
        [[nodiscard]] bool is_leaf() const { return left == none; }
    };
    std::uint32_t allocate();
    std::uint32_t best_sibling(const Bounds& bounds) const;
    void refit_upwards(std::uint32_t node);
    std::uint32_t balance(std::uint32_t node);
    void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child);
    void update(std::uint32_t node);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_;
    std::uint32_t root_ = none;
    mutable std::vector<std::uint32_t> waiting_;  // scratch of walk; nested walks share it above each other's floor
};

}  // namespace embody::physics
