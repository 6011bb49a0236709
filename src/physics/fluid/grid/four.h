// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>

#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

/// Four numbers side by side: one instruction works on all of them, on every processor alike.
using Four = float __attribute__((vector_size(16)));

/// The four numbers at an address, whatever arrays they belong to.
inline Four load_four(const void* from) {
    Four value;
    std::memcpy(&value, from, sizeof value);
    return value;
}
/// Two neighbours each of two places.
inline Four load_pairs(const float* first, const float* second) {
    using Pair = float __attribute__((vector_size(8)));
    Pair a, b;
    std::memcpy(&a, first, sizeof a);
    std::memcpy(&b, second, sizeof b);
    return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
inline void store_pairs(Four value, float* first, float* second) {
    std::memcpy(first, &value, sizeof value / 2);
    std::memcpy(second, reinterpret_cast<const char*>(&value) + sizeof value / 2, sizeof value / 2);
}

}  // namespace embody::physics::fluid
