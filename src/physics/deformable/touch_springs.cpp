// SPDX-License-Identifier: MIT
#include "physics/deformable/touch_springs.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

constexpr double stiffness_factor = 20;  // over what the node's neighbours resist with

struct Place {
    Vec3 center;
    Mat3 rotation;
};

Vec3 across(Vec3 v, Vec3 normal) { return v - dot(v, normal) * normal; }

}  // namespace

Vec3 TouchSpring::lead(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves) const {
    Vec3 s;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) s += weight[k] * node_moves[node[k]];
    if (body != no_body) s -= body_moves[body].shift + cross(body_moves[body].turn, arm);
    return s;
}

void TouchSprings::recall(const TouchedBody& body, TouchSpring& spring) const {
    const auto is_before = [](const Memory& m, std::uint32_t node) { return m.node < node; };
    auto at = std::lower_bound(memory_.begin(), memory_.end(), spring.node[0], is_before);
    double nearest = 0.8;  // cosine: another face of the body is another contact
    for (; at != memory_.end() && at->node == spring.node[0]; ++at) {
        if (at->slot != body.body || dot(at->normal, spring.normal) < nearest) continue;
        nearest = dot(at->normal, spring.normal);
        spring.pull = spring.is_attachment ? at->pull : length(at->pull) * spring.normal;
        spring.hold = across(at->hold, spring.normal);
    }
}

void TouchSprings::begin(const Nodes& nodes, std::span<const NodeContact> contacts, std::span<const TouchedBody> bodies,
                         const Substep& substep, std::span<const double> node_stiffness) {
    const double end = substep.time + substep.h;
    std::vector<Place> places;
    slots_.clear();
    for (const TouchedBody& body : bodies) {
        places.push_back({body.center_at(end), body.rotation_at(end)});
        slots_.push_back(body.body);
    }
    const auto path_of = [&](const TouchedBody& body, Vec3 arm) {
        return substep.h * (body.path_velocity + body.velocity + cross(body.path_spin + body.spin, arm));
    };
    springs_.clear();
    for (const NodeContact& contact : contacts) {
        if (nodes.inverse_mass[contact.node] == 0) continue;
        const TouchedBody& body = bodies[contact.body];
        const Place& place = places[contact.body];
        TouchSpring spring{.node = {contact.node}, .weight = {1}, .body = contact.body};
        spring.normal = place.rotation * contact.normal;
        spring.arm = place.rotation * contact.anchor;
        const Vec3 offset = nodes.position[contact.node] - place.center - spring.arm;
        spring.gap = dot(offset, spring.normal) - radius;
        // The node's own reach within the substep, and what gravity adds.
        const double reach = length(nodes.mean_velocity[contact.node]) * substep.h +
                             length(substep.gravity) * substep.h * substep.h + radius;
        if (spring.gap > reach) continue;
        spring.arm += across(offset, spring.normal);
        spring.friction = std::sqrt(friction * body.friction);
        spring.carried = path_of(body, spring.arm);
        spring.stiffness = stiffness_factor * node_stiffness[contact.node];
        spring.inertia = nodes.mass[contact.node] / (substep.h * substep.h);
        recall(body, spring);
        springs_.push_back(spring);
    }
    for (std::size_t i = 0; i < attachments.size(); ++i) {
        const Attachment& attachment = attachments[i];
        const std::uint32_t b = attachment_bodies[i];
        if (b == no_body) continue;
        const TouchedBody& body = bodies[b];
        TouchSpring spring{.node = {attachment.node}, .weight = {1}, .body = b, .is_attachment = true};
        spring.normal = {1, 0, 0};
        // The anchor is in the frame that the body's pose at the step's start gives.
        const Vec3 anchor = transform_point(body.start, attachment.anchor) - body.start_center;
        spring.arm = places[b].rotation * anchor;
        spring.carried = nodes.position[attachment.node] - places[b].center - spring.arm;  // off the anchor
        spring.stiffness = stiffness_factor * node_stiffness[attachment.node];
        recall(body, spring);
        springs_.push_back(spring);
    }
}

// Friction: k (hold + slip) up to its limit. Beyond it the secant through that limit at the slip to be expected, which
// can only stop what slides; where the slip is so long that friction cannot end it in this substep, the limit itself.
// Expected after a solve is what the point would do alone with the limit instead of a larger force that it had.
// Returns by how much the force is another than before, N.
double TouchSprings::choose_friction(TouchSpring& spring, Vec3 s, double limit, bool is_foretold) {
    const Mat3 plane = Mat3::identity() - outer(spring.normal, spring.normal);
    const Vec3 loose = spring.hold - across(spring.carried, spring.normal);  // stretch with s = 0
    const Vec3 stretch = loose + across(s, spring.normal), force = across(spring.force(s), spring.normal);
    const double size = length(stretch);
    const double expected = is_foretold ? size : size + std::max(0.0, length(force) - limit) / spring.inertia;
    const bool sticks = limit > 0 && spring.stiffness * expected <= limit;
    const double tangent = sticks ? spring.stiffness : limit > 0 ? limit / expected : 0;
    spring.matrix = tangent * plane;
    spring.load = -tangent * loose;
    if (!sticks && spring.inertia * expected > 2 * limit && size > 0) {
        const Vec3 way = stretch / size;
        spring.load -= (limit - tangent * dot(way, loose)) * way;
        spring.matrix = spring.matrix - tangent * outer(way, way);
    }
    return length(force - (spring.load - spring.matrix * s));
}

bool TouchSprings::choose(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves, bool is_foretold) {
    constexpr double small = 0.05;  // share of the forces whose change is not worth a solve
    double change = 0, all = 0;
    for (TouchSpring& spring : springs_) {
        if (spring.is_attachment) {
            spring.acts = true;
            spring.matrix = spring.stiffness * Mat3::identity();
            spring.load = spring.pull - spring.stiffness * spring.carried;
            continue;
        }
        const Vec3 s = spring.lead(node_moves, body_moves);
        const double push_before = dot(spring.pull, spring.normal);
        const double depth = -(spring.gap + dot(spring.normal, s)), push = push_before + spring.stiffness * depth;
        const bool is_new = !spring.acts;
        if (is_new != (push <= 0)) change += std::fabs(push);
        // What pushed in the last substep is let go by a solve alone: the stiff spring calls every breath a leave.
        spring.acts = push > 0 || (is_foretold && push_before > 0);
        all += std::fabs(push);
        if (!spring.acts) {
            spring.matrix = Mat3::zero();
            spring.load = {};
            continue;
        }
        // How deep something came that was not held back tells what it takes to stop it, not what the spring would
        // push.
        const double expected = is_foretold ? push_before : is_new ? push_before + spring.inertia * depth : push;
        change += choose_friction(spring, s, spring.friction * expected, is_foretold);
        spring.matrix += spring.stiffness * outer(spring.normal, spring.normal);
        spring.load += (push_before - spring.stiffness * spring.gap) * spring.normal;
    }
    return change > small * all;
}

void TouchSprings::finish(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves,
                          const Substep& substep, std::span<TouchedBody> bodies) {
    memory_.clear();
    for (const TouchSpring& spring : springs_) {
        if (!spring.acts) continue;
        const Vec3 s = spring.lead(node_moves, body_moves);
        const Vec3 force = spring.force(s);
        if (spring.body == no_body) continue;
        bodies[spring.body].push(-substep.h * force, spring.arm, substep.h);
        Memory memory{spring.node[0], slots_[spring.body], spring.normal, force, {}};
        if (!spring.is_attachment) {
            const double push = std::max(0.0, dot(force, spring.normal));
            memory.pull = push * spring.normal;
            memory.hold = spring.hold + across(s - spring.carried, spring.normal);
            const double most = spring.friction * push / spring.stiffness, size = length(memory.hold);
            if (size > most) memory.hold *= most / size;
        }
        memory_.push_back(memory);
    }
    const auto is_before = [](const Memory& a, const Memory& b) { return a.node < b.node; };
    std::stable_sort(memory_.begin(), memory_.end(), is_before);
}

}  // namespace embody::physics
