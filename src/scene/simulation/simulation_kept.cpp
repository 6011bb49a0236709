// SPDX-License-Identifier: MIT
// Forms of a run that a document keeps (docs/time.md).
#include <algorithm>

#include "scene/matter/fluid_body.h"
#include "scene/matter/soft_nodes.h"
#include "scene/simulation/moment.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

namespace {

constexpr double same_place = 1e-9;  // m: rounding of a pose that moves the points to and fro

bool are_same_places(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return std::ranges::equal(a, b, [](Vec3 one, Vec3 other) { return length(one - other) <= same_place; });
}

// Whether a form without a point is another one than that it is modelled in.
bool keeps_nothing(const LiveEntity& entity) {
    return as_liquid(entity.points.get()) != nullptr && !entity.definition.starts_empty;
}

// `positions` in the world, `pose` of the entity's frame.
SharedOptional<KeptForm> form_of(const LiveEntity& entity, std::vector<Vec3> positions, const Transform& pose,
                                 const physics::LastingDeformation& lasting) {
    for (Vec3& position : positions) position = inverse_transform_point(pose, position);
    KeptForm form{.fingerprint = entity.form.kept_fit.fingerprint,
                  .plastic_strain = packed(lasting.plastic_strain),
                  .broken = lasting.broken_segments,
                  .bend = packed(lasting.bend),
                  .torn = packed(lasting.torn_corners)};
    if (const FluidBody* liquid = as_liquid(entity.points.get())) form.cell_size = liquid->cell_size();

    const SharedOptional<KeptForm>& before = entity.definition.kept;
    if (before && before->plastic_strain == form.plastic_strain && before->broken == form.broken &&
        before->bend == form.bend && before->torn == form.torn && are_same_places(places_of(*before), positions))
        return before;
    const SoftNodes* soft = as_soft(entity.points.get());
    if (soft != nullptr && lasting.plastic_strain.empty() && lasting.broken_segments.empty() && lasting.bend.empty() &&
        lasting.torn_corners.empty() && are_same_places(soft->definition().nodes, positions))
        return {};
    form.places = packed(positions);
    return form;
}

}  // namespace

SharedOptional<KeptForm> Simulation::kept_form(EntityIndex index) const {
    const LiveEntity* entity = state_->find(index);
    if (!entity || !entity->points || !entity->definition.enabled) return {};
    std::vector<Vec3> positions;
    entity->points->read(positions);
    if (positions.empty() && !keeps_nothing(*entity)) return {};
    const SoftNodes* soft = as_soft(entity->points.get());
    physics::LastingDeformation lasting = soft ? soft->lasting_deformation() : physics::LastingDeformation{};
    // A wire's clamps take the direction that it has when a run begins: it is not bent against them then.
    if (soft != nullptr && std::holds_alternative<physics::Rope>(soft->definition().matter)) {
        for (auto& bend : lasting.bend) std::fill(bend.begin() + 2, bend.end(), 0.0);
    }
    return form_of(*entity, std::move(positions), state_->pose_of(*entity), lasting);
}

SharedOptional<KeptForm> Simulation::kept_form(const EntityMoment& was, std::vector<std::uint32_t> broken) const {
    const LiveEntity* entity = state_->find(was.motion.entity);
    if (!entity || !entity->points || !entity->definition.enabled || !was.points) return {};
    std::vector<Vec3> positions;
    was.points->read(positions);
    if (positions.empty() && !keeps_nothing(*entity)) return {};
    physics::LastingDeformation lasting{.broken_segments = std::move(broken)};
    if (const SoftNodes* soft = as_soft(entity->points.get()))
        lasting.torn_corners = soft->torn_corners(positions.size());
    return form_of(*entity, std::move(positions), was.motion.pose, lasting);
}

}  // namespace embody::scene
