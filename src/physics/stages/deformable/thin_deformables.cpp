// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/thin_deformables.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/world_settings.h"
#include "physics/stages/deformable/round_contacts.h"
#include "physics/stages/deformable/sheet_contact_search.h"

namespace embody::physics::stages {

namespace {

// Points of segments between the nodes that may touch: corners, edges and round sides of bodies between two nodes.
void find_segment_contacts(std::span<const TouchedBody> bodies, const std::vector<bool>& may_collide,
                           const WorldSettings& settings, ThinDeformable& thin) {
    constexpr double min_length = 1e-12;  // m: keeps the quotient finite
    const double end_fraction = settings.solver.deformable.thin_search.segment_end_fraction;
    const double time_step = settings.time_step;
    const DeformableRecord& record = *thin.record;
    const Nodes& nodes = record.nodes();
    const double radius = record.definition.contact_radius, fall = length(settings.gravity) * time_step;
    std::vector<Manifold> manifolds;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        if (!may_collide[b]) continue;
        const TouchedBody& body = bodies[b];
        const Bounds bounds = body.shape->bounds(body.start);
        const double body_displacement = displacement_of(body, time_step);
        for (std::uint32_t s = 0; s + 1 < nodes.size(); ++s) {
            if (record.rope()->is_broken(s)) continue;
            const Vec3 from = nodes.position[s], edge = nodes.position[s + 1] - from;
            const double speed = std::max(length(nodes.mean_velocity[s]), length(nodes.mean_velocity[s + 1]));
            const double reach = 2 * radius + body_displacement + (speed + fall) * time_step;
            Bounds own;
            own.add(from);
            own.add(from + edge);
            if (!overlaps(enlarged(bounds, reach), own)) continue;
            manifolds.clear();
            const Vec3 displacement = normalized(edge, {0, 1, 0});
            const Transform pose{from + edge / 2, from_two_vectors({0, 1, 0}, displacement)};
            collide(*record.capsules[record.segment_capsule[s]], pose, *body.shape, body.start, reach, manifolds);
            for (const Manifold& manifold : manifolds) {
                const ManifoldPoint& point = manifold.points[0];
                const double along = dot(point.position - from, displacement) / std::max(length(edge), min_length);
                if (along < end_fraction || along > 1 - end_fraction) continue;
                const Vec3 normal = -manifold.normal;  // from the body to the rope
                const Vec3 on_axis = from + along * edge;
                const Vec3 anchor = on_axis - (point.separation + radius) * normal - body.start_center;
                thin.segment_contacts.push_back({s, along, {s, b, anchor, normal}});
            }
        }
    }
}

}  // namespace

std::span<const TouchSpring> springs_of(const DeformableRecord& record) {
    return record.cloth() ? record.cloth()->springs() : record.rope()->springs();
}

void find_thin_contacts(std::span<const TouchedBody> bodies, const std::vector<bool>& may_collide,
                        const WorldSettings& settings, ThinDeformable& thin, TaskPool& workers) {
    const DeformableRecord& record = *thin.record;
    std::vector<std::uint32_t> all(record.nodes().size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<TouchedBody> colliding;
    std::vector<std::uint32_t> place;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        if (!may_collide[b]) continue;
        colliding.push_back(bodies[b]);
        place.push_back(b);
    }
    find_node_contacts(record.nodes(), all, *record.node_ball, record.definition.contact_radius, colliding,
                       settings.time_step, settings.gravity, thin.contacts, workers);
    for (NodeContact& contact : thin.contacts) contact.body = place[contact.body];
    if (record.rope())
        find_segment_contacts(bodies, may_collide, settings, thin);
    else
        find_sheet_contacts(bodies, may_collide, settings, thin, workers);
}

void advance_rope(ThinDeformable& thin, const Substep& substep, std::span<TouchedBody> bodies) {
    RopeLine& rope = *thin.record->rope();
    follow_round_bodies(substep, bodies, thin);
    rope.set_attachments(thin.attachments);
    rope.set_clamps(thin.record->definition.clamps);
    rope.advance(substep, thin.contacts, thin.segment_contacts, thin.attachment_bodies, bodies);
}

std::vector<std::uint32_t> bodies_pushed_by(const DeformableRecord& record, std::span<const TouchedBody> bodies) {
    std::vector<std::uint32_t> slots;
    for (const TouchSpring& spring : springs_of(record)) {
        if (spring.acts && spring.body < bodies.size()) slots.push_back(bodies[spring.body].body);
    }
    std::ranges::sort(slots);
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
}

}  // namespace embody::physics::stages
