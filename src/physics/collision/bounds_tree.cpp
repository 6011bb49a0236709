// SPDX-License-Identifier: MIT
// Incremental insertion by the surface area heuristic with AVL rotations (E. Catto, "Dynamic bounding volume
// hierarchies", GDC 2019).
#include "physics/collision/bounds_tree.h"

#include <algorithm>

namespace embody::physics {

namespace {

double half_area(const Bounds& b) {
    const Vec3 s = b.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

Bounds joined(Bounds a, const Bounds& b) {
    a.add(b);
    return a;
}

}  // namespace

std::uint32_t BoundsTree::allocate() {
    if (free_.empty()) {
        nodes_.emplace_back();
        return static_cast<std::uint32_t>(nodes_.size() - 1);
    }
    const std::uint32_t node = free_.back();
    free_.pop_back();
    nodes_[node] = Node{};
    return node;
}

// Goes down where the boxes grow least, as long as that is cheaper than stopping.
std::uint32_t BoundsTree::best_sibling(const Bounds& bounds) const {
    std::uint32_t current = root_;
    while (!nodes_[current].is_leaf()) {
        const Node& node = nodes_[current];
        const double grown = half_area(joined(node.bounds, bounds));
        const double inherited = grown - half_area(node.bounds);
        const auto cost_below = [&](std::uint32_t child) {
            const Node& c = nodes_[child];
            const double area = half_area(joined(c.bounds, bounds));
            return inherited + (c.is_leaf() ? area : area - half_area(c.bounds));
        };
        const double left = cost_below(node.left), right = cost_below(node.right);
        if (grown < left && grown < right) break;
        current = left <= right ? node.left : node.right;
    }
    return current;
}

std::uint32_t BoundsTree::insert(const Bounds& bounds, std::uint32_t value) {
    const std::uint32_t leaf = allocate();
    nodes_[leaf].bounds = bounds;
    nodes_[leaf].value = value;
    if (root_ == none) {
        root_ = leaf;
        return leaf;
    }
    // A new parent takes the sibling's place.
    const std::uint32_t sibling = best_sibling(bounds);
    const std::uint32_t above = nodes_[sibling].parent;
    const std::uint32_t parent = allocate();
    nodes_[parent].parent = above;
    nodes_[parent].left = sibling;
    nodes_[parent].right = leaf;
    replace_child(above, sibling, parent);
    nodes_[sibling].parent = parent;
    nodes_[leaf].parent = parent;
    refit_upwards(parent);
    return leaf;
}

void BoundsTree::remove(std::uint32_t leaf) {
    free_.push_back(leaf);
    const std::uint32_t parent = nodes_[leaf].parent;
    if (parent == none) {
        root_ = none;
        return;
    }
    // The sibling takes the parent's place.
    const std::uint32_t sibling = nodes_[parent].left == leaf ? nodes_[parent].right : nodes_[parent].left;
    const std::uint32_t above = nodes_[parent].parent;
    nodes_[sibling].parent = above;
    replace_child(above, parent, sibling);
    free_.push_back(parent);
    refit_upwards(above);
}

void BoundsTree::replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child) {
    if (parent == none) {
        root_ = new_child;
    } else if (nodes_[parent].left == old_child) {
        nodes_[parent].left = new_child;
    } else {
        nodes_[parent].right = new_child;
    }
}

void BoundsTree::update(std::uint32_t node) {
    Node& n = nodes_[node];
    n.bounds = joined(nodes_[n.left].bounds, nodes_[n.right].bounds);
    n.height = 1 + std::max(nodes_[n.left].height, nodes_[n.right].height);
}

void BoundsTree::refit_upwards(std::uint32_t node) {
    while (node != none) {
        node = balance(node);
        update(node);
        node = nodes_[node].parent;
    }
}

// Lifts the higher child over `node` where the heights differ by more than one; returns the new top.
std::uint32_t BoundsTree::balance(std::uint32_t node) {
    const std::uint32_t left = nodes_[node].left, right = nodes_[node].right;
    const int tilt = nodes_[right].height - nodes_[left].height;
    if (tilt >= -1 && tilt <= 1) return node;
    const std::uint32_t lifted = tilt > 0 ? right : left;
    const std::uint32_t kept = tilt > 0 ? left : right;

    // The lifted child's higher side stays with it, the lower one goes to the old top.
    std::uint32_t high = nodes_[lifted].left, low = nodes_[lifted].right;
    if (nodes_[low].height > nodes_[high].height) std::swap(high, low);
    const std::uint32_t above = nodes_[node].parent;
    replace_child(above, node, lifted);
    nodes_[lifted].parent = above;
    nodes_[lifted].left = node;
    nodes_[lifted].right = high;
    nodes_[node].parent = lifted;
    nodes_[node].left = kept;
    nodes_[node].right = low;
    nodes_[low].parent = node;
    update(node);
    return lifted;
}

}  // namespace embody::physics
