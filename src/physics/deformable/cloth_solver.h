// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/deformable/touch_springs.h"

namespace embody::physics {

using Float4 = float __attribute__((vector_size(16)));

/// 3 × 3 floats by columns; the fourth rows are zero.
struct Block {
    Float4 x{}, y{}, z{};
};

/// A symmetric matrix over nodes: a block a node on the diagonal, blocks between neighbours, and multiples of the
/// identity between nodes farther off. Row i of each holds its elements from start[i] to start[i + 1].
struct ClothMatrix {
    std::vector<Block> diagonal;
    std::vector<std::uint32_t> start, column;
    std::vector<Block> block;
    std::vector<std::uint32_t> far_start, far_column;
    std::vector<float> far_value;
};

/// Conjugate gradients for the moves of nodes and touched bodies,
///   (A + springs) d = rhs.
/// Preconditioned by the inverse of everything that couples a node with itself and with the bodies that hold it:
/// springs of any stiffness cost no rounds. In floats, sums in doubles and in a fixed order: same bits for any worker
/// count.
class ClothSolver {
public:
    /// `fixed`: nodes that do not move. `moves`: first guess and answer. It ends when
    /// the residual is `tolerance` of `small_load` (N) in the norm of the preconditioner.
    /// Returns the rounds that it took, or not_finite where numbers have broken.
    int solve(const ClothMatrix& matrix, std::span<const Vec3> rhs, std::span<const Vec3> small_load,
              std::span<const std::uint8_t> fixed, std::span<const TouchSpring> springs,
              std::span<const BodyInertia> bodies, std::span<Vec3> moves, std::span<BodyMove> body_moves,
              TaskPool& workers);

    static constexpr int not_finite = -1;
    double tolerance = 5e-3;
    int most_rounds = 200;

private:
    struct BodyFactor {
        std::array<double, 36> factor{};  // of its mass and what springs add, what nodes give way taken off
    };
    void prepare(const ClothMatrix& matrix, std::span<const std::uint8_t> fixed, std::span<const TouchSpring> springs,
                 std::span<const BodyInertia> bodies);
    void multiply_rows(const ClothMatrix& matrix, std::size_t chunk);
    void add_springs(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    void precondition_bodies(std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies);
    void iterate(const ClothMatrix& matrix, std::span<const TouchSpring> springs, std::span<const BodyInertia> bodies,
                 double enough, int worker, Barrier& barrier);
    [[nodiscard]] double sum_of(const std::vector<double>& parts) const;

    std::vector<Block> own_, inverse_;  // node's own block, springs with it, and its inverse
    std::vector<Float4> direction_, product_, residual_, better_, answer_;  // p, q, r, z, d
    std::vector<BodyMove> body_direction_, body_product_, body_residual_, body_better_, body_answer_;
    std::vector<BodyFactor> body_factors_;
    std::vector<std::uint32_t> coupled_;  // springs of more than one node or a body that moves
    std::vector<double> parts_, other_parts_;
    std::size_t nodes_ = 0;
    int workers_ = 1, rounds_ = 0;
};

}  // namespace embody::physics
