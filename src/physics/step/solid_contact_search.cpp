// SPDX-License-Identifier: MIT
#include "physics/step/solid_contact_search.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "physics/deformable/node_contacts.h"
#include "physics/deformable/surface_pairs.h"

namespace embody::physics {

namespace {

std::uint32_t index_of(std::span<const TouchedBody> bodies, std::uint32_t slot) {
    return static_cast<std::uint32_t>(std::ranges::lower_bound(bodies, slot, {}, &TouchedBody::body) - bodies.begin());
}

/// The search for one solid.
class Search {
public:
    Search(const WorldState& world, const DeformableRecord& record, std::uint32_t number,
           std::span<const TouchedBody> bodies)
        : world_(world), record_(record), number_(number), bodies_(bodies) {
        for (const TouchedBody& body : bodies) {
            if (body.shape && may_collide(record.definition, world.record(body.body).definition))
                colliding_.push_back(body);
        }
    }

    void add_attachments(std::vector<SolidContact>& contacts) const {
        for (const Attachment& attachment : record_.definition.attachments) {
            if (world_.bodies.find(attachment.body) == nullptr) continue;
            SolidContact contact;
            contact.body = index_of(bodies_, attachment.body.index);
            const TouchedBody& body = bodies_[contact.body];
            contact.point = {number_, 1, {attachment.node}, {1}};
            contact.anchor = transform_point(body.start, attachment.anchor) - body.start_center;
            contact.holds = true;
            contacts.push_back(contact);
        }
    }

    // Nodes; then, where a body is finer than the mesh, the middles of edges and triangles between nodes that do not
    // touch it.
    void add_body_contacts(std::vector<SolidContact>& contacts) const {
        if (colliding_.empty()) return;
        const SolidDeformable& solid = *record_.solid;
        std::vector<NodeContact> found;
        find(solid.nodes(), solid.surface_nodes(), found);
        std::vector<std::vector<bool>> is_near(colliding_.size(), std::vector<bool>(solid.nodes().size(), false));
        for (const NodeContact& node : found) {
            is_near[node.body][node.node] = true;
            contacts.push_back(to_contact(node, {number_, 1, {node.node}, {1}}));
        }

        const std::vector<CarriedPoint>& middles = solid.middles();
        Nodes samples;
        std::vector<std::uint32_t> all;
        for (const CarriedPoint& point : middles) {
            Vec3 position, velocity;
            for (std::size_t k = 0; k < point.count; ++k) {
                position += point.weight[k] * solid.nodes().position[point.node[k]];
                velocity += point.weight[k] * solid.nodes().mean_velocity[point.node[k]];
            }
            all.push_back(static_cast<std::uint32_t>(all.size()));
            samples.position.push_back(position);
            samples.mean_velocity.push_back(velocity);
        }
        found.clear();
        find(samples, all, found);
        for (const NodeContact& sample : found) {
            CarriedPoint point = middles[sample.node];
            const bool is_seen = std::ranges::any_of(std::span(point.node).first(point.count),
                                                     [&](std::uint32_t node) { return is_near[sample.body][node]; });
            if (is_seen) continue;
            point.solid = number_;
            contacts.push_back(to_contact(sample, point));
        }
    }

private:
    void find(const Nodes& nodes, std::span<const std::uint32_t> candidates, std::vector<NodeContact>& found) const {
        find_node_contacts(nodes, candidates, *record_.node_ball, record_.definition.contact_radius, colliding_,
                           world_.settings.time_step, world_.settings.gravity, found);
    }

    [[nodiscard]] SolidContact to_contact(const NodeContact& found, const CarriedPoint& point) const {
        const TouchedBody& body = colliding_[found.body];
        SolidContact contact;
        contact.point = point;
        contact.body = index_of(bodies_, body.body);
        contact.anchor = found.anchor;
        contact.normal = found.normal;
        contact.radius = record_.definition.contact_radius;
        contact.friction = std::sqrt(body.friction * record_.definition.friction);
        return contact;
    }

    const WorldState& world_;
    const DeformableRecord& record_;
    std::uint32_t number_;
    std::span<const TouchedBody> bodies_;
    std::vector<TouchedBody> colliding_;
};

void add_pairs(const WorldState& world, std::span<DeformableRecord* const> records, std::uint32_t number,
               std::vector<SolidContact>& contacts) {
    const DeformableRecord& record = *records[number];
    const double reach = reach_of(world, record);
    for (std::uint32_t other = 0; other < records.size(); ++other) {
        const DeformableRecord& two = *records[other];
        if (other == number || !may_collide(record.definition, two.definition)) continue;
        find_surface_contacts(*record.solid, number, *two.solid, other, reach + reach_of(world, two),
                              record.definition.contact_radius + two.definition.contact_radius,
                              std::sqrt(record.definition.friction * two.definition.friction), contacts);
    }
}

// What a contact is known by from step to step; several of a point with the same partner go by their order.
auto key(const SolidContact& c) { return std::make_tuple(c.partner, c.point.node, c.point.count, !c.holds); }

}  // namespace

bool may_collide(const DeformableDefinition& deformable, const BodyDefinition& body) {
    return body.enabled && (deformable.collision_group & body.collision_mask) != 0 &&
           (body.collision_group & deformable.collision_mask) != 0;
}

bool may_collide(const DeformableDefinition& a, const DeformableDefinition& b) {
    return (a.collision_group & b.collision_mask) != 0 && (b.collision_group & a.collision_mask) != 0;
}

double reach_of(const WorldState& world, const DeformableRecord& record) {
    double fastest = 0;
    for (const Vec3 v : record.nodes().mean_velocity) fastest = std::max(fastest, length(v));
    const double dt = world.settings.time_step;
    return 2 * record.definition.contact_radius + (fastest + length(world.settings.gravity) * dt) * dt;
}

std::vector<SolidContact> find_solid_contacts(const WorldState& world, std::span<DeformableRecord* const> records,
                                              std::span<const TouchedBody> bodies) {
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
            if (old != record.contacts.end() && key(*old) == key(contact)) contact.force = (old++)->force;
        }
        all.insert(all.end(), contacts.begin(), contacts.end());
    }
    return all;
}

}  // namespace embody::physics
