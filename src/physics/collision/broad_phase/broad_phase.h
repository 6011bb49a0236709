// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "foundation/task_pool.h"
#include "math/bounds.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Finds the pairs of bodies whose bounds may meet within a step. Bounds are kept enlarged by a margin, so that a body
/// that moves little costs nothing; those of faster bodies travel with them, so that of two bodies only the motion
/// relative to each other counts. Movable and immovable bodies have a tree each.
class BroadPhase {
public:
    BroadPhase();
    ~BroadPhase();

    /// `body` is the caller's index, unique among the proxies. Two immovable bodies are never a pair.
    void insert(std::uint32_t body, const Bounds& bounds, bool movable);
    void remove(std::uint32_t body);
    /// Sets new bounds, and by how much they travel in the step (m, along a straight line); cheap while the enlarged
    /// ones hold them on all of the path.
    void move(std::uint32_t body, const Bounds& bounds, Vec3 motion);
    /// Whether move() would change nothing. May be asked by several threads.
    [[nodiscard]] bool holds(std::uint32_t body, const Bounds& bounds, Vec3 motion) const;

    /// Whether the body is one of the proxies and its enlarged bounds, all along their path, contain these.
    [[nodiscard]] bool covers(std::uint32_t body, const Bounds& bounds) const;

    struct Pair {
        std::uint32_t a = 0, b = 0;  ///< a < b
        friend auto operator<=>(const Pair&, const Pair&) = default;
    };
    /// All pairs whose enlarged bounds meet on their paths, sorted; each once, whatever the number of workers.
    const std::vector<Pair>& update_pairs(TaskPool& workers);

    /// Whether more bodies overlap than there may be pairs: then each movable body keeps pairs with `max_partners`
    /// movable and `max_immovable_partners` immovable ones, those of the lowest indices above its own.
    [[nodiscard]] bool has_too_many_pairs() const;
    static constexpr std::size_t max_partners = 32, max_immovable_partners = 256;  // of a body

    /// Changes with each change of the pairs.
    [[nodiscard]] std::uint64_t pairs_version() const;

    /// Calls `visit` for each body whose enlarged bounds overlap `box` somewhere on their path, in ascending order of
    /// index.
    void query(const Bounds& box, const std::function<void(std::uint32_t)>& visit) const;
    /// Calls `visit` for bodies whose bounds the ray may meet; it returns the new maximal distance (smaller after a
    /// hit).
    void query_ray(Vec3 origin, Vec3 direction, double max_distance,
                   const std::function<double(std::uint32_t, double)>& visit) const;

    /// Calls `visit` for the boxes of both trees, those around others first, from depth 0 downwards; for debugging.
    /// Bodies too wide for a tree are in neither.
    void visit_boxes(const std::function<void(const Bounds&, int depth)>& visit) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::physics::collision
