// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/node_contacts.h"

#include <algorithm>

namespace embody::physics::deformable {

namespace {

constexpr std::size_t min_parallel_count = 500;  // nodes

void find_fraction(const Nodes& nodes, std::span<const std::uint32_t> candidates, const CollisionShape& node_ball,
                   double radius, std::span<const TouchedBody> bodies, double time_step, Vec3 gravity,
                   std::vector<NodeContact>& contacts) {
    const double fall = length(gravity) * time_step;  // m/s
    std::vector<Manifold> manifolds;
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const TouchedBody& body = bodies[b];
        const Bounds bounds = body.shape->bounds(body.start);
        const double body_displacement = displacement_of(body, time_step);
        for (const std::uint32_t node : candidates) {
            const Vec3 at = nodes.position[node];
            const double reach =
                2 * radius + body_displacement + (length(nodes.mean_velocity[node]) + fall) * time_step;
            if (!contains(enlarged(bounds, reach), at)) continue;
            manifolds.clear();
            collide(node_ball, {at, {}}, *body.shape, body.start, reach, manifolds);
            for (const Manifold& manifold : manifolds) {
                const Vec3 normal = -manifold.normal;  // from the body to the node
                const double height = manifold.points[0].separation + radius;
                contacts.push_back({node, b, at - height * normal - body.start_center, normal});
            }
        }
    }
}

}  // namespace

double displacement_of(const TouchedBody& body, double time_step) {
    const Vec3 local_center = rotate(conjugate(body.start.rotation), body.start_center - body.start.position);
    return (length(body.path_velocity) + length(body.path_spin) * body.shape->radius_about(local_center)) * time_step;
}

void find_node_contacts(const Nodes& nodes, std::span<const std::uint32_t> candidates, const CollisionShape& node_ball,
                        double radius, std::span<const TouchedBody> bodies, double time_step, Vec3 gravity,
                        std::vector<NodeContact>& contacts, TaskPool& workers) {
    std::vector<std::vector<NodeContact>> found(static_cast<std::size_t>(workers.workers()));
    parallel_for(workers, candidates.size(), !bodies.empty() && candidates.size() >= min_parallel_count,
                 [&](int worker, IndexRange range) {
                     find_fraction(nodes, candidates.subspan(range.first, range.last - range.first), node_ball, radius,
                                   bodies, time_step, gravity, found[static_cast<std::size_t>(worker)]);
                 });
    const std::size_t before = contacts.size();
    for (const auto& part : found) contacts.insert(contacts.end(), part.begin(), part.end());
    std::ranges::stable_sort(std::span(contacts).subspan(before), {}, &NodeContact::body);
}

double gap(const NodeContact& contact, Vec3 node_position, double radius, const TouchedBody& body, double time) {
    const Mat3 rotation = body.rotation_at(time);
    return dot(node_position - body.center_at(time) - rotation * contact.anchor, rotation * contact.normal) - radius;
}

}  // namespace embody::physics::deformable
