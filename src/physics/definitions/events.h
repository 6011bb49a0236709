// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "physics/definitions/body_definition.h"

namespace embody::physics {

/// Two bodies began or ceased to touch in the last step. a < b by index.
struct ContactEvent {
    enum class Kind : std::uint8_t { begin, end } kind;
    BodyHandle a, b;
    std::uint64_t user_data_a = 0, user_data_b = 0;
    Vec3 position;              ///< of the first contact point, world; only for begin
    Vec3 normal;                ///< from a to b, world; only for begin
    double approach_speed = 0;  ///< m/s along the normal before the step's impulses, >= 0; only for begin
};

/// A body fell asleep or woke in the last step.
struct SleepEvent {
    enum class Kind : std::uint8_t { fell_asleep, woke } kind;
    BodyHandle body;
    std::uint64_t user_data = 0;
};

/// A rope broke in the last step.
struct RopeBreakEvent {
    DeformableHandle rope;
    std::uint64_t user_data = 0;
    std::uint32_t segment = 0;  ///< between its nodes of this number and the next
    double tension = 0;         ///< that broke it, N
    Vec3 position;              ///< of the middle of the segment, world, m
};

/// A sheet tore at the end of the last step, by one edge or several.
struct SheetTearEvent {
    DeformableHandle sheet;
    std::uint64_t user_data = 0;
    std::uint32_t new_nodes = 0;
    Vec3 position;  ///< of the first of these, world, m
};

/// A brittle body broke at the end of the last step: the pieces are in the world in its place.
struct BodyBreakEvent {
    BodyHandle body;  ///< is gone
    std::uint64_t user_data = 0;
    Vec3 position;          ///< of the blow, world, m
    double impulse = 0;     ///< of the blow, N s
    double energy = 0;      ///< of the blow, J
    double crack_area = 0;  ///< between the pieces, m²; paid with the fracture energy of each m²
    /// Their shapes are theirs alone: destroy a piece's shape after the piece.
    std::vector<BodyHandle> pieces;
};

/// One point of a contact region after the step.
struct ContactView {
    BodyHandle a, b;
    Vec3 position;          ///< world, m
    Vec3 normal;            ///< from a to b
    double separation = 0;  ///< m, negative where the bodies overlap
    Vec3 impulse;           ///< on b over the whole step, world, N s (normal and friction part together)
};

struct RayHit {
    BodyHandle body;
    Vec3 position;        ///< world
    Vec3 normal;          ///< of the surface, world, unit
    double distance = 0;  ///< from the ray's origin, m
};

}  // namespace embody::physics
