// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "math/vec3.h"
#include "physics/collision/namespace.h"

namespace embody::physics::collision {

/// Narrow phase memory of a pair from one step to the next (40 bytes). Value-initialised: nothing known. It
/// belongs to one ordered pair of shapes; clear it when a shape changes. Poses may jump: the remembered features are
/// only tried first, so the contacts are those of an empty memory.
struct PairMemory {
    enum class Kind : std::uint8_t {
        nothing,
        apart,      ///< `axis` separated the pair by more than the margin
        face_of_a,  ///< the pair met on face `feature_a` of a
        face_of_b,  ///< … on face `feature_b` of b
        edges,      ///< … where edge `feature_a` of a crosses edge `feature_b` of b
        along,      ///< … along `axis`, at faces or sides
        crossing,   ///< … along `axis`, where edges, rims or sides cross
    };
    Vec3 axis;  ///< of `apart`, `along` and `crossing`: unit, in the frame of the piece compared first, towards the
                ///< other
    double gap = 0;  ///< of `apart`: lower bound of the distance between the shapes, m; 0 where it is not known
    std::uint16_t feature_a = 0, feature_b = 0;
    Kind kind = Kind::nothing;

    void part_along(Vec3 direction, double at_least) {
        axis = direction;
        gap = at_least;
        kind = Kind::apart;
    }
    void meet_along(Vec3 direction, bool is_crossing) {
        axis = direction;
        kind = is_crossing ? Kind::crossing : Kind::along;
    }
};
static_assert(sizeof(PairMemory) <= 40);

}  // namespace embody::physics::collision
