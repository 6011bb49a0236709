// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/thin_on_solids.h"

#include <algorithm>

#include "foundation/task_pool.h"
#include "physics/definitions/world_settings.h"
#include "physics/stages/deformable/solid_contact_search.h"
#include "physics/stages/deformable/solid_ties.h"
#include "physics/state/deformable_state.h"

namespace embody::physics::stages {

const PlacedSurface& ThinOnSolids::surface(std::uint32_t slot) {
    const auto known = surfaces_.find(slot);
    if (known != surfaces_.end()) return known->second;
    return surfaces_.emplace(slot, PlacedSurface(*world_.deformables.records.at(slot).solid())).first->second;
}

void ThinOnSolids::add(ThinDeformable& thin, std::vector<TouchedBody>& bodies, double h) {
    with_bodies_ = thin.contacts;
    between_ = thin.sheet_contacts;
    held_.clear();
    for (std::uint32_t slot = 0; slot < world_.deformables.records.slot_count(); ++slot) {
        if (!world_.deformables.records.used(slot)) continue;
        const DeformableRecord& solid = world_.deformables.records.at(slot);
        if (solid.solid() && solid.definition.enabled && may_collide(thin.record->definition, solid.definition))
            add_solid(thin, slot, bodies, h);
    }
}

void ThinOnSolids::add_solid(ThinDeformable& thin, std::uint32_t slot, std::vector<TouchedBody>& bodies, double h) {
    const DeformableRecord& sheet = *thin.record;
    const DeformableRecord& other = world_.deformables.records.at(slot);
    const Nodes& nodes = sheet.nodes();
    const double radius = sheet.definition.contact_radius + other.definition.contact_radius;
    const Bounds near = enlarged(other.bounds(), reach_of(world_, sheet) + radius);
    if (!overlaps(near, sheet.bounds())) return;
    const auto body = static_cast<std::uint32_t>(bodies.size());
    const std::size_t first = held_.size();
    TouchedBody solid;
    solid.body = first_solid_slot + slot;
    solid.material = other.definition.material;
    solid.start_center = near.center();
    bodies.push_back(solid);
    const double fall = length(world_.settings.gravity) * h;
    for (std::uint32_t node = 0; node < nodes.size(); ++node) {
        const Vec3 at = nodes.position[node];
        if (!contains(near, at) || is_tied(sheet, node, world_.deformables.records.handle_at(slot))) continue;
        const double reach = 2 * radius + (length(nodes.mean_velocity[node]) + fall) * h;
        const auto place = surface(slot).find(at, std::max(reach, surface(slot).deepest()));
        if (!place) continue;
        const double height = place->distance - other.definition.contact_radius;
        const Vec3 anchor = at - height * place->normal - solid.start_center;
        Vec3 velocity;
        for (std::size_t k = 0; k < 3; ++k)
            velocity += place->weight[k] * other.nodes().mean_velocity[place->triangle[k]];
        thin.contacts.push_back({node, body, anchor, place->normal, velocity});
        held_.push_back({body, node, *place});
    }
    uncover(thin, body, 2 * radius);
    if (!other.is_asleep) find_following(*other.solid(), nodes, h, std::span(held_).subspan(first));
}

// A rigid body on a sheet on a solid presses on the solid itself, harder than the sheet in between could pass on: where
// the sheet lies on the solid, the body does not act on the sheet.
void ThinOnSolids::uncover(ThinDeformable& thin, std::uint32_t solid, double distance) const {
    const double covered_cosine = world_.settings.solver.deformable.thin_search.covered_cosine;
    const auto is_covered = [&](std::uint32_t node, const NodeContact& plane) {
        const auto held = std::ranges::lower_bound(held_, std::pair{solid, node}, {}, key);
        return plane.body < solid && held != held_.end() && key(*held) == std::pair{solid, node} &&
               held->place.distance < distance && dot(held->place.normal, plane.normal) < -covered_cosine;
    };
    std::erase_if(thin.contacts, [&](const NodeContact& contact) { return is_covered(contact.node, contact); });
    std::erase_if(thin.sheet_contacts, [&](const SheetContact& contact) {
        const auto nodes = std::span(contact.node).first(static_cast<std::size_t>(contact.count));
        return std::ranges::any_of(nodes, [&](std::uint32_t node) { return is_covered(node, contact.plane); });
    });
}

// The solid responds to a push a substep late. The oscillation grows where what lies on the solid is heavy for its
// compliance c: with a push F = m (s'' - g) of a mass that follows the surface s, and s = -c F, s grows from substep to
// substep from r = m c/h² = 1/4 on; with a fraction a of each new push, only from a = 2/(1 + 4 r) on. c is that of a
// solid that nothing else holds, if all nodes are pushed alike.
void ThinOnSolids::find_following(SolidDeformable& solid, const Nodes& sheet, double h, std::span<Held> held) {
    push_.assign(solid.nodes().size(), {});
    move_.resize(solid.nodes().size());
    for (const Held& at : held) {
        for (std::size_t k = 0; k < 3; ++k) push_[at.place.triangle[k]] += at.place.weight[k] * at.place.normal;
    }
    solid.find_response(push_, move_, world_.workers);
    for (Held& at : held) {
        Vec3 displacement;
        for (std::size_t k = 0; k < 3; ++k) displacement += at.place.weight[k] * move_[at.place.triangle[k]];
        const double compliance = std::max(0.0, dot(displacement, at.place.normal));
        at.following = 1 / (1 + 4 * sheet.mass[at.node] * compliance / (h * h));
    }
}

// By solid and node.
std::pair<std::uint32_t, std::uint32_t> ThinOnSolids::touch_of(const SurfacePush& push) {
    return {push.slot, push.node};
}

void ThinOnSolids::take(ThinDeformable& thin, std::span<const TouchedBody> bodies, std::size_t first) {
    DeformableRecord& sheet = *thin.record;
    thin.contacts = std::move(with_bodies_);
    thin.sheet_contacts = std::move(between_);
    std::vector<SurfacePush> pushes = std::exchange(sheet.surface_pushes, {});
    for (const TouchSpring& spring : springs_of(sheet)) {
        if (!spring.acts || spring.body == no_body || spring.body < first) continue;
        const auto held = std::ranges::lower_bound(held_, std::pair{spring.body, spring.node[0]}, {}, key);
        if (held == held_.end() || key(*held) != std::pair{spring.body, spring.node[0]}) continue;
        SurfacePush push{
            bodies[spring.body].body - first_solid_slot, spring.node[0], held->place.triangle, held->place.weight, {}};
        const auto last = std::ranges::lower_bound(pushes, touch_of(push), {}, touch_of);
        if (last != pushes.end() && touch_of(*last) == touch_of(push)) push.force = std::exchange(last->force, {});
        push.force += held->following * (-spring.felt - push.force);
        sheet.surface_pushes.push_back(push);
    }
    // Nodes of the solid that the sheet has left still get the part of the push that has not acted yet.
    constexpr double min_push = 1e-9;  // N: far below what moves a node of any sheet
    const double lasting = world_.settings.solver.deformable.thin_search.push_memory;
    for (SurfacePush& push : pushes) {
        push.force *= lasting;
        if (length(push.force) > min_push) sheet.surface_pushes.push_back(push);
    }
    std::ranges::stable_sort(sheet.surface_pushes, {}, touch_of);
}

}  // namespace embody::physics::stages
