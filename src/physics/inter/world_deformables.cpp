// SPDX-License-Identifier: MIT
#include <string>

#include "physics/inter/world.h"
#include "physics/step/world_state.h"

namespace embody::physics {

Result<DeformableHandle> World::create_deformable(const DeformableDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    for (std::size_t i = 0; i < definition.attachments.size(); ++i) {
        if (!contains(definition.attachments[i].body))
            return Error{"attachments[" + std::to_string(i) + "]", "is to a body that is not one of this world"};
    }
    auto ball = CollisionShape::create(SphereShape{definition.contact_radius});
    if (!ball) return ball.error();
    DeformableRecord record;
    record.definition = definition;
    record.solid = std::make_unique<SolidDeformable>(definition);
    record.node_ball = std::move(*ball);
    record.last_positions = record.solid->nodes().position;
    return state_->deformables.insert(std::move(record));
}

Result<void> World::destroy_deformable(DeformableHandle deformable) {
    const DeformableRecord* record = state_->deformables.find(deformable);
    if (record == nullptr) return Error{"deformable", "is not one of this world"};
    for (const std::uint32_t body : record->touched_bodies) {
        if (state_->is_used(body)) state_->to_wake.push_back(body);
    }
    state_->deformables.remove(deformable);
    return {};
}

std::vector<DeformableHandle> World::deformables() const {
    std::vector<DeformableHandle> handles;
    for (std::uint32_t slot = 0; slot < state_->deformables.slot_count(); ++slot) {
        if (state_->deformables.used(slot)) handles.push_back(state_->deformables.handle_at(slot));
    }
    return handles;
}

const DeformableDefinition* World::deformable(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.find(deformable);
    return record != nullptr ? &record->definition : nullptr;
}

std::span<const Vec3> World::node_positions(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.find(deformable);
    return record != nullptr ? std::span<const Vec3>(record->solid->nodes().position) : std::span<const Vec3>();
}

std::span<const Vec3> World::node_velocities(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.find(deformable);
    return record != nullptr ? std::span<const Vec3>(record->solid->nodes().velocity) : std::span<const Vec3>();
}

bool World::is_asleep(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.find(deformable);
    return record == nullptr || record->is_asleep;
}

Result<void> World::wake(DeformableHandle deformable) {
    DeformableRecord* record = state_->deformables.find(deformable);
    if (record == nullptr) return Error{"deformable", "is not one of this world"};
    record->is_asleep = false;
    record->quiet_time = 0;
    return {};
}

}  // namespace embody::physics
