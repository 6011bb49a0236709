// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/deformable/cloth/cloth_mesh.h"
#include "physics/deformable/namespace.h"

namespace embody::physics::deformable {

/// What bending does not give back (docs/physics/cloth.md "Friction in bending"): friction between threads, and folds
/// that stay. Each triangle keeps two curvatures, φ of friction and p of folds; its moment is B (κ + φ - p).
class BendMemory {
public:
    /// `elements` of the sheet at rest. Friction and yield as in Cloth.
    BendMemory(BendElements elements, std::size_t nodes, double friction, double yield);

    /// Whether the sheet bends with losses at all; without them nothing else here is asked.
    [[nodiscard]] bool is_active() const { return friction_ > 0 || yield_ < std::numeric_limits<double>::infinity(); }

    // `stiffness` in all: of friction, as ClothSettings::friction_stiffness. `normals`: of the triangles, unit.
    /// How stiffly friction answers a change of curvature at most, over the bend stiffness: what the matrix has.
    [[nodiscard]] double added_stiffness(double stiffness) const { return friction_ > 0 ? stiffness : 0; }
    /// Finds the moments after these moves (m) from these positions (m). `normals`: before and after the moves.
    void foresee(std::span<const Vec3> position, std::span<const Vec3> moves,
                 std::span<const std::array<Vec3, 2>> normals, double stiffness, TaskPool& workers);
    /// By the last foresee(), of φ - p alone, N per bend stiffness.
    [[nodiscard]] Vec3 force_on(std::size_t node) const;
    /// Keeps what the way from the positions of the last foresee() to these has made.
    void keep(std::span<const Vec3> position, std::span<const Vec3> normals, double stiffness, TaskPool& workers);
    /// What the energy is more than that of a sheet without memory, per bend stiffness: what friction can give back,
    /// less what folds have taken.
    [[nodiscard]] double energy(std::span<const Vec3> position, std::span<const Vec3> normals, double stiffness) const;

    /// Takes over what another sheet of as many triangles keeps, at the same places. Where fewer edges of a triangle
    /// join it to others than of the other's, its moment stays and so the fold is another one.
    void go_on_from(const BendMemory& whole, std::span<const Vec3> position, std::span<const Vec3> whole_position,
                    std::span<const Vec3> normals);

    /// As in LastingDeformation; empty where all is zero.
    [[nodiscard]] std::vector<std::array<double, 6>> state() const;
    /// One a triangle, or empty: none. What friction cannot hold is shortened to what it can.
    void set_state(std::span<const std::array<double, 6>> states);

private:
    struct Kept {
        Vec3 friction, fold;  // 1/m
    };
    struct OfNode {
        std::uint32_t hinge = 0;
        double weight = 0;
    };
    void find_folds(std::span<const Vec3> position, std::span<const Vec3> moves, std::vector<Vec3>& folds,
                    TaskPool& workers) const;
    [[nodiscard]] Vec3 curvature_at(std::size_t triangle, std::span<const Vec3> position, Vec3 normal) const;
    [[nodiscard]] static Vec3 curvature(const BendTriangle& triangle, std::span<const Vec3> folds, Vec3 normal);
    [[nodiscard]] Kept after(const Kept& before, Vec3 from, Vec3 to, double stiffness) const;

    BendElements elements_;
    std::vector<std::array<std::uint32_t, 2>> sides_;  // of each hinge: 3 × triangle + its edge
    std::vector<std::uint32_t> first_;                 // of each node's hinges
    std::vector<OfNode> of_node_;
    double friction_, yield_;
    std::vector<Kept> kept_;

    // Of the last foresee().
    std::vector<Vec3> start_;  // curvatures where the moves begin
    std::vector<std::array<Vec3, 3>> pull_;
    std::vector<Vec3> folds_, moved_folds_;  // to work with
};

}  // namespace embody::physics::deformable
