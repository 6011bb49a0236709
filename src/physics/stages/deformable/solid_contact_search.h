// SPDX-License-Identifier: MIT
#pragma once

#include "physics/definitions/body_definition.h"
#include "physics/stages/access.h"
#include "physics/stages/namespace.h"
#include "physics/state/deformable_record.h"

namespace embody::physics::stages {

/// Whether a deformable and a body, or another deformable, may collide.
bool may_collide(const DeformableDefinition& deformable, const BodyDefinition& body);
bool may_collide(const DeformableDefinition& a, const DeformableDefinition& b);
/// Maximum travel of its nodes within a step, and a little more, m.
double reach_of(const DeformableAccess& world, const DeformableRecord& record);

/// All contacts and attachments of soft solids for this step, record after record, with what is remembered of their
/// forces. `bodies` by slot.
std::vector<SolidContact> find_solid_contacts(const DeformableAccess& world, std::span<DeformableRecord* const> records,
                                              std::span<const TouchedBody> bodies);

/// A contact's `partner` where that is another deformable.
inline constexpr std::uint64_t first_deformable_partner = std::uint64_t{1} << 32;

}  // namespace embody::physics::stages
