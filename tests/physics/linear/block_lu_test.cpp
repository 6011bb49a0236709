// SPDX-License-Identifier: MIT
#include "physics/linear/block_lu.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "foundation/random.h"

namespace embody::physics::linear {
namespace {

using Edges = std::vector<BlockLu::Edge>;

/// A random matrix on a graph, in the solver and dense: bodies with a dominant diagonal, multipliers with next to none
/// and rows that differ.
struct Matrix {
    Matrix(std::size_t bodies, std::size_t multipliers, const Edges& edges, Random& random)
        : size(6 * (bodies + multipliers)), dense(size * size, 0.0) {
        lu.analyse(bodies + multipliers, edges, multipliers);
        lu.clear();
        for (std::size_t node = 0; node < bodies + multipliers; ++node) {
            const double sign = node < bodies ? 10 : -1e-9;
            for (std::size_t r = 0; r < 6; ++r) {
                for (std::size_t c = 0; c < 6; ++c) {
                    const double value = sign * ((r == c ? 1 : 0) + (node < bodies ? random.between(-0.1, 0.1) : 0));
                    lu.diagonal(node).column[c][r] += value;
                    dense[(6 * node + r) * size + 6 * node + c] += value;
                }
            }
        }
        for (std::size_t edge = 0; edge < edges.size(); ++edge) add_edge(edges[edge], edge, random);
    }

    void add_edge(const BlockLu::Edge& ends, std::size_t edge, Random& random) {
        const std::size_t rows = ends[static_cast<std::size_t>(lu.row_end(edge))];
        const std::size_t columns = ends[1 - static_cast<std::size_t>(lu.row_end(edge))];
        for (std::size_t r = 0; r < 6; ++r) {
            for (std::size_t c = 0; c < 6; ++c) {
                const double shared = random.between(-0.2, 0.2) + (r == c ? 1 : 0),
                             lower = shared + random.between(-0.1, 0.1);
                lu.lower(edge).column[c][r] += lower;
                lu.upper(edge).column[c][r] += shared;
                dense[(6 * rows + r) * size + 6 * columns + c] += lower;
                dense[(6 * columns + c) * size + 6 * rows + r] += shared;
            }
        }
    }

    /// Largest difference between what was solved for and the dense matrix times the solution, over its largest number.
    double residual(Random& random) {
        std::vector<Vec6> right(size / 6), solution;
        for (Vec6& v : right) {
            for (double& number : v.value) number = random.between(-1, 1);
        }
        lu.factor();
        solution = right;
        lu.solve(solution);
        double worst = 0, largest = 1;
        for (std::size_t r = 0; r < size; ++r) {
            largest = std::max(largest, std::fabs(solution[r / 6].value[r % 6]));
            double sum = 0;
            for (std::size_t c = 0; c < size; ++c) sum += dense[r * size + c] * solution[c / 6].value[c % 6];
            worst = std::max(worst, std::fabs(sum - right[r / 6].value[r % 6]));
        }
        return worst / largest;
    }

    std::size_t size;
    std::vector<double> dense;
    BlockLu lu;
};

TEST(BlockLu, WhatHasNoPivotDoesNotMove) {
    BlockLu lu;
    lu.analyse(2, Edges{{0, 1}}, 0);
    lu.clear();
    for (int i = 0; i < 6; ++i) lu.diagonal(0).column[i][i] = lu.diagonal(1).column[i][i] = i == 4 ? 0 : -4;
    lu.factor();
    std::vector<Vec6> x(2, Vec6{{1, 1, 1, 1, 1, 1}});
    lu.solve(x);
    for (const Vec6& node : x) {
        for (int i = 0; i < 6; ++i) {
            if (i == 4)
                EXPECT_LT(std::fabs(node.value[i]), 1e-90);
            else
                EXPECT_EQ(node.value[i], -0.25);
        }
    }
}

TEST(BlockLu, AnEmptyMatrixIsSolved) {
    BlockLu lu;
    lu.analyse(0, Edges{}, 0);
    lu.clear();
    lu.factor();
    std::vector<Vec6> none;
    lu.solve(none);
    EXPECT_TRUE(none.empty());
}

TEST(BlockLu, SolvesTreesOfJointedBodies) {
    Random random(11);
    for (int iteration = 0; iteration < 60; ++iteration) {
        // Each body after the first hangs on an earlier one by a multiplier.
        const auto bodies = static_cast<std::uint16_t>(1 + random.between(0, 20));
        Edges edges;
        for (std::uint16_t i = 1; i < bodies; ++i) {
            const auto joint = static_cast<std::uint16_t>(bodies + i - 1);
            edges.push_back({joint, i});
            edges.push_back({joint, static_cast<std::uint16_t>(random.between(0, i))});
        }
        Matrix matrix(bodies, static_cast<std::size_t>(bodies - 1), edges, random);
        ASSERT_LT(matrix.residual(random), 1e-10) << "round " << iteration;
    }
}

TEST(BlockLu, SolvesLoops) {
    Random random(12);
    for (int iteration = 0; iteration < 60; ++iteration) {
        const auto bodies = static_cast<std::uint16_t>(3 + random.between(0, 10));
        Edges edges;
        for (std::uint16_t i = 0; i < bodies; ++i) {
            const auto next = static_cast<std::uint16_t>((i + 1) % bodies);
            edges.push_back({i, next});
        }
        Matrix matrix(bodies, 0, edges, random);
        ASSERT_LT(matrix.residual(random), 1e-12) << "round " << iteration;
    }
}

TEST(BlockLu, MultipliersWaitForANeighbour) {
    // One body held by the world: its multiplier has no diagonal to begin with.
    BlockLu lu;
    lu.analyse(2, Edges{{1, 0}}, 1);
    lu.clear();
    for (int i = 0; i < 6; ++i) {
        lu.diagonal(0).column[i][i] = 2;
        lu.lower(0).column[i][i] = lu.upper(0).column[i][i] = -1;
    }
    lu.factor();
    std::vector<Vec6> x{{{2, 2, 2, 2, 2, 2}}, {}};
    lu.solve(x);
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(x[0].value[i], 0);
        EXPECT_EQ(x[1].value[i], -2);
    }
}

}  // namespace
}  // namespace embody::physics::linear
