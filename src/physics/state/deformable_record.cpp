// SPDX-License-Identifier: MIT
#include "physics/state/deformable_record.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "physics/deformable/contact/free_motion.h"

namespace embody::physics::state {

namespace {

// Segments of ropes collide as capsules of their length at rest; segments of equal length use one capsule.
Result<void> make_capsules(DeformableRecord& record) {
    const DeformableDefinition& definition = record.definition;
    const double stretch = 1 + std::get<Rope>(definition.matter).slack;
    std::vector<double> lengths;
    for (std::size_t s = 0; s + 1 < definition.nodes.size(); ++s) {
        const double own = stretch * length(definition.nodes[s + 1] - definition.nodes[s]);
        const auto same = std::ranges::find_if(lengths, [&](double l) { return std::fabs(l - own) < 1e-6 * own; });
        record.segment_capsule.push_back(static_cast<std::uint32_t>(same - lengths.begin()));
        if (same != lengths.end()) continue;
        lengths.push_back(own);
        auto capsule = CollisionShape::create(CapsuleShape{definition.contact_radius, own / 2});
        if (!capsule) return capsule.error();
        record.capsules.push_back(std::move(*capsule));
    }
    return {};
}

// The nodes of a sheet or rope.
Nodes& thin_nodes(const DeformableRecord& record) {
    return record.cloth() ? record.cloth()->nodes() : record.rope()->nodes();
}

// Values of nodes for those that have come from them: the same, or by their fraction of its mass.
void take_by_node(std::vector<Vec3>& values, std::span<const std::uint32_t> origin, std::span<const double> fractions) {
    if (values.empty()) return;
    std::vector<Vec3> taken;
    for (std::size_t i = 0; i < origin.size(); ++i)
        taken.push_back((fractions.empty() ? 1 : fractions[i]) * values[origin[i]]);
    values = std::move(taken);
}

}  // namespace

Result<DeformableRecord> make_deformable_record(const DeformableDefinition& definition) {
    DeformableRecord record;
    record.definition = definition;
    auto ball = CollisionShape::create(SphereShape{definition.contact_radius});
    if (!ball) return ball.error();
    record.node_ball = std::move(*ball);
    if (std::holds_alternative<Cloth>(definition.matter)) {
        record.matter = std::make_unique<ClothSheet>(definition);
    } else if (std::holds_alternative<Rope>(definition.matter)) {
        record.matter = std::make_unique<RopeLine>(definition);
        if (auto made = make_capsules(record); !made) return made.error();
    } else {
        record.matter = std::make_unique<SolidDeformable>(definition);
    }
    record.last_positions = record.nodes().position;
    return record;
}

Result<DeformableRecord> make_torn_record(const DeformableRecord& record, std::span<const TornCorner> corners) {
    DeformableDefinition definition = record.definition;
    if (auto torn = tear(definition, corners); !torn) return torn.error();
    if (auto valid = validate(definition); !valid) return valid.error();
    Result<DeformableRecord> made = make_deformable_record(definition);
    if (!made) return made;

    // Node by node; a new one is at first where the one is that its corner had.
    std::vector<std::uint32_t> origin(definition.nodes.size());
    std::iota(origin.begin(), origin.end(), 0);
    for (const TornCorner& torn : corners) origin[torn.node] = origin[torn.from];
    const Nodes& from = record.nodes();
    Nodes& to = made->cloth()->nodes();
    for (std::size_t i = 0; i < origin.size(); ++i) {
        to.position[i] = from.position[origin[i]];
        to.mean_velocity[i] = from.mean_velocity[origin[i]];
        to.velocity[i] = from.velocity[origin[i]];
    }
    std::vector<double> fractions;  // of the node's mass
    for (std::size_t i = 0; i < origin.size(); ++i) fractions.push_back(to.mass[i] / from.mass[origin[i]]);
    made->last_positions = to.position;
    made->cloth()->go_on_from(*record.cloth());
    made->contacts = record.contacts;
    made->touched_bodies = record.touched_bodies;
    made->touched_deformables = record.touched_deformables;
    made->supports = record.supports;
    made->surface_pushes = record.surface_pushes;
    made->tie_pulls = record.tie_pulls;
    made->liquid = record.liquid;
    take_by_node(made->liquid.velocity, origin, {});
    take_by_node(made->liquid.acceleration, origin, {});
    for (std::vector<Vec3>* shared :
         {&made->liquid.force, &made->liquid.bound, &made->liquid.bound_momentum, &made->liquid.force_asleep})
        take_by_node(*shared, origin, fractions);
    made->slot = record.slot;
    made->torn = record.torn;
    made->torn.insert(made->torn.end(), corners.begin(), corners.end());
    return made;
}

const Nodes& DeformableRecord::nodes() const {
    return std::visit([](const auto& own) -> const Nodes& { return std::as_const(*own).nodes(); }, matter);
}

Bounds DeformableRecord::bounds() const {
    if (const SolidDeformable* own = solid()) return own->bounds();
    Bounds box;
    for (const Vec3 position : nodes().position) box.add(position);
    return box;
}

bool DeformableRecord::is_finite() const {
    if (const SolidDeformable* own = solid()) return own->is_finite();
    return !(cloth() ? cloth()->is_frozen() : rope()->is_frozen());
}

Vec3 DeformableRecord::acceleration(Vec3 gravity) const {
    const Vec3 pull = definition.gravity_factor * gravity;
    if (definition.force == Vec3{}) return pull;
    double mass = 0;
    for (const double own : nodes().mass) mass += own;
    return pull + definition.force / mass;
}

Conserved DeformableRecord::conserved(Vec3 gravity) const {
    if (const SolidDeformable* own = solid()) return own->conserved(gravity);
    Conserved sum;
    const Nodes& all = nodes();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!(all.inverse_mass[i] > 0)) continue;
        const Vec3 momentum = all.mass[i] * all.velocity[i];
        sum.kinetic_energy += dot(momentum, all.velocity[i]) / 2;
        sum.potential_energy -= all.mass[i] * dot(gravity, all.position[i]);
        sum.linear_momentum += momentum;
        sum.angular_momentum += cross(all.position[i], momentum);
    }
    sum.potential_energy += cloth() ? cloth()->elastic_energy() : rope()->elastic_energy();
    return sum;
}

bool DeformableRecord::has_tetrahedra_of(const DeformableRecord& other) const {
    const auto* own = std::get_if<SoftSolid>(&definition.matter);
    const auto* others = std::get_if<SoftSolid>(&other.definition.matter);
    return own != nullptr && others != nullptr && own->tetrahedra == others->tetrahedra;
}

bool DeformableRecord::has_surface_of(const DeformableRecord& other) const {
    const auto* own = std::get_if<Cloth>(&definition.matter);
    const auto* others = std::get_if<Cloth>(&other.definition.matter);
    if (own != nullptr && others != nullptr) return own->triangles == others->triangles;
    return std::holds_alternative<Rope>(definition.matter) && std::holds_alternative<Rope>(other.definition.matter);
}

Quat DeformableRecord::rotation() const { return solid() ? solid()->rotation(0) : definition.pose.rotation; }

void DeformableRecord::set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation) {
    bounces.clear();
    if (SolidDeformable* own = solid()) return own->set_motion(positions, velocities, rotation);
    Nodes& all = thin_nodes(*this);
    std::ranges::copy(positions, all.position.begin());
    for (std::size_t i = 0; i < all.size(); ++i)
        all.velocity[i] = all.mean_velocity[i] = all.inverse_mass[i] > 0 ? velocities[i] : Vec3{};
    // What is held goes on: it does not fall, and a gravity taken back at each force on it would bear half its weight.
    if (is_let_alone()) all.substep = 0;
}

bool DeformableRecord::is_let_alone() const {
    const Nodes& all = nodes();
    return touched_deformables.empty() && all.flow.empty() && all.force.empty() &&
           (cloth() ? cloth()->is_free() : rope()->is_free());
}

void DeformableRecord::begin_substep(double h, Vec3 gravity, bool is_alone) {
    change_substep(thin_nodes(*this), h, acceleration(gravity), is_alone && is_let_alone());
}

void DeformableRecord::set_mean_velocities(std::vector<Vec3> velocities, double substep) {
    Nodes& all = thin_nodes(*this);
    all.mean_velocity = std::move(velocities);
    all.substep = substep;
}

void DeformableRecord::set_liquid_force(std::span<const Vec3> force) {
    if (SolidDeformable* own = solid()) return own->set_liquid_force(force);
    thin_nodes(*this).force.assign(force.begin(), force.end());
}

void DeformableRecord::set_flow(std::vector<NodeFlow> flow) {
    Nodes& all = thin_nodes(*this);
    all.flow_impulse.assign(flow.size(), {});
    all.flow = std::move(flow);
}

void DeformableRecord::rest() {
    bounces.clear();
    if (SolidDeformable* own = solid()) return own->rest();
    Nodes& all = thin_nodes(*this);
    std::ranges::fill(all.mean_velocity, Vec3{});
    std::ranges::fill(all.velocity, Vec3{});
}

void DeformableRecord::stop_at(std::span<const Vec3> positions) {
    bounces.clear();
    if (SolidDeformable* own = solid()) return own->stop_at(positions);
    rest();
    Nodes& all = thin_nodes(*this);
    std::ranges::copy(positions, all.position.begin());
}

}  // namespace embody::physics::state
