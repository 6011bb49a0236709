// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "math/vec3.h"
#include "physics/collision/manifold.h"

namespace embody::physics {

/// What the solver found at a contact point, kept for the next step.
struct CachedPoint {
    std::uint32_t piece_a = 0, piece_b = 0, feature = 0;  ///< as in the Manifold it comes from
    Vec3 position;               ///< m, in a frame in which the point moves little from step to step: body a's is best
    double normal_impulse = 0;   ///< N s
    Vec3 friction_impulse;       ///< on b, world axes, N s
    double torsion_impulse = 0;  ///< about the normal, N m s
    Vec3 rolling_impulse;        ///< on b, world axes, N m s
};

/// The contact cache of the paper (III.B, "Algorithm Contact caching"): last step's points are asked for while this
/// step's are generated, and each step's cache is built from scratch.
class ContactCache {
public:
    struct Key {
        std::uint32_t body_a = 0, body_b = 0;
        friend auto operator<=>(const Key&, const Key&) = default;
    };

    /// Last step's point to start from: the one with the same pieces and feature, else the nearest one of the pair
    /// within `tolerance` (m); nullptr for a new contact. A point is handed out once a step. Cost: log of the number of
    /// points.
    const CachedPoint* find(Key key, const CachedPoint& wanted, double tolerance);
    /// Keeps a point for the next step.
    void put(Key key, const CachedPoint& point);
    /// Ends the step: what was put is what can be found from now on.
    void turn_over();
    /// Forgets a body's points (removed, teleported).
    void forget(std::uint32_t body);
    void clear();
    [[nodiscard]] std::size_t size() const { return last_.size(); }

private:
    struct Entry {
        Key key;
        CachedPoint point;
        bool taken = false;
    };
    std::vector<Entry> last_;  // sorted by key
    std::vector<Entry> next_;
};

}  // namespace embody::physics
