// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/pair_springs.h"
#include "physics/step/thin_deformables.h"
#include "physics/step/world_state.h"

namespace embody::physics {

/// Sheets and ropes that may touch each other in a step: they are solved together (docs/physics/cloth.md).
struct ThinGroup {
    std::vector<std::uint32_t> members;  ///< indices in the list of all that move, ascending; often one alone
    std::vector<ThinPair> pairs;         ///< by index in `members`
    bool has_rope = false;
};

/// Wakes sleeping sheets and ropes that one that is awake is going to touch.
void wake_touched_thin(WorldState& world);
/// Each of `thin` in one group; forgets contacts of pairs that have parted. Ascending by first member.
std::vector<ThinGroup> find_thin_groups(WorldState& world, std::span<const ThinDeformable> thin);
/// Substep k (1 …) of the deformables' substeps for all groups: groups with ropes in each, sheets alone once for the
/// whole step, in the last. Pushes the bodies, notes ropes that break.
void advance_thin_groups(WorldState& world, std::span<const ThinGroup> groups, std::span<ThinDeformable> thin,
                         std::vector<TouchedBody>& bodies, int k);
/// What the deformable of that slot has touched of others is no more.
void forget_thin_contacts(WorldState& world, std::uint32_t slot);

}  // namespace embody::physics
