// SPDX-License-Identifier: MIT
#include "physics/linear/dissected_cholesky.h"

#include <gtest/gtest.h>

#include <set>

#include "physics/linear/dense_matrix.h"

namespace embody::physics::linear {
namespace {

using Edges = std::vector<DissectedCholesky::Edge>;

Vec3 random_point(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

/// Nodes at places, springs between them, and the ground under each.
struct Mesh {
    std::vector<Vec3> positions;
    Edges edges;
    std::vector<Mat3> diagonal, blocks;

    [[nodiscard]] std::size_t size() const { return positions.size(); }
    void make_springs(Random& random, double ground = 0.5) {
        diagonal.assign(size(), ground * Mat3::identity());
        blocks.clear();
        for (const auto [a, b] : edges) {
            // ½ (n·a − m·b)² + 0.05 (a − b)²: no block is symmetric.
            const Vec3 n = random_point(random), m = random_point(random);
            const Mat3 stiff_a = outer(n, n), stiff_b = outer(m, m);
            diagonal[a] += stiff_a + 0.1 * Mat3::identity();
            diagonal[b] += stiff_b + 0.1 * Mat3::identity();
            blocks.push_back(-1 * outer(n, m) - 0.1 * Mat3::identity());
        }
    }
    static Mat3 outer(Vec3 a, Vec3 b) { return {b.x * a, b.y * a, b.z * a}; }

    [[nodiscard]] DenseMatrix dense() const {
        DenseMatrix matrix(3 * size());
        const auto add = [&](std::size_t row, std::size_t column, const Mat3& block) {
            for (std::size_t r = 0; r < 3; ++r) {
                for (std::size_t c = 0; c < 3; ++c)
                    matrix.at(3 * row + r, 3 * column + c) += block(static_cast<int>(r), static_cast<int>(c));
            }
        };
        for (std::size_t i = 0; i < size(); ++i) add(i, i, diagonal[i]);
        for (std::size_t e = 0; e < edges.size(); ++e) {
            add(edges[e][0], edges[e][1], blocks[e]);
            add(edges[e][1], edges[e][0], transpose(blocks[e]));
        }
        return matrix;
    }
    [[nodiscard]] std::vector<double> solve(const std::vector<double>& b, int workers = 1) const {
        DissectedCholesky cholesky;
        cholesky.analyse(positions, edges);
        cholesky.factor(diagonal, edges, blocks);
        return solve_with(cholesky, b, workers);
    }
    static std::vector<double> solve_with(DissectedCholesky& cholesky, const std::vector<double>& b, int workers = 1) {
        std::vector<Vec3f> x(b.size() / 3);
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = {static_cast<float>(b[3 * i]), static_cast<float>(b[3 * i + 1]), static_cast<float>(b[3 * i + 2])};
        TaskPool pool(workers);
        cholesky.solve(x, pool);
        std::vector<double> result;
        for (const Vec3f& v : x) {
            for (const float value : {v.x, v.y, v.z}) result.push_back(static_cast<double>(value));
        }
        return result;
    }
};

Mesh random_mesh(std::size_t nodes, double edges_a_node, Random& random) {
    Mesh mesh;
    for (std::size_t i = 0; i < nodes; ++i) mesh.positions.push_back(random_point(random));
    std::set<DissectedCholesky::Edge> seen;
    const auto tries = static_cast<std::size_t>(edges_a_node * static_cast<double>(nodes));
    for (std::size_t k = 0; k < tries; ++k) {
        const auto a = static_cast<std::uint32_t>(random.below(nodes)),
                   b = static_cast<std::uint32_t>(random.below(nodes));
        if (a == b || seen.contains({a, b}) || seen.contains({b, a})) continue;
        seen.insert({a, b});
        mesh.edges.push_back({a, b});
    }
    mesh.make_springs(random);
    return mesh;
}

/// A box of nodes with their neighbours along the axes.
Mesh box_mesh(std::uint32_t x, std::uint32_t y, std::uint32_t z, Random& random) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < x * y * z; ++i) {
        const std::uint32_t at[3] = {i % x, i / x % y, i / (x * y)};
        mesh.positions.push_back({static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])});
        if (at[0] + 1 < x) mesh.edges.push_back({i, i + 1});
        if (at[1] + 1 < y) mesh.edges.push_back({i + x, i});
        if (at[2] + 1 < z) mesh.edges.push_back({i, i + x * y});
    }
    mesh.make_springs(random);
    return mesh;
}

constexpr double float_tolerance = 2e-5;  // of what is kept and solved in floats

TEST(DissectedCholesky, NodesWithoutAPositivePivotDoNotMove) {
    Random random(1);
    for (const double bad : {0.0, -1.0, -1e6}) {
        Mesh mesh = random_mesh(40, 2, random);
        const auto held = static_cast<std::uint32_t>(random.below(40));
        // Nothing joins it, so that its pivots are its own numbers.
        for (std::size_t e = mesh.edges.size(); e-- > 0;) {
            if (mesh.edges[e][0] == held || mesh.edges[e][1] == held)
                mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(e));
        }
        mesh.make_springs(random);
        mesh.diagonal[held] = bad * Mat3::identity();
        const std::vector<double> b = random_vector(120, random), x = mesh.solve(b);
        DenseMatrix dense = mesh.dense();
        for (std::size_t k = 3 * held; k < 3 * held + 3; ++k) {
            dense.at(k, k) = 1;
            EXPECT_LT(std::fabs(x[k]), 1e-20) << bad;
        }
        std::vector<double> expected = dense.solve(b);
        for (std::size_t k = 3 * held; k < 3 * held + 3; ++k) expected[k] = x[k];
        EXPECT_LT(largest_difference(x, expected), float_tolerance) << bad;
    }
}

TEST(DissectedCholesky, AnEmptyMeshIsSolved) { EXPECT_TRUE(Mesh{}.solve({}).empty()); }

TEST(DissectedCholesky, SolvesRandomGraphsAsEliminationDoes) {
    Random random(2);
    for (int iteration = 0; iteration < 40; ++iteration) {
        const std::size_t nodes = 1 + random.below(70);
        const Mesh mesh = random_mesh(nodes, random.between(0, 4), random);
        const std::vector<double> b = random_vector(3 * nodes, random);
        ASSERT_LT(largest_difference(mesh.solve(b), mesh.dense().solve(b)), float_tolerance)
            << iteration << " " << nodes;
    }
}

TEST(DissectedCholesky, SolvesNodesAtOnePlace) {
    Random random(3);
    Mesh mesh = random_mesh(50, 3, random);
    for (Vec3& position : mesh.positions) position = {1, 2, 3};
    const std::vector<double> b = random_vector(150, random);
    EXPECT_LT(largest_difference(mesh.solve(b), mesh.dense().solve(b)), float_tolerance);
}

TEST(DissectedCholesky, TheOrderOfNodesAndEndsDoesNotMatter) {
    Random random(4);
    const Mesh mesh = random_mesh(60, 3, random);
    const std::vector<double> b = random_vector(180, random), expected = mesh.solve(b);
    for (int iteration = 0; iteration < 10; ++iteration) {
        std::vector<std::uint32_t> number(60);
        for (std::uint32_t i = 0; i < 60; ++i) number[i] = i;
        for (std::size_t i = 60; i-- > 1;) std::swap(number[i], number[random.below(i + 1)]);
        Mesh other = mesh;
        std::vector<double> right(180);
        for (std::size_t i = 0; i < 60; ++i) {
            other.positions[number[i]] = mesh.positions[i];
            other.diagonal[number[i]] = mesh.diagonal[i];
            for (std::size_t k = 0; k < 3; ++k) right[3 * number[i] + k] = b[3 * i + k];
        }
        for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
            other.edges[e] = {number[mesh.edges[e][0]], number[mesh.edges[e][1]]};
            if (random.below(2) == 0) continue;
            std::swap(other.edges[e][0], other.edges[e][1]);
            other.blocks[e] = transpose(mesh.blocks[e]);
        }
        const std::vector<double> found = other.solve(right);
        for (std::size_t i = 0; i < 60; ++i) {
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(found[3 * number[i] + k], expected[3 * i + k], float_tolerance) << iteration;
        }
    }
}

TEST(DissectedCholesky, AnyNumberOfWorkersGivesTheSameBits) {
    Random random(5);
    const Mesh mesh = box_mesh(12, 10, 9, random);
    DissectedCholesky cholesky;
    cholesky.analyse(mesh.positions, mesh.edges);
    cholesky.factor(mesh.diagonal, mesh.edges, mesh.blocks);
    ASSERT_GT(cholesky.numbers(), 200000u) << "so few are not shared";
    const std::vector<double> b = random_vector(3 * mesh.size(), random), alone = Mesh::solve_with(cholesky, b);
    EXPECT_EQ(Mesh::solve_with(cholesky, b, 2), alone);
    EXPECT_EQ(Mesh::solve_with(cholesky, b, 3), alone);
    EXPECT_EQ(Mesh::solve_with(cholesky, b), alone);
    EXPECT_LT(largest_difference(mesh.dense().times(alone), b), 1e-3);
}

TEST(DissectedCholesky, BlocksOfTheInverseAreThoseOfElimination) {
    Random random(6);
    const Mesh mesh = random_mesh(30, 2, random);
    DissectedCholesky cholesky;
    cholesky.analyse(mesh.positions, mesh.edges);
    cholesky.factor(mesh.diagonal, mesh.edges, mesh.blocks);
    std::vector<DissectedCholesky::Columns> columns;
    for (std::uint32_t i = 0; i < 30; ++i) columns.push_back(cholesky.columns(i));
    const DenseMatrix dense = mesh.dense();
    for (std::size_t j = 0; j < 30; ++j) {
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<double> unit(90, 0.0);
            unit[3 * j + c] = 1;
            const std::vector<double> column = dense.solve(unit);
            for (std::size_t i = 0; i < 30; ++i) {
                const Mat3 block = cholesky.inverse_block(columns[i], columns[j]);
                for (int r = 0; r < 3; ++r)
                    EXPECT_NEAR(block(r, static_cast<int>(c)), column[3 * i + static_cast<std::size_t>(r)],
                                float_tolerance)
                        << i << " " << j;
            }
        }
    }
}

TEST(DissectedCholesky, ANewMatrixReplacesTheOldOne) {
    Random random(7);
    Mesh mesh = random_mesh(40, 3, random);
    DissectedCholesky cholesky;
    cholesky.analyse(mesh.positions, mesh.edges);
    const std::vector<double> b = random_vector(120, random);
    for (int iteration = 0; iteration < 3; ++iteration) {
        mesh.make_springs(random);
        cholesky.factor(mesh.diagonal, mesh.edges, mesh.blocks);
        EXPECT_LT(largest_difference(Mesh::solve_with(cholesky, b), mesh.dense().solve(b)), float_tolerance)
            << iteration;
    }
}

// What each front says of the order, by the edges alone.
void expect_consistent(const NestedDissection& order, const Mesh& mesh) {
    ASSERT_EQ(order.place.size(), mesh.size());
    std::vector<int> covered(mesh.size(), 0);
    for (std::size_t place = 0; place < mesh.size(); ++place) EXPECT_EQ(order.place[order.node[place]], place);
    for (std::uint32_t f = 0; f < order.fronts.size(); ++f) {
        const Front& front = order.fronts[f];
        EXPECT_GT(front.own(), 0u);
        EXPECT_GE(front.parent, f);
        EXPECT_EQ(front.parent == f, front.rows.empty());
        for (std::uint32_t place = front.first; place < front.last; ++place) {
            ++covered[place];
            EXPECT_EQ(order.front_of[place], f);
        }
        for (std::size_t k = 0; k < front.rows.size(); ++k) {
            EXPECT_GE(front.rows[k], front.last);
            // The same node, as the parent numbers its own and its rows.
            const Front& parent = order.fronts[front.parent];
            const std::size_t in = front.in_parent[k];
            ASSERT_LT(in, parent.size());
            EXPECT_EQ(in < parent.own() ? parent.first + in : parent.rows[in - parent.own()], front.rows[k]);
        }
    }
    for (const int times : covered) EXPECT_EQ(times, 1);
    for (const auto [a, b] : mesh.edges) {
        const std::uint32_t low = std::min(order.place[a], order.place[b]),
                            high = std::max(order.place[a], order.place[b]);
        const Front& front = order.fronts[order.front_of[low]];
        EXPECT_TRUE(high < front.last || std::ranges::binary_search(front.rows, high));
    }
}

TEST(NestedDissection, FrontsHoldEachNodeOnceAndReachAllItsNeighbours) {
    Random random(8);
    for (int iteration = 0; iteration < 30; ++iteration) {
        const Mesh mesh = random_mesh(1 + random.below(200), random.between(0, 3), random);
        expect_consistent(dissect(mesh.positions, mesh.edges), mesh);
    }
    const Mesh box = box_mesh(9, 5, 3, random);
    expect_consistent(dissect(box.positions, box.edges), box);
    EXPECT_TRUE(dissect({}, {}).fronts.empty());
}

// By nested dissection a square of n nodes has a factor of O(n log n) numbers; in the order of its rows it has n^1.5.
TEST(NestedDissection, FillOfSquaresGrowsSlowerThanThatOfTheirRows) {
    Random random(9);
    const auto numbers = [&](std::uint32_t side) {
        const Mesh mesh = box_mesh(side, side, 1, random);
        DissectedCholesky cholesky;
        cholesky.analyse(mesh.positions, mesh.edges);
        return static_cast<double>(cholesky.numbers());
    };
    // 16 times the nodes: 64 times the numbers in the order of rows, 16 log(6400) / log(400) = 23 by dissection.
    EXPECT_LT(numbers(80) / numbers(20), 32);
}

}  // namespace
}  // namespace embody::physics::linear
