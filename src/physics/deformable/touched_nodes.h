// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/deformable/solid_deformable.h"

namespace embody::physics {

/// The nodes of a solid that contacts act on in a substep, and how they move by forces on each other.
class TouchedNodes {
public:
    void begin(const SolidDeformable& solid);
    /// Its number among the touched nodes; a new one where it is asked for the first time.
    std::uint32_t number_of(std::uint32_t node);
    /// Fetches the compliance of all that were asked for.
    void fetch_compliance(SolidDeformable& solid);

    [[nodiscard]] const std::vector<std::uint32_t>& nodes() const { return nodes_; }
    /// Forces given since begin(), N, by number.
    [[nodiscard]] const std::vector<Vec3>& forces() const { return force_; }
    /// How node i moves by a force on node j, world axes, m/N; by numbers.
    [[nodiscard]] Mat3 block(std::size_t i, std::size_t j) const;

    /// A force (N) on a node, which moves all.
    void push(std::size_t number, Vec3 force);
    /// By all forces so far, m.
    [[nodiscard]] Vec3 moved(std::size_t number) const { return move_of(number, moved_); }

    // A set of forces that only tells what it would do.
    void clear_probe();
    void add_to_probe(std::size_t number, Vec3 force) { probe_force_[number] += force; }
    void run_probe();
    [[nodiscard]] Vec3 probe_move(std::size_t number) const { return move_of(number, probe_); }

private:
    [[nodiscard]] Vec3 move_of(std::size_t number, const std::vector<float>& moves) const;
    void add_moves(std::size_t number, Vec3 force, std::vector<float>& moves) const;

    std::vector<std::uint32_t> nodes_;
    std::vector<std::uint32_t> number_of_;  // by node
    std::vector<Quat> turn_;
    std::size_t stride_ = 0;  // numbers from one row to the next
    /// Of node j nine rows over all nodes i: element (r, c) of the block (i, j), each in its own axes, in row 3 c + r.
    std::vector<float> compliance_;
    std::vector<float> moved_, probe_;  // in the nodes' own axes, m: rows x, y, z
    std::vector<Vec3> force_, probe_force_;
};

}  // namespace embody::physics
