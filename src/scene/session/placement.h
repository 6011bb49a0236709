// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "scene/session/session_state.h"

namespace embody::scene {

// Where things come to lie that a person puts somewhere with a pointer: one rule for adding, its preview and dragging.

/// Maximum length of a pointer's ray and of a fall, m.
inline constexpr double max_ray_length = 1e4;
/// Between a thing and what it is placed against, m.
inline constexpr double clearance = 1e-4;

struct PointerRay {
    Vec3 origin;
    Vec3 direction;  ///< need not be unit
};

/// What a thing is placed against.
enum class Seat : std::uint8_t { floor, wall, ceiling };
std::string to_text(Seat seat);

struct PlacementOptions {
    /// Turn backs to walls, close gaps to neighbours, centre stacks.
    bool snap = true;
    /// Entities that are not there for it.
    std::set<EntityIndex> ignored;
};

struct Placement {
    Transform pose;
    EntityIndex on = 0;  ///< what it is placed against; 0: nothing
    Seat seat = Seat::floor;
};

/// Where `entity`, in the world or not, comes to lie for a ray:
/// - What usually stands somewhere falls from where the ray meets the scene onto the first support, however far, and
///   ends in nothing else. At a wall it stands with its back to it and touches it; furniture that belongs to walls does
///   so already near one. At the side of a thing on which it can stand it is put on that thing.
/// - What usually hangs on a wall hangs where the ray meets one, turned to the room; if the ray meets a floor, at a
/// wall
///   within reach.
/// - What usually hangs from a ceiling hangs from the one that the ray meets, or from the one above that place.
Result<Placement> place_on_ray(SessionState& state, const Entity& entity, const PointerRay& ray,
                               const PlacementOptions& options);
/// The point of the entity at `pose` that place_on_ray() puts where the ray meets the scene.
Result<Vec3> placing_point(SessionState& state, const Entity& entity, Seat seat);
/// Where it is now, by its usual place and what it touches.
Seat present_seat(SessionState& state, const Entity& entity);

/// Makes `entity` stay where it hangs, or free again where it stands: what hangs is static, or pinned along its upper
/// edge if it is cloth. Returns whether something of it was changed.
bool hold_in_place(SessionState& state, Entity& entity, Seat seat);
/// Whether hold_in_place() can change it.
bool can_hang(SessionState& state, const Entity& entity);

}  // namespace embody::scene
