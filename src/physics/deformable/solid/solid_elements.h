// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "math/mat3.h"
#include "math/quat.h"
#include "physics/definitions/deformable_definition.h"
#include "physics/definitions/settings/solid_settings.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// The elastic energy of a solid of linear tetrahedra (docs/physics/deformables.md):
///
///   Ψ = Σ V (μ |F - R|² + λ/2 tr²(Rᵀ F - 1))
///
/// with F = Σ x gᵀ the deformation and R the rotation in it. Above the yield stress (von Mises) it flows: a plastic
/// strain, taken off Rᵀ F - 1, follows at the end of each substep (flow()). Gas inside under pressure p pulls the
/// matter taut, which resists a change of form by p/2 more in μ. Of the energy of a change of form a part has the F of
/// the tetrahedra, which alone bend too stiffly, the rest the means of F around the nodes, which alone bend too softly
/// (G. R. Liu, T. Nguyen-Thoi, K. Y. Lam, "A novel alpha finite element method", 2008). All energy of a change of
/// volume has those means, since tetrahedra of nearly incompressible matter lock (J. Bonet, A. J. Burton, "A simple
/// average nodal pressure tetrahedral element", 1998). Damping is proportional to the change of Rᵀ F
/// in the substep, which is zero for turns.
class SolidElements {
public:
    SolidElements(const SoftSolid& solid, std::span<const Vec3> rest);

    /// Of the world in this substep; before the others, else the defaults count.
    void set(const SolidSettings& settings);

    [[nodiscard]] std::size_t size() const { return corners_.size(); }
    /// Nodes of each tetrahedron, turned so that its volume is positive.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 4>>& corners() const { return corners_; }
    /// Volume around each node at rest: a quarter of its tetrahedra's, m³.
    [[nodiscard]] const std::vector<double>& node_volumes() const { return node_volume_; }
    /// Pairs of nodes of a common tetrahedron, each once, the smaller first.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& edges() const { return edges_; }
    /// Adds the stiffness of the tetrahedra alone as they are turned now, times `factor`: a block a node, and one an
    /// edge (row: edge[0]).
    void add_stiffness_blocks(double factor, std::span<Mat3> diagonal, std::span<Mat3> blocks) const;

    /// The next linearise() is the first of a substep of h seconds.
    void begin_substep(double h);
    /// Whether the elastic stress of a substep is of second order in time: of the strains at its end, its start and the
    /// starts of the two substeps before, by fixed weights. Else it is that of the strain at its end.
    [[nodiscard]] bool is_second_order() const { return is_second_order_; }
    /// For the rest of this substep the elastic stress is that of the strain at its end, which never makes energy.
    void use_end_alone() { is_second_order_ = false; }
    /// Weight of the strain at the end of a substep in its elastic stress.
    [[nodiscard]] double end_weight() const { return is_second_order_ ? 8.0 / 27 : 1; }
    /// The next substep begins at rest, as far as its strains know.
    void forget_past() { has_past_ = false; }
    /// Linearises at these positions (m), to which the nodes have come from `start`: finds the rotations
    /// and adds elastic and damping forces, N.
    void linearise(std::span<const Vec3> position, std::span<const Vec3> start, std::span<Vec3> force);
    /// Adds the product of K with a move: `factor` times the stiffness of the last linearise(), with the rotations'
    /// change.
    void add_stiffness(float factor, std::span<const Vec3f> move, std::span<Vec3f> force);
    /// The rotation around each node, of the last linearise().
    [[nodiscard]] const std::vector<Quat>& node_rotations() const { return node_rotation_; }
    /// Elastic energies of a substep, J.
    struct SubstepEnergy {
        double middle = 0;      ///< of the mean of the strains at its start and its end
        double change = 0;      ///< of their difference
        double end = 0;         ///< of the strains at its end
        double tetrahedra = 0;  ///< of their difference, if all energy were told by the tetrahedra
    };
    /// Of the substep that ends at these positions, and of the one before it.
    [[nodiscard]] SubstepEnergy substep_energy(std::span<const Vec3> position) const;
    [[nodiscard]] SubstepEnergy substep_energy_before() const;
    /// Elastic energy at these positions, J.
    [[nodiscard]] double energy(std::span<const Vec3> position) const { return substep_energy(position).end; }
    /// Plastic flow of what is stressed beyond its yield stress at these positions, with the rotations of the last
    /// linearise(). Returns whether there is a yield stress.
    bool flow(std::span<const Vec3> position);
    /// Takes over the plastic strain of another solid of as many nodes and tetrahedra.
    void take_plastic_strain(const SolidElements& other);
    /// As in LastingDeformation; empty where nothing has flowed.
    [[nodiscard]] std::vector<std::array<double, 5>> plastic_strain() const;
    /// Of all tetrahedra and nodes, or empty: none. What is beyond the maximum is shortened to it.
    void set_plastic_strain(std::span<const std::array<double, 5>> strains);
    /// Finds the rotations anew for nodes that were placed elsewhere.
    void reset_rotations(Quat rotation);

private:
    struct Matrix {  ///< 3×3 by columns, single precision
        float value[9] = {};
    };
    struct Around {  ///< a tetrahedron at a node
        std::uint32_t element = 0;
        std::uint32_t corner = 0;
        double fraction = 0;  ///< of the node's volume
    };
    [[nodiscard]] std::span<const Around> around(std::size_t node) const {
        return {around_.data() + first_around_[node], first_around_[node + 1] - first_around_[node]};
    }
    [[nodiscard]] Mat3 gradient(std::size_t element, std::span<const Vec3> values) const;
    struct Moduli {  ///< Lamé's, Pa
        double mu = 0, lambda = 0;
    };
    /// Elastic strains of tetrahedra or nodes in their axes when this substep and the two before it began.
    using Past = std::array<std::vector<Mat3>, 3>;
    [[nodiscard]] Mat3 stress(const Moduli& moduli, const Mat3& deformation, Quat rotation, const Mat3& plastic,
                              const Past& past, std::size_t index) const;
    static void add_energy(const Moduli& moduli, double volume, const Mat3& start, const Mat3& end, SubstepEnergy& sum);
    void add_element_energy(std::size_t element, const Mat3& start, const Mat3& end, SubstepEnergy& sum) const;
    [[nodiscard]] static double energy_density(const Moduli& moduli, const Mat3& strain);
    static void shift(Past& past);
    void flow(const Mat3& deformation, Quat rotation, Mat3& plastic) const;
    void limit_strain(Mat3& plastic) const;
    [[nodiscard]] Mat3 mean_around(std::size_t node, std::span<const Mat3> of_elements) const;
    static void find_strains(std::span<const Mat3> deformation, std::vector<Quat> rotation,
                             std::span<const Mat3> plastic, std::span<Mat3> strain);
    void begin_strains(std::span<const Vec3> start);
    void find_edges();
    void find_surroundings(std::size_t nodes);

    SolidSettings settings_;
    double mu_, lambda_, damping_, yield_stress_;
    Moduli element_moduli_, node_moduli_;  ///< parts of the energy; their sum is the matter's
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<std::array<Vec3, 3>> gradient_;  ///< of corners 1 to 3, 1/m; that of corner 0 is minus their sum
    std::vector<double> volume_;                 ///< m³
    std::vector<Quat> rotation_, node_rotation_;
    std::vector<Mat3> plastic_, node_plastic_;  ///< strains in the axes at rest, without a trace
    Past past_, node_past_;
    bool is_substep_new_ = true, has_past_ = false, is_second_order_ = false;
    double damping_rate_ = 0;     ///< β/h of the substep
    std::vector<Around> around_;  ///< of node i those from first_around_[i] to first_around_[i + 1]
    std::vector<std::uint32_t> first_around_;
    std::vector<double> node_volume_;
    std::vector<std::array<std::uint32_t, 2>> edges_;

    // Of the last linearise(), for add_stiffness().
    std::vector<Mat3> deformation_, node_deformation_, node_stress_;
    std::vector<Matrix> rotation_f_, node_rotation_f_, gradient_f_, node_stress_f_;
};

}  // namespace embody::physics::deformable
