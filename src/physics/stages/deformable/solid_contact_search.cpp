// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/solid_contact_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "foundation/task_pool.h"
#include "foundation/zone.h"
#include "physics/definitions/world_settings.h"
#include "physics/deformable/contact/body_features.h"
#include "physics/deformable/contact/node_contacts.h"
#include "physics/deformable/solid/surface_pairs.h"
#include "physics/stages/access.h"
#include "physics/state/rigid_state.h"

namespace embody::physics::stages {

namespace {

std::uint32_t index_of(std::span<const TouchedBody> bodies, std::uint32_t slot) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies, slot, {}, &TouchedBody::body) - bodies.begin());
}

/// The search for one solid.
class Search {
public:
    Search(const DeformableAccess& world, const DeformableRecord& record, std::uint32_t number,
           std::span<const TouchedBody> bodies)
        : world_(world), record_(record), number_(number), bodies_(bodies) {
        for (const TouchedBody& body : bodies) {
            if (body.shape && may_collide(record.definition, world.rigid.record(body.body).definition))
                colliding_.push_back(body);
        }
    }

    void add_attachments(std::vector<SolidContact>& contacts) const {
        for (const Attachment& attachment : record_.definition.attachments) {
            if (world_.rigid.bodies.find(attachment.body) == nullptr) continue;
            SolidContact contact;
            contact.body = index_of(bodies_, attachment.body.index);
            const TouchedBody& body = bodies_[contact.body];
            contact.point = {number_, 1, {attachment.node}, {1}};
            contact.anchor = transform_point(body.start, attachment.anchor) - body.start_center;
            contact.holds = true;
            contacts.push_back(contact);
        }
    }

    // Nodes over the faces of bodies; then corners and balls of bodies over the triangles between nodes,
    // where the body is so small that nodes may miss it.
    void add_body_contacts(std::vector<SolidContact>& contacts) const {
        const SolidDeformable& solid = *record_.solid();
        std::vector<NodeContact> found;
        // Inner nodes, too: else those of a solid that its own weight squashes flat would hang below the floor.
        std::vector<std::uint32_t> all(solid.nodes().size());
        std::iota(all.begin(), all.end(), 0u);
        find_node_contacts(solid.nodes(), all, *record_.node_ball, radius(), colliding_, world_.settings.time_step,
                           world_.settings.gravity, found, world_.workers);
        for (auto first = found.begin(); first != found.end();) {
            const auto last = std::find_if(first, found.end(), [&](const auto& at) { return at.body != first->body; });
            add_node_contacts(colliding_[first->body], std::span(first, last), contacts);
            first = last;
        }
        std::optional<PlacedSurface> surface;
        for (const TouchedBody& body : colliding_) {
            if (world_.rigid.record(body.body).reach < settings().feature_body_ratio * solid.mean_side())
                add_feature_contacts(body, surface, contacts);
        }
    }

private:
    // Contacts of nodes with one body. Where the solid is to leave the body along a direction, nodes inside move along
    // that, to the end of the body's box.
    void add_node_contacts(const TouchedBody& body, std::span<const NodeContact> found,
                           std::vector<SolidContact>& contacts) const {
        const Bounds box = body.shape->bounds(body.start);
        const std::optional<ExitDirection> travel = find_exit_direction(body, box, found);
        std::uint32_t last_parted = no_node;
        for (const NodeContact& node : found) {
            SolidContact contact = contact_with(body);
            contact.point = {number_, 1, {node.node}, {1}};
            contact.anchor = node.anchor;
            contact.normal = node.normal;
            if (travel && height(body, node) < 0) {
                if (node.node == last_parted) continue;
                last_parted = node.node;
                const double end = travel->sign > 0 ? box.upper[travel->axis] : box.lower[travel->axis];
                Vec3 place = record_.nodes().position[node.node];
                place[travel->axis] = end;
                contact.anchor = place - body.start_center;
                contact.normal = {};
                contact.normal[travel->axis] = travel->sign;
                contact.parts = true;
            }
            contacts.push_back(contact);
        }
    }

    [[nodiscard]] double height(const TouchedBody& body, const NodeContact& node) const {
        return dot(record_.nodes().position[node.node] - body.start_center - node.anchor, node.normal);
    }

    // Where much of the solid is within a body whose faces push it to different sides, as a scene may begin, these
    // would pull it apart; until none of it is inside, it leaves along the shortest displacement.
    [[nodiscard]] std::optional<ExitDirection> find_exit_direction(const TouchedBody& body, const Bounds& box,
                                                                   std::span<const NodeContact> found) const {
        const SolidDeformable& solid = *record_.solid();
        const bool is_parting = std::ranges::any_of(
            record_.contacts, [&](const SolidContact& c) { return c.parts && c.has_body() && c.partner == body.body; });
        if (!is_parting) {
            double inside = 0;
            Vec3 normals;
            for (const NodeContact& node : found) {
                if (height(body, node) > -settings().parting_depth * solid.mean_side()) continue;
                ++inside;
                normals += node.normal;
            }
            if (inside < settings().parting_fraction * static_cast<double>(solid.nodes().size())) return std::nullopt;
            if (length(normals) > settings().one_side_cosine * inside) return std::nullopt;
        }
        return min_travel(solid.bounds(), box, true);
    }

    void add_feature_contacts(const TouchedBody& body, std::optional<PlacedSurface>& surface,
                              std::vector<SolidContact>& contacts) const {
        const double dt = world_.settings.time_step;
        const double body_displacement =
            (length(body.path_velocity) + length(body.path_spin) * world_.rigid.record(body.body).reach) * dt;
        const double reach = reach_of(world_, record_) + body_displacement + radius();
        const Bounds bounds = record_.bounds();
        const std::vector<BodyFeature> features = find_features(body.shape->definition());
        for (std::uint32_t f = 0; f < features.size(); ++f) {
            const BodyFeature& feature = features[f];
            const Vec3 p = transform_point(body.start, feature.point);
            if (!contains(enlarged(bounds, reach + feature.radius), p)) continue;
            if (!surface) surface.emplace(*record_.solid());
            const auto place = surface->find(p, std::max(reach + feature.radius, surface->deepest()));
            if (!place) continue;
            SolidContact contact = contact_with(body);
            contact.feature = f + 1;
            contact.point = {number_, 3, place->triangle, place->weight};
            contact.anchor = p - feature.radius * place->normal - body.start_center;
            contact.normal = -place->normal;
            contacts.push_back(contact);
        }
    }

    [[nodiscard]] const SolidContactSettings& settings() const {
        return world_.settings.solver.deformable.solid_contact;
    }
    [[nodiscard]] double radius() const { return record_.definition.contact_radius; }

    [[nodiscard]] SolidContact contact_with(const TouchedBody& body) const {
        SolidContact contact;
        contact.body = index_of(bodies_, body.body);
        contact.radius = radius();
        contact.friction = friction_between(body.material, record_.definition.material, world_.rigid.surface_pairs);
        return contact;
    }

    const DeformableAccess world_;
    const DeformableRecord& record_;
    std::uint32_t number_;
    std::span<const TouchedBody> bodies_;
    std::vector<TouchedBody> colliding_;
};

bool are_parting(const DeformableRecord& one, const DeformableRecord& two) {
    const std::uint64_t partner = first_deformable_partner + two.slot;
    return std::ranges::any_of(one.contacts, [&](const SolidContact& c) { return c.parts && c.partner == partner; });
}

void add_pairs(const DeformableAccess& world, std::span<DeformableRecord* const> records, std::uint32_t number,
               std::vector<SolidContact>& contacts) {
    const DeformableRecord& record = *records[number];
    const double reach = reach_of(world, record);
    for (std::uint32_t other = 0; other < records.size(); ++other) {
        const DeformableRecord& two = *records[other];
        if (other == number || !may_collide(record.definition, two.definition)) continue;
        const SurfaceSearch search{
            reach + reach_of(world, two), record.definition.contact_radius + two.definition.contact_radius,
            friction_between(record.definition.material, two.definition.material, world.rigid.surface_pairs),
            are_parting(record, two) || are_parting(two, record), world.settings.solver.deformable.solid_contact};
        find_surface_contacts({*record.solid(), number}, {*two.solid(), other}, search, contacts);
    }
}

// Identity of a contact from step to step; several contacts of a point with the same partner are identified by their
// order. A body's feature moves from triangle to triangle.
auto key(const SolidContact& c) {
    const std::uint32_t node = c.feature == 0 ? c.point.node[0] : 0;
    return std::make_tuple(c.partner, c.feature, node, !c.holds);
}

}  // namespace

bool may_collide(const DeformableDefinition& deformable, const BodyDefinition& body) {
    return body.enabled && (deformable.collision_group & body.collision_mask) != 0 &&
           (body.collision_group & deformable.collision_mask) != 0;
}

bool may_collide(const DeformableDefinition& a, const DeformableDefinition& b) {
    return (a.collision_group & b.collision_mask) != 0 && (b.collision_group & a.collision_mask) != 0;
}

double reach_of(const DeformableAccess& world, const DeformableRecord& record) {
    double fastest = 0;
    for (const Vec3 v : record.nodes().mean_velocity) fastest = std::max(fastest, length(v));
    const double dt = world.settings.time_step;
    return 2 * record.definition.contact_radius + (fastest + length(world.settings.gravity) * dt) * dt;
}

std::vector<SolidContact> find_solid_contacts(const DeformableAccess& world, std::span<DeformableRecord* const> records,
                                              std::span<const TouchedBody> bodies) {
    EMBODY_ZONE("find contacts of solids");
    std::vector<SolidContact> all;
    for (std::uint32_t number = 0; number < records.size(); ++number) {
        const DeformableRecord& record = *records[number];
        const Search search(world, record, number, bodies);
        std::vector<SolidContact> contacts;
        search.add_attachments(contacts);
        search.add_body_contacts(contacts);
        add_pairs(world, records, number, contacts);
        for (SolidContact& contact : contacts) {
            contact.partner = contact.has_body() ? bodies[contact.body].body
                                                 : first_deformable_partner + records[contact.other.solid]->slot;
        }
        std::ranges::stable_sort(contacts, {}, key);
        auto old = record.contacts.begin();
        for (SolidContact& contact : contacts) {
            while (old != record.contacts.end() && key(*old) < key(contact)) ++old;
            if (old != record.contacts.end() && key(*old) == key(contact)) {
                contact.force = old->force;
                contact.sticks = (old++)->sticks;
            }
        }
        all.insert(all.end(), contacts.begin(), contacts.end());
    }
    return all;
}

}  // namespace embody::physics::stages
