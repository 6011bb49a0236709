// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/solid_ties.h"

#include <algorithm>
#include <utility>

#include "foundation/task_pool.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/access.h"
#include "physics/state/deformable_state.h"

namespace embody::physics::stages {

namespace {

constexpr std::uint32_t first_tie_slot = 0xC0000000u;  // beyond all slots of bodies, and solids that sheets lie on

template <class Visit>
void for_each_node(const Tie& tie, Visit visit) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (tie.weight[k] > 0) visit(tie.other_nodes[k], tie.weight[k]);
    }
}

const DeformableRecord* solid_of(const DeformableAccess& world, const Tie& tie) {
    const DeformableRecord* other = world.deformables.records.find(tie.other);
    return other != nullptr && other->solid() && other->definition.enabled && !other->is_asleep ? other : nullptr;
}

}  // namespace

bool is_tied(const DeformableRecord& thin, std::uint32_t node, DeformableHandle other) {
    return std::ranges::any_of(thin.definition.ties,
                               [&](const Tie& tie) { return tie.node == node && tie.other == other; });
}

bool has_solid_ties(const DeformableAccess& world, const DeformableRecord& thin) {
    return std::ranges::any_of(thin.definition.ties, [&](const Tie& tie) { return solid_of(world, tie) != nullptr; });
}

void SolidTies::add(ThinDeformable& thin, std::vector<TouchedBody>& bodies, double h) {
    const DeformableRecord& record = *thin.record;
    held_.clear();
    for (std::size_t t = 0; t < record.definition.ties.size(); ++t) {
        if (solid_of(world_, record.definition.ties[t]) != nullptr)
            held_.push_back({record.definition.ties[t].other.index, 0, t});
    }
    std::ranges::stable_sort(held_, {}, &Held::slot);
    for (auto first = held_.begin(); first != held_.end();) {
        const auto last = std::find_if(first, held_.end(), [&](const Held& at) { return at.slot != first->slot; });
        find_compliance(record, *world_.deformables.records.at(first->slot).solid(), std::span(first, last));
        first = last;
    }
    for (Held& held : held_) {
        const Tie& tie = record.definition.ties[held.tie];
        const SolidDeformable& solid = *world_.deformables.records.at(held.slot).solid();
        Vec3 apart = record.nodes().position[tie.node], place;  // when the substep began; the solid's at its end
        for_each_node(tie, [&](std::uint32_t node, double weight) {
            apart -= weight * solid.start(node);
            place += weight * solid.nodes().position[node];
        });
        const double distance = length(apart), most = world_.settings.solver.deformable.thin_contact.recovery_speed * h;
        if (distance > most) place += (1 - most / distance) * apart;
        // Place of the solid's point without the pull that its substep has included.
        TouchedBody point;
        point.body = first_tie_slot + held.slot;
        point.start_center = place + held.compliance * record.tie_pulls[held.tie];
        point.start.position = point.start_center;
        point.inverse_mass = held.compliance / (h * h);
        held.body = static_cast<std::uint32_t>(bodies.size());
        bodies.push_back(point);
        thin.attachments.push_back({tie.node, {}, {}});
        thin.attachment_bodies.push_back(held.body);
    }
}

// Compliance of each point if all are pulled alike: larger than that of one alone, so that no response overshoots.
void SolidTies::find_compliance(const DeformableRecord& thin, SolidDeformable& solid, std::span<Held> held) {
    force_.assign(solid.nodes().size(), {});
    move_.resize(solid.nodes().size());
    const Vec3 down = normalized(world_.settings.gravity, {0, -1, 0});
    for (const Held& at : held) {
        const Vec3 displacement = normalized(-thin.tie_pulls[at.tie], down);
        for_each_node(thin.definition.ties[at.tie],
                      [&](std::uint32_t node, double weight) { force_[node] += weight * displacement; });
    }
    solid.find_response(force_, move_, world_.workers);
    for (Held& at : held) {
        Vec3 moved;
        for_each_node(thin.definition.ties[at.tie],
                      [&](std::uint32_t node, double weight) { moved += weight * move_[node]; });
        at.compliance = length(moved);
    }
}

void SolidTies::take(ThinDeformable& thin) {
    DeformableRecord& record = *thin.record;
    thin.attachments.resize(record.definition.attachments.size());
    thin.attachment_bodies.resize(thin.attachments.size());
    for (auto first = held_.begin(); first != held_.end();) {
        const auto last = std::find_if(first, held_.end(), [&](const Held& at) { return at.slot != first->slot; });
        move_solid(record, std::span(first, last));
        first = last;
    }
}

void SolidTies::move_solid(DeformableRecord& thin, std::span<const Held> held) {
    SolidDeformable& solid = *world_.deformables.records.at(held[0].slot).solid();
    force_.assign(solid.nodes().size(), {});
    for (const Held& at : held) {
        const auto springs = springs_of(thin);
        const auto spring = std::ranges::find(springs, at.body, &TouchSpring::body);
        const Vec3 felt = spring != springs.end() ? spring->felt : Vec3{};
        const Vec3 more = felt - std::exchange(thin.tie_pulls[at.tie], felt);
        for_each_node(thin.definition.ties[at.tie],
                      [&](std::uint32_t node, double weight) { force_[node] -= weight * more; });
    }
    solid.go_on_with(force_, world_.workers);
}

void SolidTies::push(const DeformableAccess& world, std::uint32_t slot, SolidDeformable& solid) {
    for (std::uint32_t other = 0; other < world.deformables.records.slot_count(); ++other) {
        if (!world.deformables.records.used(other)) continue;
        const DeformableRecord& thin = world.deformables.records.at(other);
        for (std::size_t t = 0; t < std::min(thin.tie_pulls.size(), thin.definition.ties.size()); ++t) {
            const Tie& tie = thin.definition.ties[t];
            if (tie.other != world.deformables.records.handle_at(slot) || !thin.definition.enabled) continue;
            for_each_node(tie,
                          [&](std::uint32_t node, double weight) { solid.push(node, -weight * thin.tie_pulls[t]); });
        }
    }
}

}  // namespace embody::physics::stages
