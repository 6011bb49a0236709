// SPDX-License-Identifier: MIT
// Connections between entities: joints, and the pins of deformable things.
#include <algorithm>
#include <limits>

#include "attributes/physical_kind.h"
#include "scene/document/document_field.h"
#include "scene/matter/soft_nodes.h"
#include "scene/simulation/simulation_state.h"

namespace embody::scene {

using attributes::PhysicalKind;
using physics::BodyHandle;
using physics::JointHandle;

namespace {

// Direction of a rope at a node, towards later nodes.
Vec3 direction_at(const std::vector<Vec3>& line, std::uint32_t node) {
    const std::size_t before = node > 0 ? node - 1 : 0, after = std::min<std::size_t>(node + 1, line.size() - 1);
    return normalized(line[after] - line[before], {1, 0, 0});
}

// Pinned nodes with their initial places: a node that is only the nearest to a pin, not within its radius, is moved
// there.
std::vector<HeldNode> held_nodes(const Entity& entity, const physics::DeformableDefinition& deformable) {
    std::vector<HeldNode> held;
    for (const Pin& pin : entity.pins) {
        for (const std::uint32_t node : pinned_nodes(pin, deformable.nodes)) {
            const bool is_within_radius = length(deformable.nodes[node] - pin.position) <= pin.radius;
            held.push_back(
                {node, transform_point(deformable.pose, is_within_radius ? deformable.nodes[node] : pin.position)});
        }
    }
    return held;
}

void add_targets(const std::vector<Pin>& pins, std::set<EntityIndex>& targets) {
    for (const Pin& pin : pins)
        if (pin.to) targets.insert(*pin.to);
}

// Whether a pin between things of these kinds is a tie, which does not make them rigid.
bool may_tie(PhysicalKind one, PhysicalKind other) {
    return is_deformable(one) && is_deformable(other) && (is_thin(one) || is_thin(other));
}

// Mean length of the edges of a sheet, the segments of a rope, m; 0 for a solid.
double spacing_of(const physics::DeformableDefinition& thin) {
    double sum = 0, count = 0;
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        sum += length(thin.nodes[b] - thin.nodes[a]);
        ++count;
    };
    if (const auto* cloth = std::get_if<physics::Cloth>(&thin.matter)) {
        for (const auto& [a, b, c] : cloth->triangles) {
            add(a, b);
            add(b, c);
            add(c, a);
        }
    } else if (std::holds_alternative<physics::Rope>(thin.matter)) {
        for (std::uint32_t i = 0; i + 1 < thin.nodes.size(); ++i) add(i, i + 1);
    }
    return count > 0 ? sum / count : 0;
}

bool is_thin(const LiveEntity& entity) {
    const SoftNodes* soft = as_soft(entity.points.get());
    return soft && !std::holds_alternative<physics::SoftSolid>(soft->definition().matter);
}

}  // namespace

void Simulation::State::find_bodies(const Document& document) {
    for (const SceneJoint& joint : document.joints) to_be_held.insert({joint.entity_b, joint.entity_a.value_or(0)});
    const auto kind_of_entity = [&](const Entity& entity) {
        const Result<attributes::AttributeSet> set = definitions.attributes.acting(entity);
        return set.ok() ? kind_of(set.value()) : PhysicalKind::rigid;
    };
    for (const Entity& entity : document.entities) {
        for (const Pin& pin : entity.pins) {
            const Entity* other = pin.to ? document.find(*pin.to) : nullptr;
            if (other && !may_tie(kind_of_entity(entity), kind_of_entity(*other))) to_be_held.insert(*pin.to);
        }
    }
}

bool Simulation::State::is_held_as_body(EntityIndex index, PhysicalKind kind) const {
    if (to_be_held.contains(index)) return true;
    const auto is_held = [&](EntityIndex other) { return !may_tie(kind_of(*live.at(other).attributes), kind); };
    return !holds.joints_of(index).empty() || std::ranges::any_of(holds.pinned_to(index), is_held);
}

// Pins of soft things to this sheet or rope: its nodes within their reach are tied to the soft thing.
void Simulation::State::tie_pins(const LiveEntity& entity, std::vector<bool>& is_held,
                                 std::vector<physics::Tie>& ties) const {
    std::vector<Vec3> positions;
    entity.points->read(positions);
    for (const EntityIndex index : holds.pinned_to(entity.definition.index)) {
        const LiveEntity& other = live.at(index);
        const SoftNodes* soft = as_soft(other.points.get());
        if (!soft || is_thin(other)) continue;
        for (Pin pin : other.definition.pins) {
            if (pin.to != entity.definition.index) continue;
            pin.position = transform_point(pose_of(other), pin.position);
            for (const std::uint32_t node : pinned_nodes(pin, positions)) {
                const auto tie = world->nearest_tie(node, soft->handle(), positions[node]);
                if (is_held[node] || !tie) continue;
                is_held[node] = true;
                ties.push_back(*tie);
            }
        }
    }
}

Result<void> Simulation::State::fasten(const LiveEntity& entity) {
    SoftNodes* soft = as_soft(entity.points.get());
    if (!soft) return {};
    const physics::DeformableDefinition* deformable = &soft->definition();
    Holds held_now;
    const bool is_rope = std::holds_alternative<physics::Rope>(deformable->matter);
    std::vector<bool> is_held(deformable->nodes.size(), false), is_clamped = is_held;
    for (const std::uint32_t node : deformable->pinned) is_held[node] = true;
    const std::vector<HeldNode> at = held_nodes(entity.definition, *deformable);
    if (Result<void> hung = soft->hang(at); !hung.ok()) return of_entity(entity.definition, hung.error());
    std::vector<Vec3> positions;
    soft->read(positions);
    for (std::size_t i = 0; i < entity.definition.pins.size(); ++i) {
        const Pin& pin = entity.definition.pins[i];
        const std::vector<std::uint32_t> nodes = pinned_nodes(pin, deformable->nodes);
        // Only the outer nodes of a row are clamped: nodes between two held ones keep their direction.
        const auto clamp = [&](std::uint32_t node, Quat holder) {
            const auto has = [&](std::uint32_t other) { return std::ranges::binary_search(nodes, other); };
            if (!is_rope || !pin.clamped || is_clamped[node] || (node > 0 && has(node - 1) && has(node + 1))) return;
            is_clamped[node] = true;
            held_now.clamps.push_back({node, rotate_inverse(holder, direction_at(positions, node))});
        };
        if (!pin.to) {
            for (const std::uint32_t node : nodes) clamp(node, {});
            continue;
        }
        if (waiting.contains(*pin.to)) continue;  // fastened when it arrives
        const LiveEntity* other = find(*pin.to);
        const std::string where = "pins[" + std::to_string(i) + "].to";
        if (!other) return of_entity(entity.definition, {where, "entity " + std::to_string(*pin.to) + " is not there"});
        const SoftNodes* holder = as_soft(other->points.get());
        if (holder && is_thin(entity)) {
            // Those that lie nearest to it: a part of a sheet that hung on a line with all its rows would be drawn onto
            // it through itself.
            std::vector<std::pair<double, physics::Tie>> near;
            double least = std::numeric_limits<double>::infinity();
            const std::span<const Vec3> places = world->node_positions(holder->handle());
            for (const std::uint32_t node : nodes) {
                const auto tie = world->nearest_tie(node, holder->handle(), positions[node]);
                if (is_held[node] || !tie) continue;
                Vec3 away = positions[node];
                for (std::size_t k = 0; k < 3; ++k) away -= tie->weight[k] * places[tie->other_nodes[k]];
                near.emplace_back(length(away), *tie);
                least = std::min(least, length(away));
            }
            const double farthest = least + spacing_of(*deformable) / 2;
            for (const auto& [distance, tie] : near) {
                if (distance > farthest) continue;
                is_held[tie.node] = true;
                held_now.ties.push_back(tie);
            }
            continue;
        }
        if (other->points && is_thin(*other)) continue;  // the other's ties hold this entity
        if (other->points)
            return of_entity(entity.definition, {where, "is no single body, cloth or rope", "pin it to one of these"});
        const Transform pose = world->pose(other->body);
        for (const std::uint32_t node : nodes) {
            if (is_held[node]) continue;
            is_held[node] = true;
            held_now.attachments.push_back({node, other->body, inverse_transform_point(pose, positions[node])});
            clamp(node, pose.rotation);
        }
    }
    if (is_thin(entity)) tie_pins(entity, is_held, held_now.ties);
    return soft->attach(std::move(held_now));
}

Result<void> Simulation::State::fasten_to(const LiveEntity& entity, const std::vector<Pin>& before, bool is_new) {
    const EntityIndex itself = entity.definition.index;
    // Ties of a soft thing belong to the sheet or rope that it is pinned to.
    const bool has_other_ties = (is_new || before != entity.definition.pins) && !is_thin(entity);
    const std::set<EntityIndex>& pinned_to_it = holds.pinned_to(itself);
    std::set<EntityIndex> meant = is_new ? pinned_to_it : std::set<EntityIndex>{};
    if (has_other_ties) add_targets(before, meant);
    if (has_other_ties) add_targets(entity.definition.pins, meant);
    for (const EntityIndex index : meant) {
        const LiveEntity* other = find(index);
        if (!other || index == itself || !other->points) continue;
        if (!is_thin(*other) && !(is_new && pinned_to_it.contains(index))) continue;
        if (Result<void> held = fasten(*other); !held.ok()) return held;
    }
    return {};
}

Result<void> Simulation::State::fasten_all(std::optional<EntityIndex> came) {
    if (!came) {
        for (const auto& [index, entity] : live)
            if (Result<void> held = fasten(entity); !held.ok()) return held;
        return {};
    }
    const std::set<EntityIndex>& pinned_to_it = holds.pinned_to(*came);
    std::set<EntityIndex> meant = pinned_to_it;
    meant.insert(*came);
    if (const LiveEntity* newcomer = find(*came)) add_targets(newcomer->definition.pins, meant);
    for (const EntityIndex index : meant) {
        const LiveEntity* entity = find(index);
        if (!entity || (index != *came && !pinned_to_it.contains(index) && !is_thin(*entity))) continue;
        if (Result<void> held = fasten(*entity); !held.ok()) return held;
    }
    return {};
}

// Soft ends of a joint are rigid as long as the joint exists.
Result<void> Simulation::State::make_bodies_of(const SceneJoint& joint) {
    for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
        const LiveEntity* end = find(index);
        if (!end || !end->points) continue;
        to_be_held.insert(index);
        Result<void> made = update(Entity(end->definition), true);
        to_be_held.erase(index);
        if (!made.ok()) return made;
    }
    return {};
}

// Things that the joint held may be soft again.
Result<void> Simulation::State::soften_ends(const SceneJoint& joint) {
    for (const EntityIndex index : {joint.entity_b, joint.entity_a.value_or(0)}) {
        const LiveEntity* end = find(index);
        if (!end || end->form.note.empty() || is_held_as_body(index, kind_of(*end->attributes))) continue;
        if (Result<void> made = update(Entity(end->definition), true); !made.ok()) return made;
    }
    return {};
}

Result<BodyHandle> Simulation::State::end_of(EntityIndex index, const std::string& where) {
    const LiveEntity* end = find(index);
    if (!end) return Error{where, "is not in the world"};
    if (end->points) return Error{where, "is no single body", "joints need a rigid thing"};
    return end->body;
}

Result<void> Simulation::State::add_joint(const SceneJoint& joint) {
    std::string who = "joint " + std::to_string(joint.index);
    if (!joint.name.empty()) who += " (" + joint.name + ")";
    if (joints.contains(joint.index)) return Error{who, "is in the world already"};
    if (is_waiting_end(joint)) {
        waiting_joints.insert_or_assign(joint.index, joint);
        return {};
    }
    if (Result<void> made = make_bodies_of(joint); !made.ok()) return made;
    physics::JointDefinition definition = joint.definition;
    const Result<BodyHandle> b = end_of(joint.entity_b, who + ": entity_b");
    const Result<BodyHandle> a =
        joint.entity_a ? end_of(*joint.entity_a, who + ": entity_a") : Result<BodyHandle>(BodyHandle{});
    if (!b.ok()) return b.error();
    if (!a.ok()) return a.error();
    definition.body_b = b.value();
    definition.body_a = a.value();
    const Result<JointHandle> handle = world->create_joint(definition);
    if (!handle.ok())
        return Error{who + ": " + joint_field(handle.error().where), handle.error().why, handle.error().remedy};
    joints.emplace(joint.index, LiveJoint{joint, handle.value()});
    holds.add_joint(joint);
    return {};
}

Result<void> Simulation::State::remove_joint(std::uint32_t index) {
    const auto found = joints.find(index);
    if (found == joints.end()) return Error{"index", "joint " + std::to_string(index) + " is not in the world"};
    Result<void> removed = world->destroy_joint(found->second.joint);
    const SceneJoint definition = found->second.definition;
    holds.remove_joint(definition);
    joints.erase(found);
    return removed.ok() ? soften_ends(definition) : removed;
}

}  // namespace embody::scene
