// SPDX-License-Identifier: MIT
#include "physics/deformable/solid/solid_deformable.h"

#include <algorithm>
#include <cmath>

#include "geometry/tetrahedra/tetrahedral_mesh.h"
#include "physics/deformable/contact/free_motion.h"

namespace embody::physics::deformable {

SolidDeformable::SolidDeformable(const DeformableDefinition& definition)
    : elements_(std::get<SoftSolid>(definition.matter), definition.nodes),
      damping_(std::get<SoftSolid>(definition.matter).rayleigh_damping),
      rest_(definition.nodes) {
    place_nodes(definition);
    find_surface();
    elements_.reset_rotations(normalized(definition.pose.rotation));
    const std::size_t count = nodes_.size();
    for (auto* vector : {&start_, &pushes_, &unsettled_, &force_, &move_}) vector->resize(count);
    for (auto* vector : {&turned_, &product_}) vector->resize(count);
    for (const double mass : nodes_.inverse_mass) is_pinned_.push_back(mass > 0 ? 0 : 1);
    factor_.analyse(rest_, elements_.edges());
    if (const double pressure = std::get<SoftSolid>(definition.matter).internal_pressure; pressure > 0) {
        gas_.emplace(pressure, surface_, rest_);
        gas_move_.resize(count);
    }
}

void SolidDeformable::place_nodes(const DeformableDefinition& definition) {
    const double density = std::get<SoftSolid>(definition.matter).density;
    Vec3 center;
    double whole = 0;
    for (std::size_t i = 0; i < definition.nodes.size(); ++i) {
        const double mass = density * elements_.node_volumes()[i];
        nodes_.position.push_back(transform_point(definition.pose, definition.nodes[i]));
        nodes_.mass.push_back(mass);
        nodes_.inverse_mass.push_back(1 / mass);
        center += mass * nodes_.position.back();
        whole += mass;
    }
    center = center / whole;
    for (const Vec3 p : nodes_.position)
        nodes_.mean_velocity.push_back(definition.linear_velocity + cross(definition.angular_velocity, p - center));
    for (const std::uint32_t node : definition.pinned) {
        nodes_.inverse_mass[node] = 0;
        nodes_.mean_velocity[node] = {};
    }
    is_free_ = definition.pinned.empty();
    nodes_.velocity = nodes_.mean_velocity;
}

void SolidDeformable::find_surface() {
    std::vector<geometry::Tetrahedron> corners(elements_.corners().begin(), elements_.corners().end());
    for (const auto& face : geometry::find_tetrahedral_topology(corners).outer_faces) {
        surface_.push_back(face.corners);
        for (std::size_t k = 0; k < 3; ++k)
            mean_side_ += length(rest_[face.corners[k]] - rest_[face.corners[(k + 1) % 3]]) / 3;
        surface_nodes_.insert(surface_nodes_.end(), face.corners.begin(), face.corners.end());
    }
    mean_side_ /= static_cast<double>(surface_.size());
    std::ranges::sort(surface_nodes_);
    surface_nodes_.erase(std::unique(surface_nodes_.begin(), surface_nodes_.end()), surface_nodes_.end());
}

Bounds SolidDeformable::bounds() const {
    Bounds bounds;
    for (const Vec3 p : nodes_.position) bounds.add(p);
    return bounds;
}

// P = M/h² + (a + β/h) K of the tetrahedra as they are turned now, with the weight a of a substep's end; pinned nodes
// stand apart. Of second order P must not be softer than the true stiffness at all, and a is greater.
void SolidDeformable::make_factor(double h) {
    factor_h_ = h;
    factor_weight_ = metric_weight();
    std::vector<Mat3> diagonal(nodes_.size(), Mat3::zero()), blocks(elements_.edges().size(), Mat3::zero());
    elements_.add_stiffness_blocks(factor_weight_ + damping_ / h, diagonal, blocks);
    factor_rotations_ = elements_.node_rotations();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double inertia = nodes_.mass[i] / (h * h);
        diagonal[i] += Mat3::diagonal({inertia, inertia, inertia});
    }
    for (std::size_t e = 0; e < blocks.size(); ++e) {
        const auto [a, b] = elements_.edges()[e];
        if (!(nodes_.inverse_mass[a] > 0 && nodes_.inverse_mass[b] > 0)) blocks[e] = Mat3::zero();
    }
    factor_.factor(diagonal, elements_.edges(), blocks);
    compliance_.forget(nodes_.size());
}

void SolidDeformable::begin_substep(double h, Vec3 gravity, const SolidSettings& settings) {
    settings_ = settings;
    elements_.set(settings);
    h_ = h;
    gravity_ = gravity;
    // The definition has the velocity at the start, not the mean before it: that is half a substep of gravity and of
    // the turn of the whole earlier.
    if (is_new_) {
        constexpr double min_spin = 1e-9;  // rad/s: keeps the quotient finite
        const WholeMotion whole = motion_of_whole(nodes_);
        const double back = std::min(h / 2, settings.max_turn_back / std::max(length(whole.spin), min_spin));  // s
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (!(nodes_.inverse_mass[i] > 0)) continue;
            const Vec3 turning = is_free_ ? cross(whole.spin, nodes_.mean_velocity[i] - whole.velocity) : Vec3{};
            nodes_.mean_velocity[i] -= (h / 2) * gravity + back * turning;
        }
    }
    // After substeps that went on in first order the metric is stiffer than it must be, until one was of second again.
    const bool is_too_stiff = elements_.is_second_order() && factor_weight_ != metric_weight();
    elements_.begin_substep(h);
    if (factor_h_ != h) elements_.forget_past();
    if (factor_h_ != h || is_too_stiff) make_factor(h);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        start_[i] = nodes_.position[i];
        nodes_.position[i] += h * nodes_.mean_velocity[i];
        pushes_[i] = nodes_.force_on(i);
        unsettled_[i] = {};
    }
    kinetic_energy_at_start_ = kinetic_energy();  // the nodes have moved by their velocities
    energy_at_start_.reset();
    is_new_ = false;
}

void SolidDeformable::push(std::uint32_t node, Vec3 force) {
    pushes_[node] += force;
    unsettled_[node] += force;
}

void SolidDeformable::solve(TaskPool& workers) {
    is_measured_ = false;
    std::ranges::fill(unsettled_, Vec3{});
    // r = M (x_old + h u + h² g - x)/h² + f + pushes, f of x and of the strains before (docs/physics/deformables.md)
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 rate = (nodes_.position[i] - start_[i]) / h_;
        force_[i] = nodes_.mass[i] * (gravity_ + (nodes_.mean_velocity[i] - rate) / h_) + pushes_[i];
    }
    elements_.linearise(nodes_.position, start_, force_);
    press();
    find_gas_move(workers);
    quasi_newton_move(force_, move_, workers);
    // The metric must not be softer along the move than the true stiffness, or moves grow from substep to substep.
    stretch_ = 1;
    const double max_ratio = elements_.is_second_order() ? 1 : settings_.max_stiffness_ratio;
    double ratio = stiffness_ratio();
    if (ratio > max_ratio) {
        make_factor(h_);
        find_gas_move(workers);
        quasi_newton_move(force_, move_, workers);
        ratio = stiffness_ratio();
    }
    stretch_ = std::max(1.0, ratio / max_ratio);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += move_[i] / stretch_;
}

void SolidDeformable::settle(TaskPool& workers) {
    is_measured_ = false;
    find_response(unsettled_, move_, workers);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += move_[i];
    std::ranges::fill(unsettled_, Vec3{});
}

void SolidDeformable::find_response(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers) {
    quasi_newton_move(force, move, workers);
    for (Vec3& m : move) m = m / stretch_;
}

// The force of the gas on the nodes: its pressure beyond that at rest, times ∂V/∂x.
void SolidDeformable::press() {
    if (!gas_) return;
    gas_->measure(surface_, nodes_.position, settings_.min_gas_fraction);
    for (const std::uint32_t node : surface_nodes_) force_[node] += gas_->excess() * gas_->slope()[node];
}

// Gas couples all nodes of the surface by one more term of the metric, P + k g gᵀ with g = ∂V/∂x, whose inverse is
// (J. Sherman, W. J. Morrison, 1950) P⁻¹ - c z zᵀ with z = P⁻¹ g, c = k/(1 + k g·z).
void SolidDeformable::find_gas_move(TaskPool& workers) {
    if (!gas_) return;
    metric_move(gas_->slope(), gas_move_, workers);
    double along = 0;
    for (const std::uint32_t node : surface_nodes_) along += dot(gas_->slope()[node], gas_move_[node]);
    const double stiffness = gas_->stiffness();
    gas_fraction_ = stiffness / (1 + stiffness * along);
}

void SolidDeformable::quasi_newton_move(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers) {
    metric_move(force, move, workers);
    if (!gas_) return;
    double along = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) along += dot(gas_move_[i], force[i]);
    for (std::size_t i = 0; i < nodes_.size(); ++i) move[i] -= (gas_fraction_ * along) * gas_move_[i];
}

// d = Q L⁻ᵀ L⁻¹ Qᵀ r
void SolidDeformable::metric_move(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers) {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        turned_[i] = nodes_.inverse_mass[i] > 0 ? to_vec3f(rotate_inverse(turn(i), force[i])) : Vec3f{};
    factor_.solve(turned_, workers);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        move[i] = nodes_.inverse_mass[i] > 0 ? rotate(turn(i), to_vec3(turned_[i])) : Vec3{};
}

// dᵀ H d / dᵀ P d for the move d by the forces.
double SolidDeformable::stiffness_ratio() {
    double metric = 0, true_one = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        turned_[i] = to_vec3f(move_[i]);
        product_[i] = {};
        metric += dot(move_[i], force_[i]);
        true_one += nodes_.mass[i] / (h_ * h_) * length_squared(move_[i]);
    }
    elements_.add_stiffness(static_cast<float>(elements_.end_weight() + damping_ / h_), turned_, product_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) true_one += dot(move_[i], to_vec3(product_[i]));
    if (gas_) {
        double along = 0;
        for (const std::uint32_t node : surface_nodes_) along += dot(gas_->slope()[node], move_[node]);
        true_one += gas_->stiffness() * along * along;
    }
    return metric > 0 ? true_one / metric : 0;
}

void SolidDeformable::finish() {
    if (elements_.flow(nodes_.position)) is_measured_ = false;
    const bool is_shortened = keep_energy();
    for (std::size_t i = 0; i < nodes_.size(); ++i) move_[i] = nodes_.position[i] - start_[i];
    set_velocities(nodes_, move_, h_);
    if (is_shortened) nodes_.velocity = nodes_.mean_velocity;
}

bool SolidDeformable::gains_energy() {
    if (is_let_alone()) keep_momenta();
    found_surplus_ = find_surplus();
    const bool gains = is_too_much(found_surplus_);
    if (gains && elements_.is_second_order()) go_on_in_first_order();
    return gains;
}

// Where a contact brings a node to a speed within a substep, the stress of second order, 8/27 of the new strain's, does
// not do the work that the strain stores.
void SolidDeformable::go_on_in_first_order() {
    elements_.use_end_alone();
    energy_at_start_.reset();
    if (factor_weight_ < metric_weight()) make_factor(h_);
}

bool SolidDeformable::is_let_alone() const {
    if (!is_free_) return false;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (pushes_[i] != nodes_.force_on(i)) return false;
    }
    return true;
}

void SolidDeformable::go_on_with(std::span<const Vec3> force, TaskPool& workers) {
    find_response(force, move_, workers);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_.position[i] += move_[i];
        nodes_.velocity[i] += 1.5 / h_ * move_[i];
        nodes_.mean_velocity[i] += move_[i] / h_;
    }
}

void SolidDeformable::strike(Vec3 impulse, Vec3 place) {
    const WholeMotion before = motion_of_whole(nodes_);
    WholeMotion after = before;
    after.strike(impulse, place);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 change = after.velocity_at(nodes_.position[i]) - before.velocity_at(nodes_.position[i]);
        nodes_.mean_velocity[i] += change;
        nodes_.velocity[i] += change;
    }
}

double SolidDeformable::calm_down(double most) {
    const WholeMotion whole = motion_of_whole(nodes_);
    const auto other_velocity = [&](std::size_t i) {
        return nodes_.mean_velocity[i] - whole.velocity_at(nodes_.position[i]);
    };
    double kinetic = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) kinetic += nodes_.mass[i] / 2 * length_squared(other_velocity(i));
    const double elastic = elastic_energy() + gas_energy(nodes_.position);
    if (!(kinetic + elastic > most)) return kinetic + elastic;
    const double fraction = kinetic > 0 ? std::sqrt(std::max(0.0, most - elastic) / kinetic) : 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 taken = (1 - fraction) * other_velocity(i);
        nodes_.mean_velocity[i] -= taken;
        nodes_.velocity[i] -= taken;
    }
    return std::max(most, elastic);
}

// Of the tetrahedra's stiffness in the metric.
double SolidDeformable::metric_weight() const {
    return elements_.is_second_order() ? settings_.max_stiffness_ratio * elements_.end_weight() : 1;
}

// Of the moves in the substep.
double SolidDeformable::kinetic_energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_.inverse_mass[i] > 0)
            sum += nodes_.mass[i] / 2 * length_squared((nodes_.position[i] - start_[i]) / h_);
    }
    return sum;
}

double SolidDeformable::gas_energy(std::span<const Vec3> positions) const {
    if (!gas_) return 0;
    EnclosedGas gas = *gas_;
    gas.measure(surface_, positions, settings_.min_gas_fraction);
    return gas.energy();
}

double SolidDeformable::elastic_energy() const {
    const SolidElements::SubstepEnergy energy = elements_.substep_energy(nodes_.position);
    return elements_.is_second_order() ? energy.middle : energy.end;
}

// What the scheme keeps of a linear oscillation of circular frequency ω, to the second order of ω h: its mass is
// greater by that of the metric less that of the mean of strains, and the four weights of the strains make 1/27 of it
// more.
double SolidDeformable::kept_energy(const SolidElements::SubstepEnergy& energy) const {
    if (!elements_.is_second_order()) return energy.end;
    const double of_metric = factor_weight_ * energy.tetrahedra;
    return energy.middle + std::max(0.0, of_metric + (1.0 / 27 - 0.25) * energy.change);
}

// Energy beyond the energy before and the work of the pushes, J, with the excess of earlier substeps; none where all
// nodes are slow.
std::optional<double> SolidDeformable::find_surplus() {
    is_measured_ = true;
    double farthest = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        farthest = std::max(farthest, length_squared(nodes_.position[i] - start_[i]));
    const double slow_fraction = settings_.energy_travel_fraction;
    if (farthest < slow_fraction * slow_fraction * mean_side_ * mean_side_) return std::nullopt;
    if (!energy_at_start_)
        energy_at_start_ =
            kinetic_energy_at_start_ + kept_energy(elements_.substep_energy_before()) + gas_energy(start_);
    // Of second order the kept energy is that of the substep's middle.
    const double half = elements_.is_second_order() ? 0.5 : 0;
    double work = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!(nodes_.inverse_mass[i] > 0)) continue;
        const Vec3 move = (1 - half) * (nodes_.position[i] - start_[i]) + (half * h_) * nodes_.mean_velocity[i];
        work += dot(pushes_[i] + nodes_.mass[i] * gravity_, move);
    }
    // Nor may the stretch at the end alone have more: a move that is left out would show it.
    const SolidElements::SubstepEnergy elastic = elements_.substep_energy(nodes_.position);
    return surplus_ + std::max(kinetic_energy() + kept_energy(elastic), elastic.end) + gas_energy(nodes_.position) -
           *energy_at_start_ - work;
}

// The excess of earlier substeps may only decrease.
bool SolidDeformable::is_too_much(std::optional<double> surplus) const {
    return surplus && !(*surplus <= std::max(settings_.max_energy_gain * *energy_at_start_, surplus_));
}

// Removes the excess that further iterations leave: the move of the substep beyond that of the whole is made shorter,
// down to zero, which keeps the elastic energy; where the turn of the whole is more than a substep can follow, so that
// even this has too much, it turns less. Returns whether it was.
bool SolidDeformable::keep_energy() {
    if (!is_measured_ && is_let_alone()) keep_momenta();
    std::optional<double> left = is_measured_ ? found_surplus_ : find_surplus();
    const bool is_shortened = is_too_much(left);
    if (is_shortened) {
        RigidMove whole = is_free_ ? move_of_whole() : RigidMove{};
        const int max_halvings = settings_.max_halvings;
        for (int k = 1; k <= max_halvings + 1 && is_too_much(left); ++k) {
            const double fraction = k < max_halvings ? 0.5 : 0;
            if (k > max_halvings)
                take_turning_energy(whole, *left - std::max(settings_.max_energy_gain * *energy_at_start_, surplus_));
            for (std::size_t i = 0; i < nodes_.size(); ++i) {
                if (!(nodes_.inverse_mass[i] > 0)) continue;
                const Vec3 along = whole.at(start_[i]);
                nodes_.position[i] = along + fraction * (nodes_.position[i] - along);
            }
            left = find_surplus();
        }
    }
    surplus_ = std::max(0.0, left.value_or(0));
    return is_shortened;
}

// Motion of the nodes in this substep, weighted by mass.
SolidDeformable::RigidMove SolidDeformable::move_of_whole() const {
    RigidMove move;
    double mass = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        mass += nodes_.mass[i];
        move.center += nodes_.mass[i] * start_[i];
        move.shift += nodes_.mass[i] * (nodes_.position[i] - start_[i]);
    }
    move.center = move.center / mass;
    move.shift = move.shift / mass;
    Vec3 turning;
    Mat3 inertia = Mat3::zero();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const Vec3 arm = start_[i] - move.center;
        turning += nodes_.mass[i] * cross(arm, nodes_.position[i] - start_[i]);
        inertia += nodes_.mass[i] * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
    }
    // An arm that turns by an angle moves sideways by its sine.
    const Vec3 sideways = embody::solve(inertia, turning);
    const double sine = length(sideways);
    if (sine > 0) move.rotation = from_axis_angle(sideways / sine, std::asin(std::min(sine, 1.0)));
    return move;
}

// A chord is 2 r sin(φ/2), so the energy of the turn is proportional to the square of the half angle's sine.
void SolidDeformable::take_turning_energy(RigidMove& move, double excess) const {
    double energy = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        energy += nodes_.mass[i] / 2 * length_squared((move.at(start_[i]) - start_[i] - move.shift) / h_);
    const double left = energy > 0 ? std::sqrt(std::max(0.0, 1 - excess / energy)) : 0;
    const Vec3 half_sine = left * Vec3{move.rotation.x, move.rotation.y, move.rotation.z};
    move.rotation = {half_sine.x, half_sine.y, half_sine.z, std::sqrt(1 - length_squared(half_sine))};
}

// Inner forces neither move nor turn the whole, and outer ones turn it with the arms of the nodes' new places. Rounding
// and rotations that lag violate that, and the substep slows every turn, as Σ m x × u changes with the arms of the
// step's end; a small move and turn of the whole corrects this.
void SolidDeformable::keep_momenta() {
    Vec3 center, new_center;
    double whole = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        center += nodes_.mass[i] * start_[i];
        new_center += nodes_.mass[i] * nodes_.position[i];
        whole += nodes_.mass[i];
    }
    center = center / whole;
    new_center = new_center / whole;
    Vec3 missing, missing_turning;  // h times the momenta
    Mat3 inertia = Mat3::zero();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const double mass = nodes_.mass[i];
        const Vec3 arm = start_[i] - center, new_arm = nodes_.position[i] - new_center;
        const Vec3 gone_on = h_ * nodes_.mean_velocity[i] - (nodes_.position[i] - start_[i]);
        missing += mass * (gone_on + (h_ * h_) * gravity_) + (h_ * h_) * pushes_[i];
        missing_turning += mass * cross(arm, gone_on) + (h_ * h_) * cross(new_arm, pushes_[i]);
        inertia += mass * (length_squared(arm) * Mat3::identity() - outer(arm, arm));
    }
    const Vec3 shift = missing / whole;
    const Vec3 turn = embody::solve(inertia, missing_turning);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_.position[i] += shift + cross(turn, start_[i] - center);
}

void SolidDeformable::set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        nodes_.position[i] = positions[i];
        nodes_.mean_velocity[i] = nodes_.velocity[i] = nodes_.inverse_mass[i] > 0 ? velocities[i] : Vec3{};
    }
    elements_.reset_rotations(rotation);
    is_new_ = true;
    factor_h_ = surplus_ = 0;
}

void SolidDeformable::rest() {
    std::ranges::fill(nodes_.mean_velocity, Vec3{});
    std::ranges::fill(nodes_.velocity, Vec3{});
    elements_.forget_past();
}

void SolidDeformable::stop_at(std::span<const Vec3> positions) {
    std::ranges::copy(positions, nodes_.position.begin());
    rest();
}

bool SolidDeformable::is_finite() const {
    return std::ranges::all_of(nodes_.position, [](Vec3 p) { return embody::is_finite(p); });
}

Conserved SolidDeformable::conserved(Vec3 gravity) const {
    Conserved sum;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (!(nodes_.inverse_mass[i] > 0)) continue;
        const double mass = nodes_.mass[i];
        const Vec3 v = nodes_.velocity[i], x = nodes_.position[i];
        sum.kinetic_energy += mass / 2 * length_squared(v);
        sum.potential_energy -= mass * embody::dot(gravity, x);
        sum.linear_momentum += mass * v;
        sum.angular_momentum += cross(x, mass * v);
    }
    sum.potential_energy += elastic_energy() + gas_energy(nodes_.position);
    return sum;
}

}  // namespace embody::physics::deformable
