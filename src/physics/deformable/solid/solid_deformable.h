// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "math/bounds.h"
#include "physics/definitions/step_report.h"
#include "physics/deformable/contact/nodes.h"
#include "physics/deformable/namespace.h"
#include "physics/deformable/solid/enclosed_gas.h"
#include "physics/deformable/solid/node_compliance.h"
#include "physics/deformable/solid/solid_elements.h"
#include "physics/linear/dissected_cholesky.h"

namespace embody::physics::deformable {

/// A soft solid in motion (docs/physics/deformables.md). A substep is begin_substep(), push() with the contact forces
/// that are guessed, solve(), the contacts' solve with push() and the compliance of nodes, and finish().
class SolidDeformable {
public:
    /// Of a valid definition whose matter is a SoftSolid.
    explicit SolidDeformable(const DeformableDefinition& definition);

    [[nodiscard]] const Nodes& nodes() const { return nodes_; }
    /// Sets the forces of liquids on the nodes, N; empty: none.
    void set_liquid_force(std::span<const Vec3> force) { nodes_.force.assign(force.begin(), force.end()); }
    /// Outer faces, counter-clockwise from outside; and their nodes, ascending: what collides.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& surface() const { return surface_; }
    [[nodiscard]] const std::vector<std::uint32_t>& surface_nodes() const { return surface_nodes_; }
    /// Mean side of the surface's triangles at rest, m.
    [[nodiscard]] double mean_side() const { return mean_side_; }
    [[nodiscard]] Bounds bounds() const;

    /// Begins a substep of h seconds: nodes go on with their velocities. `gravity` in m/s², the body's factor counted.
    /// `settings` hold until the next one.
    void begin_substep(double h, Vec3 gravity, const SolidSettings& settings = {});
    /// Lets a force (N) act on a node for this substep; counts in the next solve() or settle().
    void push(std::uint32_t node, Vec3 force);
    /// Moves the nodes to where elastic, damping and inertial forces balance what acts on them: one iteration of a
    /// quasi-Newton method.
    void solve(TaskPool& workers);
    /// Moves the nodes by the effect of the pushes since solve(), by the compliance.
    void settle(TaskPool& workers);
    /// Displacement of the nodes by these forces (N) in this substep if nothing else held them, m.
    void find_response(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers);
    /// Whether the moves so far add energy, as one iteration does where nodes move by a large part of the solid's size
    /// in a substep: a further solve() reduces it.
    [[nodiscard]] bool gains_energy();
    /// Sets the velocities at the end of the substep.
    void finish();
    /// After finish(): moves the nodes by the effect of these additional forces (N) in the substep.
    void go_on_with(std::span<const Vec3> force, TaskPool& workers);

    /// After finish(): lets an impulse (N s) act on the whole at a place.
    void strike(Vec3 impulse, Vec3 place);
    /// After finish(): takes energy from the velocities that are not those of the whole, so that they and the elastic
    /// energy have no more than `most`, or none. Returns what both have then, J.
    double calm_down(double most);

    /// Where a node was when the substep began, m.
    [[nodiscard]] Vec3 start(std::uint32_t node) const { return start_[node]; }
    /// Displacement of touched nodes by forces on each other in this substep, times stretch(): node i's displacement is
    /// turned by its turn(), the force on node j by the inverse of its own.
    [[nodiscard]] NodeCompliance& compliance() { return compliance_; }
    void complete_compliance(TaskPool& workers) { compliance_.complete(factor_, is_pinned_, workers); }
    /// Ratio of the metric of this substep to that of the factor.
    [[nodiscard]] double stretch() const { return stretch_; }
    /// The vector g of the gas within: forces f move the nodes by gas_fraction() g (g·f) less, m/Pa, world axes; empty:
    /// no gas.
    [[nodiscard]] const std::vector<Vec3>& gas_move() const { return gas_move_; }
    [[nodiscard]] double gas_fraction() const { return gas_fraction_; }
    [[nodiscard]] Quat turn(std::size_t node) const {
        return elements_.node_rotations()[node] * conjugate(factor_rotations_[node]);
    }
    /// The rotation around a node since it was at rest.
    [[nodiscard]] Quat rotation(std::uint32_t node) const { return elements_.node_rotations()[node]; }

    /// Places its nodes and gives them these velocities; pinned ones rest. `rotation` is about that of the whole.
    void set_motion(std::span<const Vec3> positions, std::span<const Vec3> velocities, Quat rotation);
    /// Takes over the plastic deformation of another solid of as many nodes and tetrahedra.
    void take_plastic_strain(const SolidDeformable& other) { elements_.take_plastic_strain(other.elements_); }
    /// As of SolidElements.
    [[nodiscard]] std::vector<std::array<double, 5>> plastic_strain() const { return elements_.plastic_strain(); }
    void set_plastic_strain(std::span<const std::array<double, 5>> strains) { elements_.set_plastic_strain(strains); }
    /// Takes all velocities away.
    void rest();
    /// Puts its nodes back to where they were, at rest.
    void stop_at(std::span<const Vec3> positions);

    [[nodiscard]] bool is_finite() const;
    /// Energy (elastic energy counts as potential) and momenta.
    [[nodiscard]] Conserved conserved(Vec3 gravity) const;

private:
    void place_nodes(const DeformableDefinition& definition);
    void find_surface();
    void make_factor(double h);
    void press();
    void quasi_newton_move(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers);
    void metric_move(std::span<const Vec3> force, std::span<Vec3> move, TaskPool& workers);
    void find_gas_move(TaskPool& workers);
    [[nodiscard]] double stiffness_ratio();
    /// As of a rigid body in a substep.
    struct RigidMove {
        Vec3 center, shift;
        Quat rotation;

        [[nodiscard]] Vec3 at(Vec3 p) const { return center + shift + rotate(rotation, p - center); }
    };
    [[nodiscard]] RigidMove move_of_whole() const;
    /// Lets it turn by less, so that its energy in this substep is less by `excess` (J), down to none of the turn.
    void take_turning_energy(RigidMove& move, double excess) const;
    void keep_momenta();
    bool keep_energy();
    [[nodiscard]] std::optional<double> find_surplus();
    [[nodiscard]] bool is_too_much(std::optional<double> surplus) const;
    [[nodiscard]] bool is_let_alone() const;
    [[nodiscard]] double kinetic_energy() const;
    [[nodiscard]] double metric_weight() const;
    void go_on_in_first_order();
    [[nodiscard]] double kept_energy(const SolidElements::SubstepEnergy& energy) const;
    [[nodiscard]] double elastic_energy() const;
    [[nodiscard]] double gas_energy(std::span<const Vec3> positions) const;

    SolidElements elements_;
    SolidSettings settings_;  // of the substep
    double damping_ = 0;      // s
    Nodes nodes_;
    std::vector<Vec3> rest_;
    std::vector<std::array<std::uint32_t, 3>> surface_;
    std::vector<std::uint32_t> surface_nodes_;
    double mean_side_ = 0;
    bool is_free_ = true;                               // no node is pinned
    bool is_new_ = true;                                // has made no substep yet
    std::optional<double> energy_at_start_;             // J, of the substep before; none: not measured
    double kinetic_energy_at_start_ = 0, surplus_ = 0;  // J; the latter came from nowhere so far
    std::optional<double> found_surplus_;               // by gains_energy(), with no move since: is_measured_
    bool is_measured_ = false;

    // Of the substep.
    double h_ = 0;
    Vec3 gravity_;
    std::vector<Vec3> start_, pushes_;  // m; N, all of the substep
    std::vector<Vec3> unsettled_;       // N, since the last solve
    std::vector<Vec3> force_;           // N
    std::vector<Vec3> move_;            // m
    std::vector<Vec3f> turned_, product_;
    double stretch_ = 1;

    std::optional<EnclosedGas> gas_;
    std::vector<Vec3> gas_move_;  // P⁻¹ ∂V/∂x, m/Pa
    double gas_fraction_ = 0;     // c in (P + k g gᵀ)⁻¹ = P⁻¹ - c (P⁻¹ g)(P⁻¹ g)ᵀ

    // The factor of the matrix at rest, for substeps of factor_h_ seconds, and what is known of its inverse.
    DissectedCholesky factor_;
    double factor_h_ = 0, factor_weight_ = 0;  // the latter of the stiffness without damping
    std::vector<Quat> factor_rotations_;       // around the nodes when it was made
    std::vector<std::uint8_t> is_pinned_;      // by node
    NodeCompliance compliance_;
};

}  // namespace embody::physics::deformable
