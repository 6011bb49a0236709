// SPDX-License-Identifier: MIT
#include "scene/matter/soft_nodes.h"

#include <algorithm>
#include <limits>
#include <ranges>
#include <utility>

#include "math/mat3.h"

namespace embody::scene {

using physics::Attachment;
using physics::BodyHandle;
using physics::Clamp;
using physics::DeformableDefinition;
using physics::Tie;

namespace {

// Radius around a place in which a hand holds nodes, as a fraction of the largest extent: of a solid, and of cloth or a
// rope, which it pinches.
constexpr double hand_fraction = 0.12, pinch_fraction = 0.03;
constexpr double hand_radius = 1e-3;  // m; it collides with nothing

}  // namespace

Result<std::unique_ptr<SoftNodes>> SoftNodes::create(physics::World& world, const DeformableDefinition& definition) {
    const auto handle = world.create_deformable(definition);
    if (!handle) return handle.error();
    std::unique_ptr<SoftNodes> nodes(new SoftNodes(world, *handle, DeformableSurface(definition)));
    nodes->holds_ = {definition.attachments, definition.clamps, definition.ties};
    return nodes;
}

// Whether a body that the rope collides with is at the place.
bool SoftNodes::is_blocked(Vec3 place) const {
    const double radius = definition().contact_radius;
    const Vec3 half{radius, radius, radius};
    return std::ranges::any_of(world_.overlap_box({place - half, place + half}), [&](BodyHandle handle) {
        const std::optional<physics::BodyDefinition> body = world_.body(handle);
        return body && body->enabled && (body->collision_mask & definition().collision_group) != 0 &&
               (definition().collision_mask & body->collision_group) != 0;
    });
}

Result<void> SoftNodes::begin_as(std::span<const Vec3> places, const physics::LastingDeformation& lasting) {
    has_hung_ = true;
    if (auto set = world_.set_lasting_deformation(handle_, lasting); !set) return set;
    if (auto set = world_.set_nodes(handle_, places, std::vector<Vec3>(places.size())); !set) return set;
    const auto& [linear, angular] = std::pair(definition().linear_velocity, definition().angular_velocity);
    return linear == Vec3{} && angular == Vec3{} ? Result<void>{} : set_velocity(linear, angular);
}

// A slack rope starts in arcs, since on a straight line it would be compressed between its ends.
Result<void> SoftNodes::hang(std::vector<HeldNode> held) {
    const auto* rope = std::get_if<physics::Rope>(&definition().matter);
    if (!rope || !(rope->slack > 0) || std::exchange(has_hung_, true)) return {};
    SlackRope slack{.held = std::move(held), .slack = rope->slack};
    read(slack.line);
    slack.down = normalized(world_.settings().gravity, {0, -1, 0});
    const auto velocities = world_.node_velocities(handle_);
    return world_.set_nodes(handle_, slack_line(slack, [this](Vec3 place) { return is_blocked(place); }),
                            std::vector<Vec3>(velocities.begin(), velocities.end()));
}

SoftNodes::~SoftNodes() {
    for (const Hand& hand : std::exchange(hands_, {})) remove(hand);
    // The deformable is in the world, so that the world does not refuse.
    (void)world_.destroy_deformable(handle_).ok();
}

Result<void> SoftNodes::set_definition(const PointsDefinition& definition) {
    const auto& taken = std::get<DeformableDefinition>(definition);
    if (auto set = world_.set_deformable(handle_, taken); !set) return set;
    holds_ = {taken.attachments, taken.clamps, taken.ties};
    return hands_.empty() ? Result<void>{} : apply_holds();
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
    const std::vector<std::uint32_t>& pinned = definition().pinned;
    std::erase_if(there.clamps, [&](const Clamp& clamp) {
        return std::ranges::find(pinned, clamp.node) == pinned.end() &&
               std::ranges::find(there.attachments, clamp.node, &Attachment::node) == there.attachments.end();
    });
    return there;
}

SoftNodes::Hand* SoftNodes::hand_at(std::uint32_t node) {
    const auto holds_it = [node](const Hand& hand) {
        return std::ranges::find(hand.held, node, &Attachment::node) != hand.held.end();
    };
    const auto found = std::ranges::find_if(hands_, holds_it);
    return found == hands_.end() ? nullptr : &*found;
}

// A node in a hand is held by nothing else meanwhile; a clamped node stays clamped, to the hand.
Result<void> SoftNodes::apply_holds() {
    const auto is_in_hand = [this](const auto& hold) { return hand_at(hold.node) != nullptr; };
    Holds all = holds();
    for (Clamp& clamp : all.clamps) {
        const auto at = std::ranges::find(all.attachments, clamp.node, &Attachment::node);
        const Hand* hand = hand_at(clamp.node);
        if (!hand || at == all.attachments.end()) continue;
        const Vec3 direction = rotate(world_.pose(at->body).rotation, clamp.direction);
        clamp.direction = rotate_inverse(world_.pose(hand->body).rotation, direction);
    }
    std::erase_if(all.attachments, is_in_hand);
    std::erase_if(all.ties, is_in_hand);
    for (const Hand& hand : hands_) all.attachments.insert(all.attachments.begin(), hand.held.begin(), hand.held.end());
    return world_.set_attachments(handle_, all.attachments, all.clamps, all.ties);
}

void SoftNodes::read(std::vector<Vec3>& positions) const {
    const auto nodes = world_.node_positions(handle_);
    positions.assign(nodes.begin(), nodes.end());
}

void SoftNodes::read_velocities(std::vector<Vec3>& velocities) const {
    const auto nodes = world_.node_velocities(handle_);
    velocities.assign(nodes.begin(), nodes.end());
}

const DeformableSurface& SoftNodes::surface() const {
    if (surface_points_ != membership()) {
        surface_ = DeformableSurface(definition());
        surface_points_ = membership();
    }
    return surface_;
}

std::vector<physics::TornCorner> SoftNodes::torn_corners(std::size_t points) const {
    std::vector<physics::TornCorner> torn = lasting_deformation().torn_corners;
    std::erase_if(torn, [points](const physics::TornCorner& corner) { return corner.node >= points; });
    return torn;
}

DeformableDefinition SoftNodes::definition_of(std::size_t points) const {
    DeformableDefinition whole = definition();
    auto* cloth = std::get_if<physics::Cloth>(&whole.matter);
    const std::vector<physics::TornCorner> corners = lasting_deformation().torn_corners;
    if (cloth == nullptr || corners.empty()) return whole;
    const std::uint32_t first = std::ranges::min(corners, {}, &physics::TornCorner::node).node;
    points = std::clamp<std::size_t>(points, first, whole.nodes.size());
    for (const physics::TornCorner& torn : corners | std::views::reverse) {
        if (torn.node >= points) cloth->triangles[torn.corner / 3][torn.corner % 3] = torn.from;
    }
    whole.nodes.resize(points);
    return whole;
}

Result<void> SoftNodes::tear(const std::vector<physics::TornCorner>& corners) {
    physics::LastingDeformation lasting = lasting_deformation();
    lasting.torn_corners = corners;
    return world_.set_lasting_deformation(handle_, lasting);
}

physics::SleepState SoftNodes::state() const {
    return world_.is_asleep(handle_) ? physics::SleepState::asleep : physics::SleepState::active;
}

Bounds SoftNodes::bounds() const {
    Bounds bounds;
    for (const Vec3 p : world_.node_positions(handle_)) bounds.add(p);
    return bounds;
}

// Casts a ray down from each surface node.
std::optional<double> SoftNodes::drop_distance(double max_distance) const {
    const auto positions = world_.node_positions(handle_);
    const double clearance = definition().contact_radius;
    std::optional<double> min_distance;
    for (const std::uint32_t node : surface().nodes()) {
        const auto hit = world_.cast_ray(positions[node], {0, -1, 0}, max_distance + clearance);
        if (hit && (!min_distance || hit->distance < *min_distance)) min_distance = hit->distance;
    }
    if (min_distance) *min_distance = std::max(0.0, *min_distance - clearance);
    return min_distance;
}

std::optional<SurfaceHit> SoftNodes::cast_ray(Vec3 origin, Vec3 direction, double max_distance) const {
    const Ray ray{origin, direction, max_distance};
    const auto positions = world_.node_positions(handle_);
    if (surface().has_faces()) return surface().meet(positions, ray);
    return meet_rope(positions, definition().contact_radius, world_.broken_segments(handle_), ray);
}

Result<SoftNodes::Hand> SoftNodes::make_hand(Vec3 position) {
    Hand hand;
    const auto shape = world_.create_shape(physics::SphereShape{hand_radius});
    if (!shape) return shape.error();
    physics::BodyDefinition body;
    body.shape = hand.shape = *shape;
    body.position = position;
    body.mass.mass = mass();
    // Moment of inertia as of a ball of the thing's mass and half its size.
    const double spread = 0.1 * mass() * length_squared(0.5 * bounds().size());
    body.mass.inertia = Mat3::diagonal({spread, spread, spread});
    body.gravity_factor = 0;
    body.collision_group = body.collision_mask = 0;
    body.allow_sleep = false;
    body.user_data = definition().user_data;
    const auto made = world_.create_body(body);
    if (!made) {
        (void)world_.destroy_shape(hand.shape).ok();
        return made.error();
    }
    hand.body = *made;
    return hand;
}

// The body and shape are in the world, so that the world does not refuse.
void SoftNodes::remove(const Hand& hand) {
    (void)world_.destroy_body(hand.body).ok();
    (void)world_.destroy_shape(hand.shape).ok();
}

BodyHandle SoftNodes::hold(Vec3 position) {
    const auto positions = world_.node_positions(handle_);
    const Vec3 size = bounds().size();
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : surface().nodes()) nearest = std::min(nearest, length(positions[node] - position));
    const bool is_solid = std::holds_alternative<physics::SoftSolid>(definition().matter);
    const double reach = nearest + (is_solid ? hand_fraction : pinch_fraction) * std::max({size.x, size.y, size.z});

    std::vector<std::uint32_t> free;
    Hand* other = nullptr;
    const auto& pinned = definition().pinned;
    for (const std::uint32_t node : surface().nodes()) {
        if (length(positions[node] - position) > reach || std::ranges::find(pinned, node) != pinned.end()) continue;
        if (Hand* holder = hand_at(node))
            other = holder;
        else
            free.push_back(node);
    }
    if (free.empty() && other) {
        ++other->holds;
        return other->body;
    }
    Result<Hand> hand = make_hand(position);
    if (!hand) return {};
    for (const std::uint32_t node : free) hand->held.push_back({node, hand->body, positions[node] - position});
    hands_.push_back(*hand);
    if (apply_holds()) return hand->body;
    let_go(hand->body);
    return {};
}

void SoftNodes::let_go(BodyHandle body) {
    const auto found = std::ranges::find(hands_, body, &Hand::body);
    if (found == hands_.end() || --found->holds > 0) return;
    const Hand hand = std::move(*found);
    hands_.erase(found);
    // The nodes are in the world, so that it does not refuse.
    (void)apply_holds().ok();
    remove(hand);
}

Result<void> SoftNodes::set_points(std::span<const Vec3> positions, std::span<const Vec3> velocities) {
    return world_.set_nodes(handle_, positions, velocities);
}

Result<void> SoftNodes::move(const Transform& motion) {
    std::vector<Vec3> positions;
    read(positions);
    for (Vec3& position : positions) position = transform_point(motion, position);
    const auto& pinned = definition().pinned;
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
    DeformableDefinition changed = definition();
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
