// SPDX-License-Identifier: MIT
#include "physics/linear/band_cholesky.h"

#include <gtest/gtest.h>

#include <limits>

#include "physics/linear/dense_matrix.h"

namespace embody::physics::linear {
namespace {

Mat3 random_block(Random& random) {
    const auto column = [&] { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; };
    return {column(), column(), column()};
}

std::vector<Vec3> to_points(const std::vector<double>& numbers) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    return points;
}

std::vector<double> to_numbers(const std::vector<Vec3>& points) {
    std::vector<double> numbers;
    for (const Vec3& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

/// A random positive definite matrix, in the solver and dense.
struct Matrices {
    BandCholesky band;
    DenseMatrix dense;

    Matrices(std::size_t blocks, Random& random) : dense(3 * blocks) {
        band.reset(blocks);
        for (std::size_t i = 0; i < blocks; ++i) {
            // Two halves, so that what is added twice counts twice.
            for (int half = 0; half < 2; ++half) {
                const Mat3 g = random_block(random);
                add(i, i, g * transpose(g));
            }
            band.add_diagonal(i, 8);
            for (std::size_t r = 3 * i; r < 3 * i + 3; ++r) dense.at(r, r) += 8;
            for (std::size_t k = i >= 2 ? i - 2 : 0; k < i; ++k) add(i, k, random_block(random));
        }
    }
    void add(std::size_t i, std::size_t k, const Mat3& block) {
        band.add(i, k, block);
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                const double value = block(static_cast<int>(r), static_cast<int>(c));
                dense.at(3 * i + r, 3 * k + c) += value;
                if (i != k) dense.at(3 * k + c, 3 * i + r) += value;
            }
        }
    }
};

TEST(BandCholesky, WhatIsNotPositiveDefiniteIsReported) {
    Random random(1);
    const double infinity = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, -infinity, infinity, none}) {
        for (std::size_t at = 0; at < 4; ++at) {
            BandCholesky band;
            band.reset(4);
            for (std::size_t i = 0; i < 4; ++i) band.add_diagonal(i, i == at ? bad : 1);
            EXPECT_FALSE(band.factorize()) << bad << " at " << at;
        }
    }
    // Positive on the diagonal, but not definite: (1 2; 2 1) of the first numbers of two nodes.
    for (const double coupling : {2.0, infinity, none}) {
        BandCholesky band;
        band.reset(3);
        for (std::size_t i = 0; i < 3; ++i) band.add_diagonal(i, 1);
        Mat3 block = Mat3::zero();
        block(0, 0) = coupling;
        band.add(2, 0, block);
        EXPECT_FALSE(band.factorize()) << coupling;
    }
}

TEST(BandCholesky, AnEmptyMatrixIsSolved) {
    BandCholesky band;
    band.reset(0);
    EXPECT_TRUE(band.factorize());
    band.solve({});
}

TEST(BandCholesky, SolvesAsEliminationDoes) {
    Random random(2);
    for (int iteration = 0; iteration < 60; ++iteration) {
        const std::size_t blocks = 1 + random.below(25);
        Matrices matrices(blocks, random);
        const std::vector<double> b = random_vector(3 * blocks, random);
        std::vector<Vec3> x = to_points(b);
        ASSERT_TRUE(matrices.band.factorize()) << iteration;
        matrices.band.solve(x);
        EXPECT_LT(largest_difference(to_numbers(x), matrices.dense.solve(b)), 1e-12) << iteration;
    }
}

TEST(BandCholesky, MeanOfADiagonalBlockIsThatOfItsThreeNumbers) {
    BandCholesky band;
    band.reset(2);
    band.add(1, 1, Mat3::diagonal({1, 2, 6}));
    band.add_diagonal(1, 1);
    EXPECT_EQ(band.diagonal_mean(0), 0);
    EXPECT_EQ(band.diagonal_mean(1), 4);
}

TEST(BandCholesky, FixedNodesStayAndOthersMoveAsIfTheyWereZero) {
    Random random(3);
    for (int iteration = 0; iteration < 30; ++iteration) {
        constexpr std::size_t blocks = 9;
        Matrices matrices(blocks, random);
        std::vector<double> b = random_vector(3 * blocks, random);
        const std::vector<std::size_t> fixed{random.below(blocks), random.below(blocks)};
        for (const std::size_t i : fixed) {
            matrices.band.fix(i);
            for (std::size_t r = 3 * i; r < 3 * i + 3; ++r) {
                b[r] = 0;
                for (std::size_t c = 0; c < 3 * blocks; ++c)
                    matrices.dense.at(r, c) = matrices.dense.at(c, r) = r == c ? 1 : 0;
            }
        }
        std::vector<Vec3> x = to_points(b);
        ASSERT_TRUE(matrices.band.factorize()) << iteration;
        matrices.band.solve(x);
        EXPECT_LT(largest_difference(to_numbers(x), matrices.dense.solve(b)), 1e-12) << iteration;
        for (const std::size_t i : fixed) EXPECT_EQ(x[i], Vec3{}) << iteration;
    }
}

TEST(BandCholesky, ResetForgetsTheMatrixBefore) {
    Random random(4);
    Matrices first(6, random);
    first.band.reset(2);
    first.band.add_diagonal(0, 2);
    first.band.add_diagonal(1, 4);
    std::vector<Vec3> x{{1, 2, 3}, {4, 8, 12}};
    ASSERT_TRUE(first.band.factorize());
    first.band.solve(x);
    EXPECT_LT(length(x[0] - Vec3{0.5, 1, 1.5}) + length(x[1] - Vec3{1, 2, 3}), 1e-15);
}

}  // namespace
}  // namespace embody::physics::linear
