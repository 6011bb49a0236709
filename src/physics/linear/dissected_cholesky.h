// SPDX-License-Identifier: MIT
#pragma once

#include "foundation/task_pool.h"
#include "math/mat3.h"
#include "physics/linear/namespace.h"
#include "physics/linear/nested_dissection.h"

namespace embody::physics::linear {

/// The factor L Lᵀ of a sparse symmetric positive definite matrix with a 3×3 block a pair of joined nodes, by fronts
/// (I. Duff, J. Reid, "The multifrontal solution of indefinite sparse symmetric linear equations", 1983). Factored in
/// double precision, kept and solved in single: it serves as a preconditioner. The same bits for any number of workers.
class DissectedCholesky {
public:
    using Edge = std::array<std::uint32_t, 2>;

    /// Finds the order of elimination for nodes at these places. Each edge once.
    void analyse(std::span<const Vec3> positions, std::span<const Edge> edges);
    /// Replaces the factor by that of a matrix: its diagonal blocks by node, and the blocks in row edge[0] and column
    /// edge[1] by edge. A pivot that rounding made zero or negative is replaced by a huge one: its unknown then
    /// does not move.
    void factor(std::span<const Mat3> diagonal, std::span<const Edge> edges, std::span<const Mat3> blocks);
    /// Solves for one right side, in place; by node.
    void solve(std::span<Vec3f> x, TaskPool& workers);

    /// The three columns L⁻¹ E of a node, E its columns of the unit matrix; only along the fronts that the node
    /// reaches, the numbers of the last front first: column by column, `length` numbers each.
    struct Columns {
        std::uint32_t front = 0;
        std::size_t length = 0;
        std::vector<float> value;
    };
    [[nodiscard]] Columns columns(std::uint32_t node) const;
    /// The block (i, j) of the inverse matrix, of the columns of nodes i and j.
    [[nodiscard]] Mat3 inverse_block(const Columns& i, const Columns& j) const;

    [[nodiscard]] std::size_t numbers() const { return value_.size(); }

private:
    struct Subtrees {
        std::vector<std::vector<std::uint32_t>> of_worker;  ///< fronts, children before parents
        std::vector<std::uint32_t> rest;                    ///< above these
    };
    [[nodiscard]] const float* column(const Front& front, std::size_t own_column) const;
    void gather_children(std::uint32_t front, float* local) const;
    void eliminate_down(const Front& front, float* w) const;
    void solve_down(std::uint32_t front);
    void solve_up(std::uint32_t front);
    void find_parallel_subtrees(int workers);

    NestedDissection order_;
    std::vector<std::size_t> first_value_;  // by front: a column after the other of 3 size() numbers
    std::vector<std::size_t> depth_;        // by front: numbers of a column from the last front to this
    std::vector<float> value_;
    std::vector<std::vector<float>> local_;  // by front, of the last solve: own numbers, then what it leaves its parent
    std::vector<Vec3f> x_;                   // by place
    Subtrees subtrees_;
    int parallel_workers_ = 0;
};

}  // namespace embody::physics::linear
