// SPDX-License-Identifier: MIT
#include "foundation/assert.h"
#include "physics/inter/world.h"
#include "physics/stages/deformable/thin_groups.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;

namespace {

// By node: whether something holds it, or is tied to it.
std::vector<std::uint8_t> held_nodes(const DeformableState& deformables, std::uint32_t sheet) {
    const DeformableDefinition& definition = deformables.records.at(sheet).definition;
    std::vector<std::uint8_t> held(definition.nodes.size(), 0);
    for (const std::uint32_t node : definition.pinned) held[node] = 1;
    for (const Attachment& attachment : definition.attachments) held[attachment.node] = 1;
    for (const Tie& tie : definition.ties) held[tie.node] = 1;
    const DeformableHandle own = deformables.records.handle_at(sheet);
    for (std::uint32_t slot = 0; slot < deformables.records.slot_count(); ++slot) {
        if (!deformables.records.used(slot)) continue;
        for (const Tie& tie : deformables.records.at(slot).definition.ties) {
            for (std::size_t k = 0; tie.other == own && k < 3; ++k) {
                if (tie.weight[k] > 0) held[tie.other_nodes[k]] = 1;
            }
        }
    }
    return held;
}

}  // namespace

// Sheets whose tension is too much tear; the torn ones take their places.
void World::tear_sheets() {
    state_->events.sheet_tears.clear();
    for (std::uint32_t slot = 0; slot < state_->deformables.records.slot_count(); ++slot) {
        if (!state_->deformables.records.used(slot)) continue;
        DeformableRecord& record = state_->deformables.records.at(slot);
        const ClothSheet* sheet = record.cloth();
        if (sheet == nullptr || !sheet->tear().is_active() || record.is_asleep || !record.definition.enabled ||
            sheet->is_frozen())
            continue;
        const std::vector<TornCorner> corners =
            sheet->tear().find(sheet->triangles(), sheet->stress(), held_nodes(state_->deformables, slot));
        if (corners.empty()) continue;
        const std::size_t before = record.nodes().size();
        Result<DeformableRecord> torn = make_torn_record(record, corners);
        EMBODY_ASSERT(torn.ok());  // it is the same sheet
        record = std::move(*torn);
        stages::forget_thin_contacts(state_->deformables, slot);
        state_->events.sheet_tears.push_back({state_->deformables.records.handle_at(slot), record.definition.user_data,
                                              static_cast<std::uint32_t>(record.nodes().size() - before),
                                              record.nodes().position[before]});
    }
}

}  // namespace embody::physics
