// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/contact/pair_springs.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_deformables.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// A tie between two of a group, by index in its members.
struct ThinTie {
    std::uint32_t member = 0, other = 0;
    std::size_t index = 0;  ///< among the ties of `member`
};

/// Sheets and ropes that may touch each other in a step, or are tied: they are solved together (docs/physics/cloth.md).
struct ThinGroup {
    std::vector<std::uint32_t> members;  ///< indices in the list of all that move, ascending; often one alone
    std::vector<ThinPair> pairs;         ///< by index in `members`
    std::vector<ThinTie> ties;
    bool in_substeps = false;  ///< solved in each substep: has a rope, or is tied to a solid
};

/// Wakes sleeping sheets and ropes that an awake one is going to touch, and what is tied to awake ones. Returns whether
/// any was woken.
bool wake_touched_thin(const DeformableAccess& world);
/// Each of `thin` in one group; forgets contacts of pairs that have separated. Ascending by first member.
std::vector<ThinGroup> find_thin_groups(const DeformableAccess& world, std::span<const ThinDeformable> thin,
                                        std::span<const TouchedBody> bodies);
/// Substep k of 1 … `substeps` of the deformables for all groups: groups with ropes or tied to solids in each, sheets
/// alone once for the whole step, in the last. Pushes the bodies, notes ropes that break.
void advance_thin_groups(const DeformableAccess& world, std::span<const ThinGroup> groups,
                         std::span<ThinDeformable> thin, std::vector<TouchedBody>& bodies, int k, int substeps);
/// Forgets the contacts of the deformable of that slot with others.
void forget_thin_contacts(DeformableState& deformables, std::uint32_t slot);

}  // namespace embody::physics::stages
