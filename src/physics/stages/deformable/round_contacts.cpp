// SPDX-License-Identifier: MIT
#include "physics/stages/deformable/round_contacts.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "physics/collision/shapes/collision_shape_data.h"

namespace embody::physics::stages {

namespace {

// One round body and one rope. Places are those in which the body was when the step began.
class RoundBody {
public:
    RoundBody(const DeformableRecord& rope, const Substep& substep, const TouchedBody& body)
        : rope_(rope),
          h_(substep.h),
          body_(body),
          center_(body.center_at(substep.time + substep.h)),
          back_(transpose(body.rotation_at(substep.time + substep.h))) {}

    void follow(NodeContact& contact) {
        if (const auto plane = plane_at(end_of(contact.node), contact)) contact = *plane;
    }

    void follow(SegmentContact& contact) {
        const Vec3 from = end_of(contact.node), to = end_of(contact.node + 1), edge = to - from;
        const double squared = length_squared(edge);
        if (!(squared > 0)) return;
        manifolds_.clear();
        collide_capsule(from, to, radius(), *body_.shape, body_.start,
                        reach(from + contact.along * edge, contact.plane), manifolds_);
        const Manifold* found = nearest(contact.plane.normal);
        if (!found) return;
        const ManifoldPoint point = found->points[0];
        const Vec3 normal = -found->normal;
        contact.along = std::clamp(dot(point.position - from, edge) / squared, 0.0, 1.0);
        set_plane(from + contact.along * edge, point.separation, normal, contact.plane);
        contact.curvature_radius = curvature_radius(from, edge, contact);
    }

private:
    [[nodiscard]] double radius() const { return rope_.definition.contact_radius; }

    [[nodiscard]] Vec3 end_of(std::uint32_t node) const {
        return body_.start_center + back_ * (rope_.nodes().ahead(node, h_) - center_);
    }

    // The last anchor lies on the body, so its nearest point is no farther.
    [[nodiscard]] double reach(Vec3 place, const NodeContact& last) const {
        return length(place - body_.start_center - last.anchor) + radius();
    }

    // Of the planes found the one that is most alike.
    [[nodiscard]] const Manifold* nearest(Vec3 normal) const {
        const Manifold* found = nullptr;
        double most = 0;  // cosine: of the same side
        for (const Manifold& manifold : manifolds_) {
            const double cosine = -dot(manifold.normal, normal);
            if (cosine <= most) continue;
            most = cosine;
            found = &manifold;
        }
        return found;
    }

    void set_plane(Vec3 place, double separation, Vec3 normal, NodeContact& plane) const {
        plane.normal = normal;
        plane.anchor = place - (separation + radius()) * normal - body_.start_center;
        plane.is_foreseen = true;
    }

    [[nodiscard]] std::optional<NodeContact> plane_at(Vec3 place, const NodeContact& last) {
        manifolds_.clear();
        collide(*rope_.node_ball, {place, {}}, *body_.shape, body_.start, reach(place, last), manifolds_);
        const Manifold* found = nearest(last.normal);
        if (!found) return {};
        NodeContact plane = last;
        set_plane(place, found->points[0].separation, -found->normal, plane);
        return plane;
    }

    // By the turn of the normal from a quarter of the segment before the point to one behind it.
    [[nodiscard]] double curvature_radius(Vec3 from, Vec3 edge, const SegmentContact& contact) {
        constexpr double min_turn = 1e-6;  // rad: what turns less is flat, and the nodes stand on it
        const auto before = plane_at(from + (contact.along - 0.25) * edge, contact.plane);
        const auto after = plane_at(from + (contact.along + 0.25) * edge, contact.plane);
        if (!before || !after) return 0;
        const double size = length(edge), turn = dot(after->normal - before->normal, edge) / size;
        return turn > min_turn ? size / (2 * turn) : 0;
    }

    const DeformableRecord& rope_;
    double h_;
    const TouchedBody& body_;
    Vec3 center_;  // of the body when the substep ends
    Mat3 back_;    // what turns directions then to those when the step began
    std::vector<Manifold> manifolds_;
};

}  // namespace

void follow_round_bodies(const Substep& substep, std::span<const TouchedBody> bodies, ThinDeformable& rope) {
    const auto is_round = [&](const NodeContact& contact) {
        return bodies[contact.body].shape && bodies[contact.body].shape->is_round();
    };
    for (NodeContact& contact : rope.contacts)
        if (is_round(contact)) RoundBody(*rope.record, substep, bodies[contact.body]).follow(contact);
    for (SegmentContact& contact : rope.segment_contacts)
        if (is_round(contact.plane)) RoundBody(*rope.record, substep, bodies[contact.plane.body]).follow(contact);
}

}  // namespace embody::physics::stages
