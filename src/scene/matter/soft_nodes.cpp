// SPDX-License-Identifier: MIT
#include "scene/matter/soft_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "math/mat3.h"

namespace embody::scene {

using physics::Attachment;
using physics::BodyHandle;
using physics::Clamp;
using physics::DeformableDefinition;
using physics::Tie;

namespace {

// Of the greatest extent: how far around a place a hand holds a solid, and cloth or a rope, which it pinches.
constexpr double hand_share = 0.12, pinch_share = 0.03;
constexpr double hand_radius = 1e-3;  // m; it collides with nothing

std::vector<std::array<std::uint32_t, 3>> outer_faces(const DeformableDefinition& definition) {
    if (const auto* cloth = std::get_if<physics::Cloth>(&definition.matter)) return cloth->triangles;
    std::vector<std::array<std::uint32_t, 3>> faces;
    if (const auto* solid = std::get_if<physics::SoftSolid>(&definition.matter)) {
        for (const auto& face : geometry::find_tetrahedral_topology(solid->tetrahedra).outer_faces)
            faces.push_back(face.corners);
    }
    return faces;
}

// All of a rope's.
std::vector<std::uint32_t> nodes_of(const std::vector<std::array<std::uint32_t, 3>>& faces, std::size_t count) {
    std::vector<std::uint32_t> nodes;
    if (faces.empty()) {
        nodes.resize(count);
        std::iota(nodes.begin(), nodes.end(), 0u);
    }
    for (const auto& face : faces) nodes.insert(nodes.end(), face.begin(), face.end());
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

}  // namespace

Result<std::unique_ptr<SoftNodes>> SoftNodes::create(physics::World& world, const DeformableDefinition& definition) {
    const auto handle = world.create_deformable(definition);
    if (!handle) return handle.error();
    std::unique_ptr<SoftNodes> nodes(new SoftNodes(world, *handle));
    nodes->faces_ = outer_faces(definition);
    nodes->surface_ = nodes_of(nodes->faces_, definition.nodes.size());
    nodes->holds_ = {definition.attachments, definition.clamps, definition.ties};
    return nodes;
}

// Whether a body that the rope collides with is there.
bool SoftNodes::is_blocked(Vec3 place) const {
    const double radius = deformable()->contact_radius;
    const Vec3 half{radius, radius, radius};
    return std::ranges::any_of(world_.overlap_box({place - half, place + half}), [&](BodyHandle handle) {
        const std::optional<physics::BodyDefinition> body = world_.body(handle);
        return body && body->enabled && (body->collision_mask & deformable()->collision_group) != 0 &&
               (deformable()->collision_mask & body->collision_group) != 0;
    });
}

// A slack rope is not pressed straight between its ends.
Result<void> SoftNodes::hang(std::vector<HeldNode> held) {
    const auto* rope = std::get_if<physics::Rope>(&deformable()->matter);
    if (!rope || !(rope->slack > 0) || std::exchange(has_hung_, true)) return {};
    SlackRope slack{.held = std::move(held), .slack = rope->slack};
    read(slack.line);
    slack.down = normalized(world_.settings().gravity, {0, -1, 0});
    const auto velocities = world_.node_velocities(handle_);
    return world_.set_nodes(handle_, slack_line(slack, [this](Vec3 place) { return is_blocked(place); }),
                            std::vector<Vec3>(velocities.begin(), velocities.end()));
}

SoftNodes::~SoftNodes() {
    let_go();
    // It is in the world, which does not refuse.
    (void)world_.destroy_deformable(handle_).ok();
}

Result<void> SoftNodes::set_definition(const PointsDefinition& definition) {
    const auto& taken = std::get<DeformableDefinition>(definition);
    let_go();
    if (auto set = world_.set_deformable(handle_, taken); !set) return set;
    holds_ = {taken.attachments, taken.clamps, taken.ties};
    return {};
}

Result<void> SoftNodes::attach(Holds holds) {
    holds_ = std::move(holds);
    return apply_holds();
}

Holds SoftNodes::holds() const {
    Holds there = holds_;
    std::erase_if(there.attachments,
                  [this](const Attachment& attachment) { return !world_.contains(attachment.body); });
    std::erase_if(there.ties, [this](const Tie& tie) { return world_.deformable(tie.other) == nullptr; });
    const std::vector<std::uint32_t>& pinned = deformable()->pinned;
    std::erase_if(there.clamps, [&](const Clamp& clamp) {
        return std::ranges::find(pinned, clamp.node) == pinned.end() &&
               std::ranges::find(there.attachments, clamp.node, &Attachment::node) == there.attachments.end();
    });
    return there;
}

// What is held by the hand is not held by anything else meanwhile; a clamped node stays clamped, in the hand.
Result<void> SoftNodes::apply_holds() {
    const auto is_in_hand = [this](const auto& hold) {
        return std::ranges::find(held_, hold.node, &Attachment::node) != held_.end();
    };
    Holds all = holds();
    for (Clamp& clamp : all.clamps) {
        const auto at = std::ranges::find(all.attachments, clamp.node, &Attachment::node);
        if (!is_in_hand(clamp) || at == all.attachments.end()) continue;
        const Vec3 direction = rotate(world_.pose(at->body).rotation, clamp.direction);
        clamp.direction = rotate_inverse(world_.pose(hand_).rotation, direction);
    }
    std::erase_if(all.attachments, is_in_hand);
    std::erase_if(all.ties, is_in_hand);
    all.attachments.insert(all.attachments.begin(), held_.begin(), held_.end());
    return world_.set_attachments(handle_, all.attachments, all.clamps, all.ties);
}

const DeformableDefinition* SoftNodes::deformable() const { return world_.deformable(handle_); }

void SoftNodes::read(std::vector<Vec3>& positions) const {
    const auto nodes = world_.node_positions(handle_);
    positions.assign(nodes.begin(), nodes.end());
}

physics::SleepState SoftNodes::state() const {
    return world_.is_asleep(handle_) ? physics::SleepState::asleep : physics::SleepState::active;
}

Bounds SoftNodes::bounds() const {
    Bounds bounds;
    for (const Vec3 p : world_.node_positions(handle_)) bounds.add(p);
    return bounds;
}

// A ray down from each node of the surface that others do not cover.
std::optional<double> SoftNodes::drop_distance(double most) const {
    const auto positions = world_.node_positions(handle_);
    const double clearance = deformable()->contact_radius;
    std::optional<double> least;
    for (const std::uint32_t node : surface_) {
        const auto hit = world_.cast_ray(positions[node], {0, -1, 0}, most + clearance);
        if (hit && (!least || hit->distance < *least)) least = hit->distance;
    }
    if (least) *least = std::max(0.0, *least - clearance);
    return least;
}

std::optional<SurfaceHit> SoftNodes::cast_ray(Vec3 origin, Vec3 direction, double most) const {
    return faces_.empty() ? meet_line(origin, direction, most) : meet_faces(origin, direction, most);
}

// Balls along the segments: where the ray comes nearest to one, and nearer than its radius.
std::optional<SurfaceHit> SoftNodes::meet_line(Vec3 origin, Vec3 direction, double most) const {
    const auto positions = world_.node_positions(handle_);
    const double radius = deformable()->contact_radius;
    const std::vector<std::uint32_t> broken = world_.broken_segments(handle_);
    std::optional<SurfaceHit> nearest;
    for (std::uint32_t s = 0; s + 1 < positions.size(); ++s) {
        if (std::ranges::binary_search(broken, s)) continue;
        const Vec3 from = positions[s], edge = positions[s + 1] - from, to = origin - from;
        const double along = dot(edge, direction), square = length_squared(edge);
        const double across = square - along * along;
        double part = across > 0 ? (dot(to, edge) - along * dot(to, direction)) / across : 0;
        part = std::clamp(part, 0.0, 1.0);
        const Vec3 center = from + part * edge;
        const double ahead = dot(center - origin, direction);
        const double beside = length_squared(center - origin) - ahead * ahead;
        if (beside > radius * radius) continue;
        const double distance = ahead - std::sqrt(radius * radius - beside);
        if (distance < 0 || distance > most || (nearest && distance >= nearest->distance)) continue;
        nearest = SurfaceHit{distance, normalized(origin + distance * direction - center, -direction)};
    }
    return nearest;
}

// T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, for each face that is met from
// outside, of cloth from either side.
std::optional<SurfaceHit> SoftNodes::meet_faces(Vec3 origin, Vec3 direction, double most) const {
    const auto positions = world_.node_positions(handle_);
    const bool has_two_sides = std::holds_alternative<physics::Cloth>(deformable()->matter);
    std::optional<SurfaceHit> nearest;
    for (const auto& face : faces_) {
        const Vec3 a = positions[face[0]];
        Vec3 along = positions[face[1]] - a, across = positions[face[2]] - a;
        if (has_two_sides && dot(direction, cross(along, across)) > 0) std::swap(along, across);
        const Vec3 p = cross(direction, across);
        const double facing = dot(along, p);
        if (!(facing > 0)) continue;
        const Vec3 from = origin - a, q = cross(from, along);
        const double u = dot(from, p), v = dot(direction, q);
        if (u < 0 || v < 0 || u + v > facing) continue;
        const double distance = dot(across, q) / facing;
        if (distance < 0 || distance > most || (nearest && distance >= nearest->distance)) continue;
        nearest = SurfaceHit{distance, normalized(cross(along, across))};
    }
    return nearest;
}

BodyHandle SoftNodes::hold(Vec3 position) {
    let_go();
    const auto positions = world_.node_positions(handle_);
    const Vec3 size = bounds().size();
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : surface_) nearest = std::min(nearest, length(positions[node] - position));
    const bool is_solid = std::holds_alternative<physics::SoftSolid>(deformable()->matter);
    const double reach = nearest + (is_solid ? hand_share : pinch_share) * std::max({size.x, size.y, size.z});

    const auto shape = world_.create_shape(physics::SphereShape{hand_radius});
    if (!shape) return {};
    physics::BodyDefinition hand;
    hand.shape = hand_shape_ = *shape;
    hand.position = position;
    hand.mass.mass = mass();
    // As hard to turn as a ball of the thing's mass and half its size.
    const double spread = 0.1 * hand.mass.mass.value_or(1) * length_squared(0.5 * size);
    hand.mass.inertia = Mat3::diagonal({spread, spread, spread});
    hand.gravity_factor = 0;
    hand.collision_group = hand.collision_mask = 0;
    hand.allow_sleep = false;
    hand.user_data = deformable()->user_data;
    const auto body = world_.create_body(hand);
    if (body) {
        hand_ = *body;
        const auto& pinned = deformable()->pinned;
        for (const std::uint32_t node : surface_) {
            if (length(positions[node] - position) > reach || std::ranges::find(pinned, node) != pinned.end()) continue;
            held_.push_back({node, hand_, positions[node] - position});
        }
        if (apply_holds()) return hand_;
    }
    let_go();
    return {};
}

void SoftNodes::let_go() {
    held_.clear();
    if (!hand_.is_null()) {
        // Both are in the world, which does not refuse.
        (void)apply_holds().ok();
        (void)world_.destroy_body(hand_).ok();
        hand_ = {};
    }
    if (!hand_shape_.is_null()) (void)world_.destroy_shape(hand_shape_).ok();
    hand_shape_ = {};
}

Result<void> SoftNodes::move(const Transform& motion) {
    std::vector<Vec3> positions;
    read(positions);
    for (Vec3& position : positions) position = transform_point(motion, position);
    const auto& pinned = deformable()->pinned;
    for (Clamp& clamp : holds_.clamps) {
        if (std::ranges::find(pinned, clamp.node) != pinned.end())
            clamp.direction = rotate(motion.rotation, clamp.direction);
    }
    if (auto turned = apply_holds(); !turned) return turned;
    return world_.set_nodes(handle_, positions, std::vector<Vec3>(positions.size()));
}

Result<void> SoftNodes::set_velocity(Vec3 linear, Vec3 angular) {
    std::vector<Vec3> positions;
    read(positions);
    std::vector<Vec3> velocities;
    const Vec3 center = center_of_mass();
    for (const Vec3 position : positions) velocities.push_back(linear + cross(angular, position - center));
    return world_.set_nodes(handle_, positions, velocities);
}

Result<void> SoftNodes::apply_impulse(Vec3 impulse) {
    const auto positions = world_.node_positions(handle_), before = world_.node_velocities(handle_);
    std::vector<Vec3> velocities(before.begin(), before.end());
    for (Vec3& velocity : velocities) velocity += impulse / mass();
    return world_.set_nodes(handle_, std::vector<Vec3>(positions.begin(), positions.end()), velocities);
}

Result<void> SoftNodes::apply_force(Vec3 force) { return apply_impulse(world_.settings().time_step * force); }

Result<void> SoftNodes::set_enabled(bool enabled) {
    DeformableDefinition changed = *deformable();
    changed.enabled = enabled;
    Holds held = holds();
    changed.attachments = std::move(held.attachments);
    changed.clamps = std::move(held.clamps);
    changed.ties = std::move(held.ties);
    return set_definition(changed);
}

Vec3 SoftNodes::linear_velocity() const {
    Vec3 momentum;
    double whole = 0;
    const auto masses = world_.node_masses(handle_);
    const auto velocities = world_.node_velocities(handle_);
    for (std::size_t i = 0; i < masses.size(); ++i) {
        momentum += masses[i] * velocities[i];
        whole += masses[i];
    }
    return whole > 0 ? momentum / whole : Vec3{};
}

Vec3 SoftNodes::angular_velocity() const {
    const auto masses = world_.node_masses(handle_);
    const auto velocities = world_.node_velocities(handle_), positions = world_.node_positions(handle_);
    const Vec3 center = center_of_mass();
    Vec3 momentum;
    Mat3 inertia = Mat3::zero();
    for (std::size_t i = 0; i < masses.size(); ++i) {
        const Vec3 arm = positions[i] - center;
        momentum += masses[i] * cross(arm, velocities[i]);
        inertia += masses[i] * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
    }
    return inverse_or_zero(inertia) * momentum;
}

}  // namespace embody::scene
