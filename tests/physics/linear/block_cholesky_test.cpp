// SPDX-License-Identifier: MIT
#include "physics/linear/block_cholesky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/random.h"
#include "math/kernel_width.h"

namespace embody::physics::linear {
namespace {

using Edges = std::vector<BlockCholesky::Edge>;

/// A random positive definite matrix on a graph: in the solver, and dense.
struct Pair {
    Pair(std::size_t nodes, const Edges& edges, Random& random)
        : size(6 * nodes), dense(size * size, 0.0), springs(edges) {
        matrix.analyse(nodes, edges);
        matrix.clear();
        for (std::size_t node = 0; node < nodes; ++node) {
            for (std::size_t i = 0; i < 6; ++i) add_diagonal(node, i, i, random.between(0.1, 2));
        }
        // A spring between the ends of each edge along a random direction of the twelve, a few times.
        for (std::size_t edge = 0; edge < edges.size(); ++edge) {
            for (int k = 0; k < 4; ++k) add_spring(edge, random);
        }
    }

    void add_diagonal(std::size_t node, std::size_t row, std::size_t column, double value) {
        matrix.diagonal(node).column[column][row] += value;
        dense[(6 * node + row) * size + 6 * node + column] += value;
    }
    void add_spring(std::size_t edge, Random& random) {
        double direction[2][6];
        for (auto& end : direction) {
            for (double& number : end) number = 10 * random.between(-1, 1);
        }
        const auto rows = static_cast<std::size_t>(matrix.row_end(edge)), columns = 1 - rows;
        for (std::size_t i = 0; i < 6; ++i) {
            for (std::size_t j = 0; j < 6; ++j) {
                for (std::size_t end = 0; end < 2; ++end) {
                    add_diagonal(springs[edge][end], i, j, direction[end][i] * direction[end][j]);
                }
                const double value = direction[rows][i] * direction[columns][j];
                matrix.off_diagonal(edge).column[j][i] += value;
                const std::size_t r = 6 * springs[edge][rows] + i, c = 6 * springs[edge][columns] + j;
                dense[r * size + c] += value;
                dense[c * size + r] += value;
            }
        }
    }

    /// Largest difference between what was solved for and the dense matrix times the solution.
    double residual(Random& random) {
        std::vector<Vec6> right(size / 6), solution;
        for (Vec6& v : right) {
            for (double& number : v.value) number = random.between(-1, 1);
        }
        matrix.factor();
        solution = right;
        matrix.solve(solution);
        double worst = 0;
        for (std::size_t r = 0; r < size; ++r) {
            double sum = 0;
            for (std::size_t c = 0; c < size; ++c) sum += dense[r * size + c] * solution[c / 6].value[c % 6];
            worst = std::max(worst, std::fabs(sum - right[r / 6].value[r % 6]));
        }
        return worst;
    }

    std::size_t size;
    std::vector<double> dense;
    Edges springs;
    BlockCholesky matrix;
};

TEST(BlockCholesky, SolvesMatricesOfRandomGraphs) {
    Random random(5);
    for (int iteration = 0; iteration < 60; ++iteration) {
        const auto nodes = static_cast<std::size_t>(1 + random.between(0, 24));
        Edges edges;
        for (int i = 0; i < static_cast<int>(nodes * random.between(0, 3)); ++i) {
            const auto p = static_cast<std::uint16_t>(random.between(0, static_cast<double>(nodes)));
            const auto q = static_cast<std::uint16_t>(random.between(0, static_cast<double>(nodes)));
            if (p != q) edges.push_back({p, q});
        }
        Pair pair(nodes, edges, random);
        ASSERT_LT(pair.residual(random), 1e-9) << "round " << iteration;
    }
}

// The same springs between nodes of other numbers.
TEST(BlockCholesky, TheOrderOfNodesDoesNotMatter) {
    constexpr std::uint16_t nodes = 15;
    for (std::uint16_t step = 2; step < nodes; step = static_cast<std::uint16_t>(2 * step)) {
        // node -> step node + 3 modulo their number, which has no divisor in common with powers of two.
        const auto number = [&](std::size_t node) { return static_cast<std::uint16_t>((step * node + 3) % nodes); };
        Edges edges, others;
        for (std::uint16_t i = 0; i < nodes; ++i) {
            for (const int far : {1, 4}) {
                const auto other = static_cast<std::uint16_t>((i + far) % nodes);
                edges.push_back({i, other});
                others.push_back({number(other), number(i)});
            }
        }
        BlockCholesky one, two;
        std::vector<Vec6> x(nodes), y(nodes);
        Random random(7);
        for (auto* matrix : {&one, &two}) {
            matrix->analyse(nodes, matrix == &one ? edges : others);
            matrix->clear();
        }
        for (std::size_t i = 0; i < nodes; ++i) {
            for (int k = 0; k < 6; ++k) {
                x[i].value[k] = y[number(i)].value[k] = random.between(-1, 1);
                one.diagonal(i).column[k][k] = two.diagonal(number(i)).column[k][k] = random.between(20, 30);
            }
        }
        for (std::size_t e = 0; e < edges.size(); ++e) {
            // Whose rows they are is the pattern's choice; the second list has the ends the other way round.
            const bool is_turned = one.row_end(e) == two.row_end(e);
            for (int r = 0; r < 6; ++r) {
                for (int c = 0; c < 6; ++c) {
                    const double value = random.between(-0.5, 0.5);
                    one.off_diagonal(e).column[c][r] = value;
                    (is_turned ? two.off_diagonal(e).column[r][c] : two.off_diagonal(e).column[c][r]) = value;
                }
            }
        }
        for (auto* matrix : {&one, &two}) matrix->factor();
        one.solve(x);
        two.solve(y);
        for (std::size_t i = 0; i < nodes; ++i) {
            for (int k = 0; k < 6; ++k) EXPECT_NEAR(x[i].value[k], y[number(i)].value[k], 1e-14) << step << " " << i;
        }
    }
}

TEST(BlockCholesky, ChainFillsNothing) {
    Edges edges;
    for (std::uint16_t i = 0; i + 1 < 30; ++i) edges.push_back({i, static_cast<std::uint16_t>(i + 1)});
    BlockCholesky matrix;
    matrix.analyse(30, edges);
    // A pivot and a solved block a body, and one product a link.
    EXPECT_LE(matrix.block_products(), 3u * 30u);
}

TEST(BlockCholesky, PivotsThatAreNotPositiveDoNotMove) {
    for (const double bad : {0.0, -1.0, -1e6}) {
        BlockCholesky matrix;
        matrix.analyse(2, Edges{{0, 1}});
        matrix.clear();
        for (int i = 0; i < 6; ++i) matrix.diagonal(0).column[i][i] = matrix.diagonal(1).column[i][i] = 4;
        matrix.diagonal(1).column[2][2] = bad;
        matrix.factor();
        std::vector<Vec6> x(2, Vec6{{1, 1, 1, 1, 1, 1}});
        matrix.solve(x);
        for (int i = 0; i < 6; ++i) {
            EXPECT_EQ(x[0].value[i], 0.25);
            if (i == 2)
                EXPECT_LT(std::fabs(x[1].value[i]), 1e-90) << bad;
            else
                EXPECT_EQ(x[1].value[i], 0.25) << bad;
        }
    }
}

TEST(BlockCholesky, AnEmptyMatrixIsSolved) {
    BlockCholesky matrix;
    matrix.analyse(0, Edges{});
    matrix.clear();
    matrix.factor();
    matrix.solve({});
}

TEST(BlockCholesky, WhatNothingHoldsDoesNotMoveInASingularMatrix) {
    BlockCholesky matrix;
    matrix.analyse(2, Edges{{0, 1}});
    matrix.clear();
    for (int i = 0; i < 6; ++i) matrix.diagonal(0).column[i][i] = 2;
    matrix.factor();
    std::vector<Vec6> x(2, Vec6{{1, 1, 1, 1, 1, 1}});
    matrix.solve(x);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(x[0].value[i], 0.5);
        EXPECT_LT(std::fabs(x[1].value[i]), 1e-90);
    }
}

TEST(BlockCholesky, AnyWidthGivesTheSameBits) {
    const auto solution_of = [](const BlockKernels& kernels) {
        Random random(8);
        Edges ring;
        for (std::uint16_t i = 0; i < 12; ++i) ring.push_back({i, static_cast<std::uint16_t>((i + 1) % 12)});
        Pair pair(12, ring, random);
        pair.matrix.factor(kernels);
        std::vector<Vec6> x(12, make_vec6({1, 2, 3}, {4, 5, 6}));
        pair.matrix.solve(x);
        return x;
    };
    const std::vector<Vec6> expected = solution_of(*kernels_of<BlockKernels>(4));
    for (const int lanes : {8, 16}) {
        const BlockKernels* kernels = kernels_of<BlockKernels>(lanes);
        if (!kernels) continue;
        const std::vector<Vec6> found = solution_of(*kernels);
        for (std::size_t i = 0; i < found.size(); ++i) {
            for (int k = 0; k < 6; ++k) EXPECT_EQ(found[i].value[k], expected[i].value[k]) << lanes;
        }
    }
}

}  // namespace
}  // namespace embody::physics::linear
