// SPDX-License-Identifier: MIT
#include "physics/linear/envelope_cholesky.h"

#include <gtest/gtest.h>

#include <limits>

#include "physics/linear/dense_matrix.h"

namespace embody::physics::linear {
namespace {

TEST(EnvelopeCholesky, SolvesAsEliminationDoes) {
    Random random(1);
    for (int iteration = 0; iteration < 100; ++iteration) {
        const std::size_t rows = 1 + random.below(60);
        std::vector<std::size_t> first(rows);
        for (std::size_t i = 0; i < rows; ++i) first[i] = random.below(i + 1);
        EnvelopeCholesky matrix;
        matrix.reset(first);
        DenseMatrix dense(rows);
        for (std::size_t i = 0; i < rows; ++i) {
            for (std::size_t k = first[i]; k < i; ++k) {
                const double value = random.between(-1, 1);
                matrix.at(i, k) = dense.at(i, k) = dense.at(k, i) = value;
            }
            matrix.at(i, i) = dense.at(i, i) = static_cast<double>(rows);  // more than the rest of its row
        }
        const std::vector<double> b = random_vector(rows, random);
        std::vector<double> x = b;
        ASSERT_TRUE(matrix.factorize()) << iteration;
        matrix.solve(x);
        EXPECT_LT(largest_difference(x, dense.solve(b)), 1e-12) << iteration;
    }
}

TEST(EnvelopeCholesky, WhatIsNotPositiveDefiniteIsReported) {
    const double infinity = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::size_t> first{0, 0, 1};
    const auto is_definite = [&](double last, double coupling) {
        EnvelopeCholesky matrix;
        matrix.reset(first);
        for (std::size_t i = 0; i < 2; ++i) matrix.at(i, i) = 1;
        matrix.at(2, 2) = last;
        matrix.at(2, 1) = coupling;
        return matrix.factorize();
    };
    EXPECT_TRUE(is_definite(1, 0.9));
    for (const double bad : {0.0, -1.0, -infinity, infinity, none}) EXPECT_FALSE(is_definite(bad, 0)) << bad;
    for (const double bad : {2.0, infinity, none}) EXPECT_FALSE(is_definite(1, bad)) << bad;
}

TEST(EnvelopeCholesky, AnEmptyMatrixIsSolved) {
    EnvelopeCholesky matrix;
    matrix.reset({});
    EXPECT_TRUE(matrix.factorize());
    matrix.solve({});
}

}  // namespace
}  // namespace embody::physics::linear
