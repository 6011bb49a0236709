// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "physics/deformable/namespace.h"
#include "physics/deformable/solid/solid_deformable.h"

namespace embody::physics::deformable {

/// The nodes of a solid that contacts act on in a substep, and their displacements by forces on each other.
class TouchedNodes {
public:
    void begin(SolidDeformable& solid);
    /// Its number among the touched nodes.
    std::uint32_t number_of(std::uint32_t node) { return compliance_->number_of(node); }
    /// Finds the compliance of all nodes that were asked for.
    void complete(SolidDeformable& solid, TaskPool& workers);

    [[nodiscard]] std::size_t size() const { return force_.size(); }
    [[nodiscard]] std::uint32_t node(std::size_t number) const { return compliance_->node(number); }
    /// Sum of the forces since begin(), N.
    [[nodiscard]] Vec3 force(std::size_t number) const { return force_[number]; }
    [[nodiscard]] bool is_pushed() const {
        return std::ranges::any_of(force_, [](Vec3 force) { return force != Vec3{}; });
    }
    /// Displacement of node i by a force on node j, world axes, m/N; by numbers.
    [[nodiscard]] Mat3 block(std::size_t i, std::size_t j) const;

    /// A force (N) on a node, which moves all.
    void push(std::size_t number, Vec3 force);
    /// Displacement by all forces so far, m.
    [[nodiscard]] Vec3 moved(std::size_t number) const { return move_of(number, moved_); }

    // A set of forces for a trial: they are cleared and added, the probe begins, each of its parts is run, on any
    // worker, and the probe ends.
    void clear_probe();
    void add_to_probe(std::size_t number, Vec3 force) { probe_force_[number] += force; }
    void begin_probe();
    [[nodiscard]] std::size_t probe_parts() const { return probe_part_moves_.size(); }
    void run_probe(std::size_t part);
    void end_probe();
    [[nodiscard]] Vec3 probe_move(std::size_t number) const { return probe_moves_[number]; }

private:
    [[nodiscard]] Vec3 move_of(std::size_t number, const std::vector<float>& moves) const;

    NodeCompliance* compliance_ = nullptr;
    double scale_ = 1;          // of the compliance
    double gas_fraction_ = 0;   // displacement that the gas prevents, see SolidDeformable::gas_move()
    std::vector<float> gas_;    // in the nodes' own axes: rows x, y, z
    std::vector<Mat3> turn_;    // from the nodes' own axes
    std::vector<float> moved_;  // in the nodes' own axes, m: rows x, y, z
    std::vector<Vec3> force_;

    std::vector<Vec3> probe_force_, probe_moves_;       // world axes
    std::vector<float> probe_own_force_;                // in the nodes' own axes: rows x, y, z
    std::vector<std::vector<float>> probe_part_moves_;  // as moved_
};

}  // namespace embody::physics::deformable
