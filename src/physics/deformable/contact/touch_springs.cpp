// SPDX-License-Identifier: MIT
#include "physics/deformable/contact/touch_springs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace embody::physics::deformable {

namespace {

// A new contact that is deeper than its point can have come in the substep began inside, or something was placed there.
// It is brought out at a bounded speed, by a force that is at most what the point's own inertia needs: where something
// else holds the point inside, a remembered force would grow for ever. The force is also at most a few times what a
// light body's inertia needs: squeezed between points on both sides by all the force of a heavy rope, the body would
// turn out of there faster than substeps can follow.
void begin_recovery(TouchSpring& spring, const TouchedBody& body, double h, const ThinContactSettings& settings) {
    spring.is_recovery = true;
    spring.friction = {};
    spring.stiffness = settings.stiffness_factor * spring.inertia;
    const Vec3 turning = cross(spring.arm, spring.normal);
    const double body_compliance = body.inverse_mass + dot(turning, body.inverse_inertia * turning);  // 1/kg
    if (body_compliance > 0)
        spring.stiffness = std::min(spring.stiffness, settings.recovery_stiffness_factor / (body_compliance * h * h));
    spring.gap = -settings.recovery_speed * h - dot(spring.carried, spring.normal);
}

}  // namespace

bool TouchSprings::recall(const TouchedBody& body, const ThinContactSettings& settings, TouchSpring& spring) const {
    auto at = std::ranges::lower_bound(memory_, spring.feature, {}, &Memory::feature);
    bool is_known = false;
    double nearest = settings.same_normal_cosine;
    for (; at != memory_.end() && at->feature == spring.feature; ++at) {
        if (at->slot != body.body || at->is_attachment != spring.is_attachment) continue;
        if (dot(at->normal, spring.normal) < nearest) continue;
        is_known = true;
        nearest = dot(at->normal, spring.normal);
        spring.pull = spring.is_attachment ? at->pull : length(at->pull) * spring.normal;
        spring.hold = across(at->hold, spring.normal);
        spring.sticks = at->sticks;
    }
    return is_known;
}

bool TouchSprings::is_attached(std::uint32_t node, std::uint32_t body) const {
    for (std::size_t i = 0; i < attachments.size(); ++i) {
        if (attachments[i].node == node && attachment_bodies[i] == body) return true;
    }
    return false;
}

void TouchSprings::complete(const Nodes& nodes, const NodeContact& plane, std::span<const TouchedBody> bodies,
                            const Substep& substep, std::span<const double> node_stiffness, TouchSpring& spring) {
    const ThinContactSettings& settings = substep.settings.thin_contact;
    const TouchedBody& body = bodies[plane.body];
    const Place& place = places_[plane.body];
    spring.normal = place.rotation * plane.normal;
    Vec3 point, velocity;
    bool is_free = false;
    double compliance = 0;  // 1/kg
    for (std::size_t k = 0; k < static_cast<std::size_t>(spring.count); ++k) {
        const std::uint32_t node = spring.node[k];
        point += spring.weight[k] * nodes.position[node];
        velocity += spring.weight[k] * nodes.mean_velocity[node];
        if (!node_stiffness.empty()) {
            const double wanted = directed_stiffness.empty()
                                      ? settings.stiffness_factor * node_stiffness[node]
                                      : substep.settings.rope.contact_stiffness_factor *
                                            dot(spring.normal, directed_stiffness[node] * spring.normal);
            spring.stiffness = std::max(spring.stiffness, wanted);
        }
        spring.inertia += spring.weight[k] * nodes.mass[node] / (substep.h * substep.h);
        compliance += spring.weight[k] * spring.weight[k] * nodes.inverse_mass[node];
        is_free |= nodes.inverse_mass[node] > 0;
    }
    spring.body = plane.body;
    spring.predicts_slip = predicts_slip;
    spring.arm = place.rotation * plane.anchor;
    const Vec3 offset = point - place.center - spring.arm;
    spring.gap = dot(offset, spring.normal) - radius;
    // The point's own travel within the substep, and that by gravity.
    const double reach = (length(velocity) + length(substep.gravity) * substep.h) * substep.h + radius;
    if (!is_free || spring.gap > reach) return;
    if (!plane.is_foreseen) spring.arm += across(offset, spring.normal);
    // A rope's forces act at its line: so angular momentum is kept, and what turns with a drum winds up at R + r.
    if (!directed_stiffness.empty()) spring.arm += radius * spring.normal;
    spring.friction = friction_between(material, body.material, *substep.surface_pairs);
    spring.carried = place.displacement_of(spring.arm) + substep.h * plane.velocity;
    const Mat3 turning = skew(spring.arm);
    const Mat3 by_turn = turning * body.inverse_inertia * transpose(turning);
    if (predicts_slip)  // the many solves of ropes find it; so judged, a rope that pierces a box would throw it
        spring.body_compliance =
            substep.h * substep.h * (body.inverse_mass + trace(by_turn) - dot(spring.normal, by_turn * spring.normal));
    const double gap_at_start = spring.gap + dot(spring.carried, spring.normal);
    const double came_in = std::max(0.0, dot(spring.carried - substep.h * velocity, spring.normal));
    spring.overlap = std::max(0.0, -gap_at_start);
    const bool is_known = recall(body, settings, spring);
    if (node_stiffness.empty())
        soften(substep, compliance, body.inverse_mass > 0, spring);
    else if (forgets_depth)
        bring_back(substep, spring);
    if (!is_known && gap_at_start < -settings.recovery_speed * substep.h - came_in) {
        if (std::ranges::find(attachment_bodies, plane.body) != attachment_bodies.end()) return;
        begin_recovery(spring, body, substep.h, settings);
    }
    springs_.push_back(spring);
}

// The masses of bodies in equal parts on the nodes that touched them in the last substep: by mass, not by the forces of
// these nodes, since a stiffness that followed its own force would integrate it once more.
std::vector<double> TouchSprings::loads_of(std::span<const TouchedBody> bodies, std::size_t node_count) const {
    struct Bearing {
        double mass = 0;  // kg
        int nodes = 0;
    };
    std::map<std::uint32_t, Bearing> bearings;  // by slot
    for (const TouchedBody& body : bodies) {
        if (body.inverse_mass > 0) bearings[body.body].mass = 1 / body.inverse_mass;
    }
    const auto bearing_of = [&](const Memory& memory) {
        const bool is_of_node = !memory.is_attachment && memory.feature[1] == no_node;
        return is_of_node ? bearings.find(memory.slot) : bearings.end();
    };
    for (const Memory& memory : memory_) {
        if (const auto at = bearing_of(memory); at != bearings.end()) ++at->second.nodes;
    }
    std::vector<double> loads(node_count, 0);
    for (const Memory& memory : memory_) {
        if (const auto at = bearing_of(memory); at != bearings.end())
            loads[memory.feature[0]] += at->second.mass / at->second.nodes;
    }
    return loads;
}

// With memory, springs below the inertia of what lies on them would let it rock up (docs/physics/cloth.md, "What lies
// on a sheet"), and so would an overlap that is taken back at once. Where nothing lies the deeper it is, the less of
// the force that takes it back is remembered, and none where the node has gone through for good: what something else
// holds in there must not be pushed harder and harder.
void TouchSprings::bring_back(const Substep& substep, TouchSpring& spring) const {
    const ThinContactSettings& settings = substep.settings.thin_contact;
    const double load = loads_[spring.node[0]];
    spring.stiffness = std::max(spring.stiffness, settings.body_stiffness_factor * load / (substep.h * substep.h));
    const double part = load > 0 ? settings.recovery_fraction : 1;
    const double returned = std::min(part * spring.overlap, settings.recovery_speed * substep.h);
    spring.gap += spring.overlap - returned;
    if (!(load > 0))
        spring.returned = std::min(1.0, spring.overlap / (settings.max_wrong_side_radii * radius)) * returned;
}

// As between sheets (pair_springs.cpp): by its inertia and by that of the load on it. That follows the force, so both
// would grow exponentially where something else holds the point: none remembers more than max_load_'s weight. A
// body's inertia would need stiffer springs than these: with memory their oscillations would grow, so they have no
// memory.
void TouchSprings::soften(const Substep& substep, double compliance, bool is_with_body, TouchSpring& spring) const {
    const ThinContactSettings& settings = substep.settings.thin_contact;
    if (is_with_body) spring.pull = spring.hold = {};
    const double g = std::max(length(substep.gravity), settings.min_gravity), squared = substep.h * substep.h;
    const double pull = length(spring.pull), carried = std::min(pull / g, max_load_);  // kg
    if (pull > g * carried) spring.pull *= g * carried / pull;
    spring.stiffness =
        std::max(settings.stiffness_factor * spring.inertia, settings.load_stiffness_factor * carried / squared);
    spring.inertia = 1 / (compliance * squared);
    const double max_taken = settings.recovery_speed * substep.h;
    if (is_with_body)
        spring.gap = std::max(spring.gap, -max_taken);
    else
        spring.gap += spring.overlap - std::min(settings.recovery_fraction * spring.overlap, max_taken);
}

// Two faces of one body, or of two that do not move, may leave a node less room than it needs, so that neither can give
// way: the less room, the more force both forget.
void TouchSprings::forget_contradictions(std::span<const TouchedBody> bodies, const Substep& substep,
                                         std::size_t node_count) {
    const ThinContactSettings& settings = substep.settings.thin_contact;
    constexpr std::uint32_t none = 0xFFFFFFFFu;
    std::vector<std::uint32_t> last(node_count, none), before(springs_.size(), none);
    std::vector<double> missing(springs_.size(), 0);  // room
    const auto stay_together = [&](const TouchSpring& a, const TouchSpring& b) {
        return a.body == b.body || !(bodies[a.body].inverse_mass > 0 || bodies[b.body].inverse_mass > 0);
    };
    for (std::uint32_t i = 0; i < springs_.size(); ++i) {
        const TouchSpring& spring = springs_[i];
        if (!(spring.overlap > 0) || spring.is_recovery) continue;
        for (std::uint32_t k = last[spring.node[0]]; k != none; k = before[k]) {
            const TouchSpring& other = springs_[k];
            if (!stay_together(spring, other) || dot(spring.normal, other.normal) >= 0) continue;
            const double overlap = spring.overlap + other.overlap;
            missing[i] = std::max(missing[i], overlap);
            missing[k] = std::max(missing[k], overlap);
        }
        before[i] = last[spring.node[0]];
        last[spring.node[0]] = i;
    }
    for (std::uint32_t i = 0; i < springs_.size(); ++i) {
        if (!(missing[i] > 0)) continue;
        TouchSpring& spring = springs_[i];
        const double kept = std::max(0.0, 1 - missing[i] / (settings.memory_depth * radius));
        spring.pull = kept * spring.pull;
    }
}

void TouchSprings::add(const Nodes& nodes, const SheetContact& contact, std::span<const TouchedBody> bodies,
                       const Substep& substep) {
    TouchSpring spring{.count = contact.count, .feature = contact.feature};
    std::ranges::copy(contact.node, spring.node.begin());
    std::ranges::copy(contact.weight, spring.weight.begin());
    complete(nodes, contact.plane, bodies, substep, {}, spring);
}

void TouchSprings::add(const Nodes& nodes, const SegmentContact& contact, std::span<const TouchedBody> bodies,
                       const Substep& substep, std::span<const double> node_stiffness) {
    TouchSpring spring{.node = {contact.node, contact.node + 1},
                       .weight = {1 - contact.along, contact.along},
                       .count = 2,
                       .feature = {contact.node, contact.node + 1}};
    const std::size_t before = springs_.size();
    complete(nodes, contact.plane, bodies, substep, node_stiffness, spring);
    if (springs_.size() > before && contact.curvature_radius > 0) add_rolling(nodes, contact, substep);
}

// A segment that tilts on a round body touches it farther along, by the radius of curvature ρ times the angle, so its
// push N rights it with the moment N ρ a radian: as stiff as the line's tension. Contacts of the substep's start would
// have it one substep late, and the segments would zigzag. Off the tilt that the contact was found with.
void TouchSprings::add_rolling(const Nodes& nodes, const SegmentContact& contact, const Substep& substep) {
    const TouchSpring& touch = springs_.back();
    const std::uint32_t a = contact.node, b = contact.node + 1;
    const double squared = length_squared(nodes.position[b] - nodes.position[a]);
    const double push = dot(touch.pull, touch.normal);
    if (!(push > 0 && squared > 0)) return;
    TouchSpring rolling{.node = {a, b}, .weight = {-1, 1}, .count = 2, .is_attachment = true, .normal = touch.normal};
    rolling.stiffness = push * contact.curvature_radius / squared;
    rolling.matrix = rolling.stiffness * outer(touch.normal, touch.normal);
    rolling.load = rolling.matrix * (substep.h * (nodes.mean_velocity[b] - nodes.mean_velocity[a]));
    rolling.acts = true;
    springs_.push_back(rolling);
}

// Along its circle: the error of a straight path would pull a stiff rope that sticks to a turning drum.
TouchSprings::Place TouchSprings::place_of(const TouchedBody& body, const Substep& substep) {
    const double end = substep.time + substep.h;
    Place place{body.center_at(end), body.rotation_at(end)};
    place.displacement = place.center - body.center_before(substep.h, end);
    place.back = body.rotation_before(substep.h, end) * transpose(place.rotation);
    return place;
}

void TouchSprings::begin(const Nodes& nodes, std::span<const NodeContact> contacts, std::span<const TouchedBody> bodies,
                         const Substep& substep, std::span<const double> node_stiffness) {
    const ThinContactSettings& settings = substep.settings.thin_contact;
    max_load_ = std::accumulate(nodes.mass.begin(), nodes.mass.end(), 0.0);
    std::vector<bool> is_near(bodies.size(), false);
    for (const NodeContact& contact : contacts) is_near[contact.body] = true;
    for (std::size_t b = 0; b < bodies.size(); ++b)
        max_load_ += is_near[b] && bodies[b].inverse_mass > 0 ? 1 / bodies[b].inverse_mass : 0;
    if (forgets_depth) loads_ = loads_of(bodies, nodes.size());
    places_.clear();
    for (const TouchedBody& body : bodies) places_.push_back(place_of(body, substep));
    springs_.clear();
    for (const NodeContact& contact : contacts) {
        if (is_attached(contact.node, contact.body)) continue;
        TouchSpring spring{.node = {contact.node}, .weight = {1}, .feature = {contact.node, no_node}};
        complete(nodes, contact, bodies, substep, node_stiffness, spring);
    }
    if (forgets_depth) forget_contradictions(bodies, substep, nodes.size());
    for (std::size_t i = 0; i < attachments.size(); ++i) {
        const Attachment& attachment = attachments[i];
        const std::uint32_t b = attachment_bodies[i];
        if (b == no_body) continue;
        const TouchedBody& body = bodies[b];
        TouchSpring spring{.node = {attachment.node},
                           .weight = {1},
                           .feature = {attachment.node, no_node},
                           .body = b,
                           .is_attachment = true};
        spring.normal = {1, 0, 0};
        // The anchor is in the frame of the body's pose at the step's start.
        const Vec3 anchor = transform_point(body.start, attachment.anchor) - body.start_center;
        spring.arm = places_[b].rotation * anchor;
        spring.carried = nodes.position[attachment.node] - places_[b].center - spring.arm;  // from the anchor
        spring.stiffness = settings.stiffness_factor * node_stiffness[attachment.node];
        recall(body, settings, spring);
        springs_.push_back(spring);
    }
}

bool TouchSprings::choose(std::span<const Vec3> node_moves, std::span<const BodyMove> body_moves, bool is_predicted) {
    SpringChange sum;
    for (TouchSpring& spring : springs_) {
        if (spring.is_attachment) {
            if (spring.body == no_body) continue;  // of a rolling segment
            spring.acts = true;
            spring.matrix = spring.stiffness * Mat3::identity();
            spring.load = spring.pull - spring.stiffness * spring.carried;
            continue;
        }
        choose_contact(spring, spring.lead(node_moves, body_moves), is_predicted, sum);
    }
    return sum.change > tolerance * sum.near;
}

// A point that has come in where no solve had a contact, since another solve was not made, is stopped alone: by an
// impulse between it and the body, one point after the other, so that many heavy points do not throw a light body.
bool TouchSprings::stop(TouchSpring& spring, std::span<Vec3> node_moves, std::span<BodyMove> body_moves,
                        std::span<const TouchedBody> bodies, double h) {
    if (spring.count != 1 || spring.is_attachment) return false;
    const Vec3 s = spring.lead(node_moves, body_moves), slip = across(s - spring.carried, spring.normal);
    const double depth = -(spring.gap + dot(spring.normal, s));
    if (depth <= 0) return false;
    double compliance = 0;  // 1/kg
    if (spring.body != no_body) {
        const Vec3 turning = cross(spring.arm, spring.normal);
        compliance = bodies[spring.body].inverse_mass + dot(turning, bodies[spring.body].inverse_inertia * turning);
    }
    const double inertia = spring.inertia / (1 + spring.inertia * compliance * h * h);
    const double push = inertia * depth, size = length(slip);
    spring.felt = push * spring.normal;
    if (size > 0) spring.felt -= (std::min(spring.friction.sliding * push, inertia * size) / size) * slip;
    node_moves[spring.node[0]] += spring.felt / spring.inertia;
    if (spring.body != no_body) {
        body_moves[spring.body].shift -= (bodies[spring.body].inverse_mass * h * h) * spring.felt;
        body_moves[spring.body].turn -= bodies[spring.body].inverse_inertia * (h * h * cross(spring.arm, spring.felt));
    }
    return spring.acts = true;
}

void TouchSprings::finish(std::span<Vec3> node_moves, std::span<const BodyMove> body_moves, const Substep& substep,
                          std::span<TouchedBody> bodies, std::span<const double> fractions) {
    memory_.clear();
    std::vector<BodyMove> moved(body_moves.begin(), body_moves.end());  // with those by nodes that are stopped
    // The forces are those of the solve: a node that is stopped below would stretch stiff springs that were in it.
    leads_.clear();
    for (TouchSpring& spring : springs_) {
        leads_.push_back(spring.lead(node_moves, body_moves));
        if (spring.acts) spring.felt = spring.force(leads_.back());
    }
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        TouchSpring& spring = springs_[i];
        if (!spring.acts) {
            if (!stop(spring, node_moves, moved, bodies, substep.h)) continue;
            leads_[i] = spring.lead(node_moves, moved);
        }
        if (spring.body == no_body) continue;
        if (!fractions.empty()) spring.felt *= fractions[spring.body];
        const Vec3 s = leads_[i], force = spring.felt;
        bodies[spring.body].push(-substep.h * force, spring.arm, substep.h);
        if (spring.is_recovery) continue;
        Memory memory{spring.feature, bodies[spring.body].body, spring.is_attachment, true, spring.normal, force, {}};
        if (!spring.is_attachment) {
            const double push = std::max(0.0, dot(force, spring.normal));
            memory.pull = kept_push(spring, push) * spring.normal;
            memory.hold =
                held_stretch(spring, spring.hold + across(s - spring.carried, spring.normal), push, substep.h);
            memory.sticks = spring.sticks;
        }
        memory_.push_back(memory);
    }
    std::ranges::stable_sort(memory_, {}, &Memory::feature);
}

}  // namespace embody::physics::deformable
