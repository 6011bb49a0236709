// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace embody::physics::deformable {

namespace {

constexpr std::size_t leaf_size = 4;        // minimum number of triangles; the maximum is less than twice as many:
                                            // block size
constexpr std::size_t largest_piece = 256;  // triangles: a longer strip could wind itself over itself

// Triangles around each node.
struct Around {
    std::vector<std::uint32_t> start, triangle;
    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t node) const {
        return std::span(triangle).subspan(start[node], start[node + 1] - start[node]);
    }
};

Around triangles_around(std::span<const PatchTree::Triangle> triangles, std::size_t nodes) {
    Around around;
    around.start.assign(nodes + 1, 0);
    for (const auto& triangle : triangles) {
        for (const std::uint32_t node : triangle) ++around.start[node + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) around.start[i + 1] += around.start[i];
    around.triangle.resize(3 * triangles.size());
    std::vector<std::uint32_t> next(around.start.begin(), around.start.end() - 1);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (const std::uint32_t node : triangles[t]) around.triangle[next[node]++] = t;
    }
    return around;
}

// Traverses triangles from neighbour to neighbour, breadth first, within a patch.
class PatchWalk {
public:
    PatchWalk(std::span<const PatchTree::Triangle> triangles, std::size_t nodes)
        : triangles_(triangles), around_(triangles_around(triangles, nodes)), patch_(triangles.size(), 0) {}

    /// Puts `patch` into the order in which a traversal from an outermost triangle comes to them; piece after piece.
    /// Returns how many pieces there are.
    std::size_t sort(std::span<std::uint32_t> patch) {
        walk(patch, patch[0]);
        const std::uint32_t last_of_first = order_[first_piece_ - 1];
        const std::size_t pieces = walk(patch, last_of_first);
        std::ranges::copy(order_, patch.begin());
        return pieces;
    }

private:
    std::size_t walk(std::span<const std::uint32_t> patch, std::uint32_t from) {
        const std::uint32_t inside = ++mark_, seen = ++mark_;
        for (const std::uint32_t t : patch) patch_[t] = inside;
        order_.clear();
        std::size_t pieces = 0, next = 0;
        const auto begin = [&](std::uint32_t t) {
            patch_[t] = seen;
            order_.push_back(t);
            ++pieces;
            for (; next < order_.size(); ++next) {
                for (const std::uint32_t node : triangles_[order_[next]]) {
                    for (const std::uint32_t other : around_.of(node)) {
                        if (patch_[other] != inside) continue;
                        patch_[other] = seen;
                        order_.push_back(other);
                    }
                }
            }
            if (pieces == 1) first_piece_ = order_.size();
        };
        begin(from);
        for (const std::uint32_t t : patch) {
            if (patch_[t] == inside) begin(t);
        }
        return pieces;
    }

    std::span<const PatchTree::Triangle> triangles_;
    Around around_;
    std::vector<std::uint32_t> patch_, order_;
    std::uint32_t mark_ = 0;
    std::size_t first_piece_ = 0;
};

}  // namespace

LeanMask leans_of(Vec3 normal) {
    constexpr double min_cosine = 0.3;  // any above zero is right: the larger, the fewer triangles have a common
                                        // direction
    const double size = length(normal);
    if (!(size > 0)) return 0;
    const auto [x, y, z] = normal;
    const double to_face = min_cosine * size, to_corner = to_face * std::numbers::sqrt3;
    LeanMask leans = 0;
    int bit = 0;
    const auto add = [&](double along, double enough) {
        leans |= static_cast<LeanMask>(along > enough) << bit++;
        leans |= static_cast<LeanMask>(along < -enough) << bit++;
    };
    for (const double along : {x, y, z}) add(along, to_face);
    for (const double along : {x + y + z, x + y - z, x - y + z, x - y - z}) add(along, to_corner);
    return leans;
}

PatchTree::PatchTree(std::span<const Triangle> triangles, std::size_t nodes) {
    order_halves(triangles, nodes);
    find_neighbours(triangles, nodes);
    boxes_.resize(is_piece_.size());
    leans_.resize(is_piece_.size());
}

void PatchTree::order_halves(std::span<const Triangle> triangles, std::size_t nodes) {
    order_.resize(triangles.size());
    for (std::uint32_t t = 0; t < order_.size(); ++t) order_[t] = t;
    std::vector<std::uint32_t> start{0, static_cast<std::uint32_t>(order_.size())};
    PatchWalk walk(triangles, nodes);
    for (;;) {
        const std::size_t count = start.size() - 1;
        for (std::size_t p = 0; p < count; ++p) {
            const auto patch = std::span(order_).subspan(start[p], start[p + 1] - start[p]);
            const std::size_t pieces = walk.sort(patch);
            is_piece_.push_back(pieces == 1 && patch.size() <= largest_piece);
        }
        if (order_.size() < 2 * leaf_size * count) break;
        std::vector<std::uint32_t> halves{0};
        for (std::size_t p = 0; p < count; ++p) {
            halves.push_back((start[p] + start[p + 1]) / 2);
            halves.push_back(start[p + 1]);
        }
        start = std::move(halves);
    }
    leaf_start_ = std::move(start);
    leaf_of_.resize(order_.size());
    for (std::uint32_t leaf = 0; leaf < leaves(); ++leaf) {
        for (const std::uint32_t t : triangles_of(leaf)) leaf_of_[t] = leaf;
    }
}

void PatchTree::find_neighbours(std::span<const Triangle> triangles, std::size_t nodes) {
    std::vector<std::array<std::uint32_t, 2>> pairs;
    const Around around = triangles_around(triangles, nodes);
    for (std::uint32_t node = 0; node < nodes; ++node) {
        for (const std::uint32_t s : around.of(node)) {
            for (const std::uint32_t t : around.of(node)) {
                const std::uint32_t first = leaves() - 1;
                if (leaf_of_[s] != leaf_of_[t]) pairs.push_back({first + leaf_of_[s], first + leaf_of_[t]});
            }
        }
    }
    const auto keep_each_once = [&] {
        std::ranges::sort(pairs);
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    };
    keep_each_once();
    // Neighbours of one depth have neighbouring parents, or the same parent.
    std::vector<std::array<std::uint32_t, 2>> depth = pairs;
    while (!depth.empty()) {
        std::vector<std::array<std::uint32_t, 2>> above;
        for (const auto& [a, b] : depth) {
            if ((a - 1) / 2 != (b - 1) / 2) above.push_back({(a - 1) / 2, (b - 1) / 2});
        }
        std::ranges::sort(above);
        above.erase(std::unique(above.begin(), above.end()), above.end());
        pairs.insert(pairs.end(), above.begin(), above.end());
        depth = std::move(above);
    }
    keep_each_once();
    neighbours_.start.assign(is_piece_.size() + 1, 0);
    for (const auto& [a, b] : pairs) {
        ++neighbours_.start[a + 1];
        neighbours_.other.push_back(b);
    }
    for (std::size_t p = 0; p < is_piece_.size(); ++p) neighbours_.start[p + 1] += neighbours_.start[p];
}

bool PatchTree::are_neighbours(std::uint32_t a, std::uint32_t b) const {
    const auto first = neighbours_.other.begin();
    return std::binary_search(first + neighbours_.start[a], first + neighbours_.start[a + 1], b);
}

void PatchTree::update(std::span<const Bounds> boxes, std::span<const LeanMask> leans) {
    const std::uint32_t first = leaves() - 1;
    for (std::uint32_t leaf = 0; leaf < leaves(); ++leaf) {
        Bounds box;
        LeanMask shared = all_leans;
        for (const std::uint32_t t : triangles_of(leaf)) {
            box.add(boxes[t]);
            shared &= leans[t];
        }
        boxes_[first + leaf] = box;
        leans_[first + leaf] = shared;
    }
    for (std::uint32_t p = first; p-- > 0;) {
        boxes_[p] = boxes_[2 * p + 1];
        boxes_[p].add(boxes_[2 * p + 2]);
        leans_[p] = leans_[2 * p + 1] & leans_[2 * p + 2];
    }
}

void PatchTree::find_pairs(std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    pairs.clear();
    visit_one(0, pairs);
}

void PatchTree::visit_one(std::uint32_t patch, std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    if (is_piece_[patch] && leans_[patch] != 0) return;
    if (is_leaf(patch)) {
        pairs.push_back({patch + 1 - leaves(), patch + 1 - leaves()});
        return;
    }
    visit_one(2 * patch + 1, pairs);
    visit_one(2 * patch + 2, pairs);
    visit_two(2 * patch + 1, 2 * patch + 2, pairs);
}

void PatchTree::visit_two(std::uint32_t a, std::uint32_t b, std::vector<std::array<std::uint32_t, 2>>& pairs) const {
    if (!overlaps(boxes_[a], boxes_[b])) return;
    if ((leans_[a] & leans_[b]) != 0 && is_piece_[a] && is_piece_[b] && are_neighbours(a, b)) return;
    if (is_leaf(a)) {
        pairs.push_back({a + 1 - leaves(), b + 1 - leaves()});
        return;
    }
    for (const std::uint32_t of_a : {2 * a + 1, 2 * a + 2}) {
        for (const std::uint32_t of_b : {2 * b + 1, 2 * b + 2}) visit_two(of_a, of_b, pairs);
    }
}

}  // namespace embody::physics::deformable
