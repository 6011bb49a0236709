// SPDX-License-Identifier: MIT
#pragma once

#include "physics/stages/namespace.h"
#include "physics/state/deformable_record.h"

namespace embody {
class TaskPool;
}
namespace embody::physics {
struct WorldSettings;
}

namespace embody::physics::stages {

/// A sheet or rope in a step.
struct ThinDeformable {
    DeformableRecord* record = nullptr;
    std::vector<NodeContact> contacts;
    std::vector<SegmentContact> segment_contacts;  ///< of ropes
    std::vector<SheetContact> sheet_contacts;      ///< of sheets, between their nodes
    std::vector<Attachment> attachments;           ///< its own attachments, then its ties to solids while these hold it
    std::vector<std::uint32_t> attachment_bodies;  ///< index of each attachment's body, no_body where that is gone
};

/// Contacts that it may have in a step of these settings. `may_collide`: for each of `bodies`, those of the step.
void find_thin_contacts(std::span<const TouchedBody> bodies, const std::vector<bool>& may_collide,
                        const WorldSettings& settings, ThinDeformable& thin, TaskPool& workers);
/// One substep of a rope by itself; pushes the bodies.
void advance_rope(ThinDeformable& thin, const Substep& substep, std::span<TouchedBody> bodies);
/// Its contacts and attachments in the last substep.
std::span<const TouchSpring> springs_of(const DeformableRecord& record);
/// Slots of the bodies that it pushed in the last substep, ascending.
std::vector<std::uint32_t> bodies_pushed_by(const DeformableRecord& record, std::span<const TouchedBody> bodies);

}  // namespace embody::physics::stages
