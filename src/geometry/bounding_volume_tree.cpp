// SPDX-License-Identifier: MIT
#include "geometry/bounding_volume_tree.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace embody::geometry {
namespace {

constexpr std::uint32_t leaves_per_node = 4;
constexpr int bin_count = 16;
constexpr int median_below_depth = 40;

double half_area(const Bounds& b) {
    if (b.is_empty()) return 0;
    const Vec3 s = b.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

float round_down(double x) {
    const auto f = static_cast<float>(x);
    if (static_cast<double>(f) <= x) return f;
    // The next lower float: as an integer one more below zero, one less above it (IEEE 754, section 3.4).
    const auto bits = std::bit_cast<std::uint32_t>(f);
    constexpr std::uint32_t sign = 0x80000000U;
    return std::bit_cast<float>(f > 0 ? bits - 1 : f < 0 ? bits + 1 : sign | 1U);
}
float round_up(double x) { return -round_down(-x); }

}  // namespace

// Top-down: each range of leaves becomes a node and is split where bins of centres give the minimum expected number of
// box tests; its halves follow.
struct BoundingVolumeTree::Builder {
    struct Leaf {
        Bounds box;
        Vec3 center;
        std::uint32_t index;
    };
    struct Range {
        std::uint32_t first, last;  // leaves first … last - 1
        std::uint32_t parent;       // whose `link` this node becomes; `no_parent` for first children and the root
        int depth;
    };
    static constexpr std::uint32_t no_parent = ~std::uint32_t{0};

    BoundingVolumeTree& tree;
    std::vector<Leaf> leaves;

    void build();
    std::uint32_t split(std::uint32_t first, std::uint32_t last, int depth);
};

void BoundingVolumeTree::Builder::build() {
    if (leaves.empty()) return;
    tree.nodes_.reserve(leaves.size());
    std::vector<Range> waiting{{0, static_cast<std::uint32_t>(leaves.size()), no_parent, 0}};
    while (!waiting.empty()) {
        const Range range = waiting.back();
        waiting.pop_back();
        const auto index = static_cast<std::uint32_t>(tree.nodes_.size());
        if (range.parent != no_parent) tree.nodes_[range.parent].link = index;

        Bounds box;
        for (std::uint32_t i = range.first; i < range.last; ++i) box.add(leaves[i].box);
        Node node{rounded_outwards(box), range.first, range.last - range.first};
        const bool inner = node.count > leaves_per_node;
        if (inner) node.count = 0;
        tree.nodes_.push_back(node);
        if (!inner) continue;

        // The first child is made next, so that it lies beside its parent.
        const std::uint32_t middle = split(range.first, range.last, range.depth);
        waiting.push_back({middle, range.last, index, range.depth + 1});
        waiting.push_back({range.first, middle, no_parent, range.depth + 1});
    }
    for (const Leaf& leaf : leaves) {
        tree.leaf_indices_.push_back(leaf.index);
        tree.leaf_boxes_.push_back(rounded_outwards(leaf.box));
    }
}

// Reorders first … last - 1 and returns where the second half begins.
std::uint32_t BoundingVolumeTree::Builder::split(std::uint32_t first, std::uint32_t last, int depth) {
    struct Bin {
        Bounds box;
        std::uint32_t count = 0;
    };

    // Sort the centres into bins along the longest axis.
    Bounds centers;
    for (std::uint32_t i = first; i < last; ++i) centers.add(leaves[i].center);
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const double bins_per_metre = bin_count * (1 - 1e-12) / size[axis];
    const double begin = centers.lower[axis];
    const auto bin_of = [&](const Leaf& leaf) {
        return static_cast<int>((leaf.center[axis] - begin) * bins_per_metre);
    };
    const std::uint32_t median = first + (last - first) / 2;
    if (!(size[axis] > 0) || !std::isfinite(bins_per_metre)) return median;
    if (depth >= median_below_depth) {
        std::nth_element(
            leaves.begin() + first, leaves.begin() + median, leaves.begin() + last, [&](const Leaf& a, const Leaf& b) {
                return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.index < b.index;
            });
        return median;
    }
    std::array<Bin, bin_count> bins;
    for (std::uint32_t i = first; i < last; ++i) {
        Bin& bin = bins[static_cast<std::size_t>(bin_of(leaves[i]))];
        bin.box.add(leaves[i].box);
        ++bin.count;
    }

    // Cost of a split after each bin: area times count, from both sides.
    std::array<double, bin_count> cost_before{};
    Bin sum;
    for (std::size_t b = 0; b + 1 < bins.size(); ++b) {
        sum.box.add(bins[b].box);
        sum.count += bins[b].count;
        cost_before[b] = half_area(sum.box) * sum.count;
    }
    sum = {};
    double best_cost = std::numeric_limits<double>::infinity();
    int best_bin = 0;
    for (std::size_t b = bins.size() - 1; b > 0; --b) {
        sum.box.add(bins[b].box);
        sum.count += bins[b].count;
        const double cost = cost_before[b - 1] + half_area(sum.box) * sum.count;
        if (sum.count > 0 && sum.count < last - first && cost < best_cost) {
            best_cost = cost;
            best_bin = static_cast<int>(b);
        }
    }
    const auto middle = std::partition(leaves.begin() + first, leaves.begin() + last,
                                       [&](const Leaf& leaf) { return bin_of(leaf) < best_bin; });
    return static_cast<std::uint32_t>(middle - leaves.begin());
}

BoundingVolumeTree::BoundingVolumeTree(std::span<const Bounds> leaves) {
    Builder builder{*this, {}};
    builder.leaves.reserve(leaves.size());
    for (std::uint32_t i = 0; i < leaves.size(); ++i) {
        const Bounds& box = leaves[i];
        if (box.is_empty() || !is_finite(box.lower) || !is_finite(box.upper)) continue;
        builder.leaves.push_back({box, box.center(), i});
    }
    builder.build();
}

BoundingVolumeTree::BoundingVolumeTree(const TriangleMesh& mesh) {
    std::vector<Bounds> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (const Vec3 corner : corners(mesh, i)) boxes[i].add(corner);
    }
    *this = BoundingVolumeTree(boxes);
}

Bounds BoundingVolumeTree::bounds() const {
    if (nodes_.empty()) return {};
    const Box& b = nodes_[0].box;
    return {to_vec3({b.lower[0], b.lower[1], b.lower[2]}), to_vec3({b.upper[0], b.upper[1], b.upper[2]})};
}

std::size_t BoundingVolumeTree::memory_bytes() const {
    return nodes_.size() * sizeof(Node) + leaf_indices_.size() * (sizeof(std::uint32_t) + sizeof(Box));
}

BoundingVolumeTree::Box BoundingVolumeTree::rounded_outwards(const Bounds& b) {
    return {{round_down(b.lower.x), round_down(b.lower.y), round_down(b.lower.z)},
            {round_up(b.upper.x), round_up(b.upper.y), round_up(b.upper.z)}};
}

BoundingVolumeTree::Ray BoundingVolumeTree::prepare_ray(Vec3 origin, Vec3 direction) {
    // A huge number instead of 1/0: it never makes 0 · ∞, and still sends every slab but the origin's own away.
    const auto inverse = [](double d) { return std::fabs(d) > 1e-300 ? 1 / d : std::copysign(1e300, d); };
    return {{origin.x, origin.y, origin.z}, {inverse(direction.x), inverse(direction.y), inverse(direction.z)}};
}

}  // namespace embody::geometry
