// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "math/rotation_part.h"
#include "physics/deformable/contact/nearest_points.h"
#include "physics/inter/world.h"
#include "physics/stages/deformable/thin_groups.h"
#include "physics/stages/rigid/wake.h"
#include "physics/state/world_state.h"

namespace embody::physics {

using namespace state;
using namespace stages;

namespace {

Result<void> check_attachments(const World& world, const std::vector<Attachment>& attachments) {
    for (std::size_t i = 0; i < attachments.size(); ++i) {
        if (!world.contains(attachments[i].body))
            return Error{"attachments[" + std::to_string(i) + "]", "is to a body that is not one of this world"};
    }
    return {};
}

// `own`: null for a deformable that is not yet created.
Result<void> check_ties(const World& world, DeformableHandle own, const std::vector<Tie>& ties) {
    for (std::size_t i = 0; i < ties.size(); ++i) {
        const std::string where = "ties[" + std::to_string(i) + "]";
        const DeformableDefinition* other = world.deformable(ties[i].other);
        if (other == nullptr) return Error{where, "is to a deformable that is not one of this world"};
        if (ties[i].other == own) return Error{where, "is to itself", "tie it to another sheet, rope or solid"};
        for (std::size_t k = 0; k < 3; ++k) {
            if (ties[i].weight[k] > 0 && ties[i].other_nodes[k] >= other->nodes.size())
                return Error{where + ".other_nodes", "has one that is no node of the other"};
        }
    }
    return {};
}

Result<DeformableRecord> make_record(const World& world, DeformableHandle own, const DeformableDefinition& definition) {
    if (auto result = validate(definition); !result) return result.error();
    if (auto result = check_attachments(world, definition.attachments); !result) return result.error();
    if (auto result = check_ties(world, own, definition.ties); !result) return result.error();
    return make_deformable_record(definition);
}

Vec3 center_of(const Nodes& nodes) {
    Vec3 sum;
    double whole = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        sum += nodes.mass[i] * nodes.position[i];
        whole += nodes.mass[i];
    }
    return sum / whole;
}

// The rotation R and shift nearest to x = R X + t of all nodes: A = Σ m (x - c)(X - C)ᵀ, max tr(Rᵀ A).
Transform nearest_rigid_motion(const DeformableRecord& record) {
    const Nodes& nodes = record.nodes();
    const std::vector<Vec3>& rest = record.definition.nodes;
    const Vec3 center = center_of(nodes);
    Vec3 rest_center;
    double whole = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        rest_center += nodes.mass[i] * rest[i];
        whole += nodes.mass[i];
    }
    rest_center = rest_center / whole;
    Mat3 moments = Mat3::zero();
    double size = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 arm = rest[i] - rest_center;
        moments += nodes.mass[i] * outer(nodes.position[i] - center, arm);
        size += nodes.mass[i] * length_squared(arm);
    }
    Quat rotation = record.rotation();
    if (size > 0) follow_rotation((3 / size) * moments, rotation);
    return {center - rotate(rotation, rest_center), rotation};
}

// Called by everything that changes a deformable from outside.
void wake_up(DeformableRecord& record) {
    record.is_asleep = false;
    record.quiet_time = 0;
}

const Error no_such_deformable{"deformable", "is not one of this world"};

}  // namespace

Result<DeformableHandle> World::create_deformable(const DeformableDefinition& definition) {
    auto record = make_record(*this, {}, definition);
    if (!record) return record.error();
    return state_->deformables.records.insert(std::move(*record));
}

Result<void> World::destroy_deformable(DeformableHandle deformable) {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    for (const std::uint32_t body : record->touched_bodies) {
        if (state_->rigid.is_used(body)) wake_later(state_->activity, body);
    }
    state_->deformables.records.remove(deformable);
    forget_thin_contacts(state_->deformables, deformable.index);
    for (std::uint32_t slot = 0; slot < state_->deformables.records.slot_count(); ++slot) {
        if (!state_->deformables.records.used(slot)) continue;
        std::erase_if(state_->deformables.records.at(slot).surface_pushes,
                      [&](const SurfacePush& push) { return push.slot == deformable.index; });
    }
    return {};
}

std::vector<DeformableHandle> World::deformables() const {
    std::vector<DeformableHandle> handles;
    for (std::uint32_t slot = 0; slot < state_->deformables.records.slot_count(); ++slot) {
        if (state_->deformables.records.used(slot)) handles.push_back(state_->deformables.records.handle_at(slot));
    }
    return handles;
}

const DeformableDefinition* World::deformable(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? &record->definition : nullptr;
}

std::span<const Vec3> World::node_positions(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? std::span<const Vec3>(record->nodes().position) : std::span<const Vec3>();
}

std::span<const Vec3> World::node_velocities(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? std::span<const Vec3>(record->nodes().velocity) : std::span<const Vec3>();
}

std::span<const double> World::node_masses(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? std::span<const double>(record->nodes().mass) : std::span<const double>();
}

bool World::is_asleep(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record == nullptr || record->is_asleep;
}

Transform World::pose(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? nearest_rigid_motion(*record) : Transform{};
}

double World::mass(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    double sum = 0;
    if (record != nullptr) {
        for (const double mass : record->nodes().mass) sum += mass;
    }
    return sum;
}

Vec3 World::center_of_mass(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    return record != nullptr ? center_of(record->nodes()) : Vec3{};
}

Result<void> World::wake(DeformableHandle deformable) {
    DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    wake_up(*record);
    return {};
}

Result<void> World::set_nodes(DeformableHandle deformable, std::span<const Vec3> positions,
                              std::span<const Vec3> velocities) {
    DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    const std::size_t count = record->definition.nodes.size();
    for (const auto& [field, values] : {std::pair{"positions", positions}, {"velocities", velocities}}) {
        if (values.size() != count) return Error{field, "must be " + std::to_string(count) + ", one a node"};
        if (!std::ranges::all_of(values, [](Vec3 v) { return is_finite(v); }))
            return Error{field, "must be finite numbers"};
    }
    // Positions first: the rotation of the whole follows from them.
    record->set_motion(positions, velocities, record->definition.pose.rotation);
    record->set_motion(positions, velocities, nearest_rigid_motion(*record).rotation);
    record->last_positions = record->nodes().position;
    record->contacts.clear();
    forget_thin_contacts(state_->deformables, deformable.index);
    wake_up(*record);
    return {};
}

LastingDeformation World::lasting_deformation(DeformableHandle deformable) const {
    const DeformableRecord* record = state_->deformables.records.find(deformable);
    LastingDeformation lasting;
    if (record != nullptr && record->solid()) lasting.plastic_strain = record->solid()->plastic_strain();
    if (record != nullptr && record->cloth()) lasting.bend = record->cloth()->bend_memory().state();
    if (record != nullptr && record->rope()) lasting.bend = record->rope()->folds().state();
    if (record != nullptr) lasting.torn_corners = record->torn;
    lasting.broken_segments = broken_segments(deformable);
    return lasting;
}

Result<void> World::set_lasting_deformation(DeformableHandle deformable, const LastingDeformation& lasting) {
    DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    const auto& [strains, broken, bend, torn] = lasting;
    const auto* solid = std::get_if<SoftSolid>(&record->definition.matter);
    const std::size_t parts = solid != nullptr ? solid->tetrahedra.size() + record->nodes().size() : 0;
    if (!strains.empty() && strains.size() != parts)
        return Error{"plastic_strain",
                     "must be " + std::to_string(parts) + ", one a tetrahedron and one a node of a soft solid"};
    const auto is_number = [](const auto& strain) {
        return std::ranges::all_of(strain, [](double part) { return std::isfinite(part); });
    };
    if (!std::ranges::all_of(strains, is_number)) return Error{"plastic_strain", "must be finite numbers"};
    const std::size_t segments = record->rope() ? record->nodes().size() - 1 : 0;
    if (std::ranges::any_of(broken, [segments](std::uint32_t segment) { return segment >= segments; }))
        return Error{"broken_segments", "has one that is no segment of the rope"};
    const std::size_t bent = record->cloth()  ? record->cloth()->triangles().size()
                             : record->rope() ? record->nodes().size()
                                              : 0;
    if (!bend.empty() && bend.size() != bent)
        return Error{"bend", "must be " + std::to_string(bent) + ", one a triangle of a sheet or a node of a rope"};
    if (!std::ranges::all_of(bend, is_number)) return Error{"bend", "must be finite numbers"};
    const std::size_t before = record->torn.size();
    if (torn.size() < before || !std::equal(record->torn.begin(), record->torn.end(), torn.begin()))
        return Error{"torn_corners", "do not begin with those that the sheet has", "set them on a sheet that is whole"};
    if (torn.size() > before) {
        Result<DeformableRecord> made = make_torn_record(*record, std::span(torn).subspan(before));
        if (!made) return made.error();
        *record = std::move(*made);
        forget_thin_contacts(state_->deformables, deformable.index);
    }
    if (solid != nullptr) record->solid()->set_plastic_strain(strains);
    if (record->cloth()) record->cloth()->bend_memory().set_state(bend);
    if (record->rope()) record->rope()->folds().set_state(bend);
    for (std::uint32_t segment = 0; segment < segments; ++segment)
        record->rope()->set_broken(segment, std::ranges::find(broken, segment) != broken.end());
    wake_up(*record);
    return {};
}

Result<void> World::set_deformable(DeformableHandle deformable, const DeformableDefinition& definition) {
    DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    DeformableDefinition torn = definition;
    if (definition.nodes.size() < record->definition.nodes.size()) {
        if (auto as_before = tear(torn, record->torn); !as_before) return as_before;
    }
    auto changed = make_record(*this, deformable, torn);
    if (!changed) return changed.error();
    if (torn.nodes.size() != record->definition.nodes.size())
        return Error{"nodes", "are not as many as before", "make another deformable in its place"};
    const Nodes& nodes = record->nodes();
    changed->set_motion(nodes.position, changed->solid() ? nodes.velocity : nodes.mean_velocity,
                        nearest_rigid_motion(*record).rotation);
    if (changed->has_tetrahedra_of(*record)) changed->solid()->take_plastic_strain(*record->solid());
    changed->last_positions = nodes.position;
    changed->contacts = std::move(record->contacts);
    changed->touched_bodies = std::move(record->touched_bodies);
    if (changed->rope() && record->rope()) changed->rope()->go_on_from(*record->rope());
    if (changed->cloth() && record->cloth()) changed->cloth()->go_on_from(*record->cloth());
    if (changed->has_surface_of(*record)) changed->torn = record->torn;
    // Contacts with others are known by the numbers of edges and triangles.
    if (!changed->has_surface_of(*record)) forget_thin_contacts(state_->deformables, deformable.index);
    *record = std::move(*changed);
    return {};
}

Result<void> World::set_attachments(DeformableHandle deformable, const std::vector<Attachment>& attachments,
                                    const std::vector<Clamp>& clamps, const std::vector<Tie>& ties) {
    DeformableRecord* record = state_->deformables.records.find(deformable);
    if (record == nullptr) return no_such_deformable;
    if (auto result = check_attachments(*this, attachments); !result) return result;
    if (auto result = check_ties(*this, deformable, ties); !result) return result;
    DeformableDefinition changed = record->definition;
    changed.attachments = attachments;
    changed.clamps = clamps;
    changed.ties = ties;
    if (auto result = validate(changed); !result) return result;
    record->definition = std::move(changed);
    record->tie_pulls.clear();
    wake_up(*record);
    return {};
}

std::optional<Tie> World::nearest_tie(std::uint32_t node, DeformableHandle other, Vec3 place) const {
    const DeformableRecord* record = state_->deformables.records.find(other);
    if (record == nullptr) return std::nullopt;
    const std::vector<Vec3>& at = record->nodes().position;
    std::optional<Tie> nearest;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](std::array<std::uint32_t, 3> nodes, std::array<double, 3> weight) {
        Vec3 away = place;
        for (std::size_t k = 0; k < 3; ++k) away -= weight[k] * at[nodes[k]];
        if (length(away) >= least) return;
        least = length(away);
        nearest = Tie{node, other, nodes, weight};
    };
    for (std::uint32_t s = 0; record->rope() && s + 1 < at.size(); ++s) {
        if (record->rope()->is_broken(s)) continue;
        const double along = nearest_along(place, at[s], at[s + 1]);
        consider({s, s + 1, s}, {1 - along, along, 0});
    }
    const auto consider_all = [&](const std::vector<std::array<std::uint32_t, 3>>& triangles) {
        for (const auto& t : triangles) consider(t, nearest_weights(place, at[t[0]], at[t[1]], at[t[2]]));
    };
    if (record->cloth()) consider_all(std::get<Cloth>(record->definition.matter).triangles);
    if (record->solid()) consider_all(record->solid()->surface());
    return nearest;
}

std::span<const double> World::rope_tensions(DeformableHandle rope) const {
    const DeformableRecord* record = state_->deformables.records.find(rope);
    return record != nullptr && record->rope() ? record->rope()->tensions() : std::span<const double>();
}

std::span<const RopeTwist> World::rope_twists(DeformableHandle rope) const {
    const DeformableRecord* record = state_->deformables.records.find(rope);
    return record != nullptr && record->rope() ? record->rope()->twists() : std::span<const RopeTwist>();
}

std::optional<GasInside> World::gas_inside(DeformableHandle sheet) const {
    const DeformableRecord* record = state_->deformables.records.find(sheet);
    if (record == nullptr || !record->cloth() || !record->cloth()->gas().is_active()) return std::nullopt;
    const double volume = record->cloth()->gas().volume(record->nodes().position);
    return GasInside{volume, record->cloth()->gas().pressure(volume)};
}

std::vector<std::uint32_t> World::broken_segments(DeformableHandle rope) const {
    std::vector<std::uint32_t> broken;
    for (std::uint32_t s = 0; s < rope_tensions(rope).size(); ++s) {
        if (state_->deformables.records.find(rope)->rope()->is_broken(s)) broken.push_back(s);
    }
    return broken;
}

}  // namespace embody::physics
