// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "scene/session/placement.h"
#include "scene/session/session_state.h"

namespace embody::scene {

// What holds of walls, doors and windows after every edit (docs/rooms.md).

/// Adds to an edit what walls need to fit each other and what stands in them: corners are mitred where ends of walls
/// meet, doors and windows cut the wall that they stand in and no other, and go with it where it is moved. Part of the
/// same step of undo.
void complete_building(SessionState& state, Edit& edit);

/// Whether the two are walls that differ in openings and mitred ends alone, which a lock does not keep.
bool are_same_wall(const Geometry& a, const Geometry& b);

/// Where a door or a window comes to stand in the wall that the ray meets: in the middle of its thickness, doors at its
/// foot. None for other things, and where the ray meets no wall that is nearer than `distance`.
std::optional<Placement> place_in_wall(SessionState& state, const Entity& entity, const PointerRay& ray,
                                       double distance);

}  // namespace embody::scene
