// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "geometry/triangle_mesh.h"
#include "math/bounds.h"

namespace embody::geometry {

/// Static tree of axis-aligned boxes over things that do not move, such as the triangles of a terrain. Built by the
/// surface area heuristic in bins (I. Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007).
/// Equal leaves give the same tree and order of visits. Boxes are kept in single precision, rounded outwards.
class BoundingVolumeTree {
public:
    BoundingVolumeTree() = default;
    /// One leaf for each box, known by its index. Boxes that are empty or not finite are never visited.
    explicit BoundingVolumeTree(std::span<const Bounds> leaves);
    /// One leaf for each triangle.
    explicit BoundingVolumeTree(const TriangleMesh& mesh);

    [[nodiscard]] bool is_empty() const { return nodes_.empty(); }
    /// Number of leaves that can be visited.
    [[nodiscard]] std::uint32_t leaf_count() const { return static_cast<std::uint32_t>(leaf_indices_.size()); }
    /// Box around everything; empty where there are no leaves.
    [[nodiscard]] Bounds bounds() const;
    [[nodiscard]] std::size_t memory_bytes() const;

    /// Calls visit(std::uint32_t leaf) for each leaf whose box overlaps `box`.
    template <class Visit>
    void query(const Bounds& box, Visit&& visit) const;

    /// Follows the ray origin + t direction, 0 ≤ t ≤ max_t, roughly nearest boxes first. Calls
    /// visit(std::uint32_t leaf, double max_t) for each leaf whose box it meets; the answer is the new max_t (return
    /// the old one on a miss, the distance on a hit, a negative number to stop). `direction` need not be a unit vector.
    template <class Visit>
    void query_ray(Vec3 origin, Vec3 direction, double max_t, Visit&& visit) const;

private:
    // Box in floats that contains the one in doubles.
    struct Box {
        std::array<float, 3> lower, upper;
    };
    // Inner nodes (count 0) have their first child next to them and the second at `link`; leaf nodes hold the leaves
    // link … link + count - 1.
    struct Node {
        Box box;
        std::uint32_t link = 0;
        std::uint32_t count = 0;
    };
    static_assert(sizeof(Node) == 32);  // two to a cache line

    struct Ray {
        std::array<double, 3> origin, inverse;
    };
    struct Builder;
    // The builder turns to median splits at depth 40, which with fewer than 2^32 leaves keeps the depth below this.
    static constexpr int max_depth = 80;

    static Box rounded_outwards(const Bounds& b);
    // A box that many others are compared with, without branches: which of the six comparisons fails cannot be
    // predicted.
    struct Window {
#if defined(__SSE2__)
        __m128 most, least;  // of a box's numbers 0 … 3 (those of `lower` count) and 2 … 5 (of `upper`)

        explicit Window(const Box& b)
            : most(_mm_setr_ps(b.upper[0], b.upper[1], b.upper[2], std::numeric_limits<float>::infinity())),
              least(_mm_setr_ps(-std::numeric_limits<float>::infinity(), b.lower[0], b.lower[1], b.lower[2])) {}
        [[nodiscard]] bool overlaps(const Box& a) const {
            static_assert(sizeof(Box) == 6 * sizeof(float));
            const auto* numbers = reinterpret_cast<const float*>(&a);
            const __m128 lower = _mm_loadu_ps(numbers), upper = _mm_loadu_ps(numbers + 2);
            return _mm_movemask_ps(_mm_and_ps(_mm_cmple_ps(lower, most), _mm_cmpge_ps(upper, least))) == 0xF;
        }
#else
        Box box;

        explicit Window(const Box& b) : box(b) {}
        [[nodiscard]] bool overlaps(const Box& a) const {
            bool meets = true;
            for (std::size_t k = 0; k < 3; ++k) meets &= (a.lower[k] <= box.upper[k]) & (box.lower[k] <= a.upper[k]);
            return meets;
        }
#endif
    };
    static Ray prepare_ray(Vec3 origin, Vec3 direction);
    // Where the ray enters the box; NaN where it misses it before max_t, which no `<= max_t` lets through (an infinite
    // max_t is allowed, so infinity could not mean a miss).
    static double enter(const Ray& ray, const Box& box, double max_t);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_indices_;  // in the order of leaf nodes
    std::vector<Box> leaf_boxes_;              // parallel to leaf_indices_
};

template <class Visit>
void BoundingVolumeTree::query(const Bounds& bounds, Visit&& visit) const {
    if (nodes_.empty() || bounds.is_empty()) return;
    const Window window(rounded_outwards(bounds));
    std::array<std::uint32_t, max_depth> waiting;
    std::size_t count = 0;
    std::uint32_t current = 0;
    for (;;) {
        const Node& node = nodes_[current];
        if (window.overlaps(node.box)) {
            if (node.count == 0) {
                // The waiting node's memory is far away: prefetch it meanwhile.
                __builtin_prefetch(&nodes_[node.link]);
                waiting[count++] = node.link;
                ++current;
                continue;
            }
            for (std::uint32_t i = node.link; i < node.link + node.count; ++i) {
                if (window.overlaps(leaf_boxes_[i])) visit(leaf_indices_[i]);
            }
        }
        if (count == 0) return;
        current = waiting[--count];
    }
}

inline double BoundingVolumeTree::enter(const Ray& ray, const Box& box, double max_t) {
    double near = 0, far = max_t;
    for (std::size_t k = 0; k < 3; ++k) {
        const double a = (static_cast<double>(box.lower[k]) - ray.origin[k]) * ray.inverse[k];
        const double b = (static_cast<double>(box.upper[k]) - ray.origin[k]) * ray.inverse[k];
        near = std::fmax(near, std::fmin(a, b));
        far = std::fmin(far, std::fmax(a, b));
    }
    return near <= far ? near : std::numeric_limits<double>::quiet_NaN();
}

template <class Visit>
void BoundingVolumeTree::query_ray(Vec3 origin, Vec3 direction, double max_t, Visit&& visit) const {
    struct Waiting {
        std::uint32_t node;
        double enter;
    };
    if (nodes_.empty()) return;
    const Ray ray = prepare_ray(origin, direction);
    std::array<Waiting, max_depth> waiting{};
    std::size_t count = 0;
    waiting[count++] = {0, enter(ray, nodes_[0].box, max_t)};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (!(next.enter <= max_t)) continue;
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            for (std::uint32_t i = node.link; i < node.link + node.count; ++i) {
                if (enter(ray, leaf_boxes_[i], max_t) <= max_t) max_t = visit(leaf_indices_[i], max_t);
                if (max_t < 0) return;
            }
            continue;
        }
        // The nearer child goes on top.
        Waiting first{next.node + 1, enter(ray, nodes_[next.node + 1].box, max_t)};
        Waiting second{node.link, enter(ray, nodes_[node.link].box, max_t)};
        if (second.enter < first.enter) std::swap(first, second);
        if (second.enter <= max_t) waiting[count++] = second;
        if (first.enter <= max_t) waiting[count++] = first;
    }
}

}  // namespace embody::geometry
