// SPDX-License-Identifier: MIT
#include "physics/linear/conjugate_gradient.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numeric>

#include "physics/linear/dense_matrix.h"
#include "physics/linear/vectors.h"

namespace embody::physics::linear {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Numbers = std::vector<double>;

/// A x = b with a preconditioner: diagonal, whole, or none.
struct PlainSystem {
    DenseMatrix a;
    Numbers b, x;
    std::function<Numbers(const Numbers&)> inverse = [](const Numbers& from) { return from; };  // of the preconditioner
    Numbers r, z, p, q;
    int products = 0;

    PlainSystem(DenseMatrix matrix, Numbers right)
        : a(std::move(matrix)), b(std::move(right)), x(b.size(), 0.0), p(b.size(), 0.0) {}

    void use_diagonal() {
        inverse = [this](const Numbers& from) {
            Numbers to = from;
            for (std::size_t i = 0; i < to.size(); ++i) to[i] /= a.at(i, i);
            return to;
        };
    }
    GradientResidual begin() {
        r = a.times(x);
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
        return precondition();
    }
    void turn(double beta) { turn_direction(beta, z, p); }
    double multiply() {
        ++products;
        q = a.times(p);
        return dot_product(p, q);
    }
    GradientResidual advance(double alpha) {
        step_along(alpha, p, q, x, r);
        return precondition();
    }
    GradientResidual precondition() {
        z = inverse(r);
        const double product = dot_product(r, z);
        return {product, product};
    }
    /// (x − solution)ᵀ A (x − solution).
    [[nodiscard]] double energy_of_error(const Numbers& solution) const {
        Numbers error = x;
        for (std::size_t i = 0; i < error.size(); ++i) error[i] -= solution[i];
        return dot_product(error, a.times(error));
    }
};

/// Does not look at A before the first product.
struct FromZero : PlainSystem {
    using PlainSystem::PlainSystem;
    GradientResidual begin() {
        r = b;
        return precondition();
    }
};

DenseMatrix diagonal_of(const Numbers& values) {
    DenseMatrix a(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) a.at(i, i) = values[i];
    return a;
}

/// Of a chain that is held at both ends, or at none: then what all have alike is not told by A.
DenseMatrix laplacian_of_chain(std::size_t size, bool is_held) {
    DenseMatrix a(size);
    for (std::size_t i = 0; i + 1 < size; ++i) {
        a.at(i, i) += 1;
        a.at(i + 1, i + 1) += 1;
        a.at(i, i + 1) = a.at(i + 1, i) = -1;
    }
    if (is_held) {
        a.at(0, 0) += 1;
        a.at(size - 1, size - 1) += 1;
    }
    return a;
}

/// Five points, held all around.
DenseMatrix laplacian_of_square(std::size_t side) {
    DenseMatrix a(side * side);
    for (std::size_t row = 0; row < side; ++row) {
        for (std::size_t column = 0; column < side; ++column) {
            const std::size_t i = row * side + column;
            a.at(i, i) = 4;
            if (column + 1 < side) a.at(i, i + 1) = a.at(i + 1, i) = -1;
            if (row + 1 < side) a.at(i, i + side) = a.at(i + side, i) = -1;
        }
    }
    return a;
}

constexpr GradientLimits to_the_end{.iterations = 1000, .relative = 1e-26};

TEST(ConjugateGradient, WhatIsNotFiniteIsReported) {
    for (const double bad : {infinity, -infinity, not_a_number}) {
        PlainSystem right(laplacian_of_chain(4, true), {1, bad, 0, 0});
        EXPECT_EQ(conjugate_gradient(right, to_the_end).end, GradientEnd::not_finite) << bad;
        EXPECT_EQ(right.x, Numbers(4, 0.0));
        PlainSystem start(laplacian_of_chain(4, true), {1, 0, 0, 0});
        start.x[2] = bad;
        EXPECT_EQ(conjugate_gradient(start, to_the_end).end, GradientEnd::not_finite) << bad;
        PlainSystem preconditioner(laplacian_of_chain(4, true), {1, 0, 0, 0});
        preconditioner.inverse = [=](const Numbers& r) { return Numbers(r.size(), bad); };
        EXPECT_EQ(conjugate_gradient(preconditioner, to_the_end).end, GradientEnd::not_finite) << bad;
        FromZero matrix(diagonal_of({1, 1, bad, 1}), {1, 0, 1, 0});
        EXPECT_EQ(conjugate_gradient(matrix, to_the_end).end, GradientEnd::not_finite) << bad;
        EXPECT_EQ(matrix.products, 1);
        EXPECT_EQ(matrix.x, Numbers(4, 0.0));
    }
}

TEST(ConjugateGradient, OverflowIsReported) {
    PlainSystem system(diagonal_of({1, 1}), {1e200, 1e200});
    EXPECT_EQ(conjugate_gradient(system, to_the_end).end, GradientEnd::not_finite);
    EXPECT_EQ(system.x, Numbers(2, 0.0));
}

TEST(ConjugateGradient, IndefiniteMatricesAreReported) {
    PlainSystem at_once(diagonal_of({1, -1}), {0, 1});
    EXPECT_EQ(conjugate_gradient(at_once, to_the_end).end, GradientEnd::indefinite);
    EXPECT_EQ(at_once.x, Numbers(2, 0.0));

    PlainSystem later(diagonal_of({3, -1}), {1, 1});
    const GradientResult result = conjugate_gradient(later, to_the_end);
    EXPECT_EQ(result.end, GradientEnd::indefinite);
    EXPECT_EQ(result.iterations, 1);

    PlainSystem nothing(DenseMatrix(3), {1, 2, 3});
    EXPECT_EQ(conjugate_gradient(nothing, to_the_end).end, GradientEnd::indefinite);

    PlainSystem preconditioner(laplacian_of_chain(3, true), {1, 2, 3});
    preconditioner.inverse = [](const Numbers& r) { return Numbers{-r[0], -r[1], -r[2]}; };
    EXPECT_EQ(conjugate_gradient(preconditioner, to_the_end).end, GradientEnd::indefinite);
}

TEST(ConjugateGradient, NothingOnTheRightLeavesNothing) {
    for (const GradientLimits limits : {to_the_end, GradientLimits{}}) {
        PlainSystem system(laplacian_of_chain(5, true), Numbers(5, 0.0));
        const GradientResult result = conjugate_gradient(system, limits);
        EXPECT_EQ(result.end, GradientEnd::converged);
        EXPECT_EQ(result.iterations, 0);
        EXPECT_EQ(system.products, 0);
        EXPECT_EQ(system.x, Numbers(5, 0.0));
    }
}

TEST(ConjugateGradient, AnEmptySystemIsSolved) {
    PlainSystem system(DenseMatrix(0), {});
    EXPECT_EQ(conjugate_gradient(system, to_the_end).end, GradientEnd::converged);
}

TEST(ConjugateGradient, ASolutionToBeginWithStays) {
    const Numbers solution{1, -2, 3, -4, 5};
    PlainSystem system(laplacian_of_chain(5, true), laplacian_of_chain(5, true).times(solution));
    system.x = solution;
    const GradientResult result = conjugate_gradient(system, to_the_end);
    EXPECT_EQ(result.end, GradientEnd::converged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_EQ(system.x, solution);
}

TEST(ConjugateGradient, LimitOfIterationsIsReported) {
    Random random(3);
    const Numbers solution = random_vector(50, random);
    const DenseMatrix a = laplacian_of_chain(50, true);
    double error = infinity;
    for (const int limit : {0, 1, 5, 20}) {
        PlainSystem system(a, a.times(solution));
        const GradientResult result = conjugate_gradient(system, {.iterations = limit, .relative = 1e-26});
        EXPECT_EQ(result.end, GradientEnd::iteration_limit);
        EXPECT_EQ(result.iterations, limit);
        EXPECT_EQ(system.products, limit);
        EXPECT_LT(system.energy_of_error(solution), error) << limit;
        error = system.energy_of_error(solution);
        if (limit == 0) {
            EXPECT_EQ(system.x, Numbers(50, 0.0));
        }
    }
    // One that ends with its last iteration has converged.
    PlainSystem system(diagonal_of({2, 3}), {2, 3});
    system.use_diagonal();
    EXPECT_EQ(conjugate_gradient(system, {.iterations = 1, .relative = 1e-26}).end, GradientEnd::converged);
}

TEST(ConjugateGradient, EachDifferentEigenvalueTakesAnIteration) {
    const DenseMatrix a = diagonal_of({1, 4, 1, 9, 4, 4, 9, 1, 1});
    const Numbers solution{1, 2, 3, 4, 5, 6, 7, 8, 9};
    PlainSystem plain(a, a.times(solution)), scaled(a, a.times(solution));
    EXPECT_EQ(conjugate_gradient(plain, to_the_end).iterations, 3);
    EXPECT_LT(largest_difference(plain.x, solution), 1e-13);
    scaled.use_diagonal();
    EXPECT_EQ(conjugate_gradient(scaled, to_the_end).iterations, 1);
    EXPECT_LT(largest_difference(scaled.x, solution), 1e-14);
}

TEST(ConjugateGradient, SolvesLaplacians) {
    Random random(4);
    for (const DenseMatrix& a : {laplacian_of_chain(1, true), laplacian_of_chain(2, true), laplacian_of_chain(40, true),
                                 laplacian_of_square(3), laplacian_of_square(12)}) {
        const Numbers solution = random_vector(a.size, random);
        PlainSystem system(a, a.times(solution));
        system.x = random_vector(a.size, random);
        const GradientResult result = conjugate_gradient(system, to_the_end);
        EXPECT_EQ(result.end, GradientEnd::converged) << a.size;
        EXPECT_LE(result.iterations, static_cast<int>(a.size) + 5);
        EXPECT_LT(largest_difference(system.x, solution), 1e-10) << a.size;
    }
}

// ‖e_k‖ <= 2 ((√κ − 1) / (√κ + 1))ᵏ ‖e_0‖ in A's norm, κ the ratio of the extreme eigenvalues (Saad, 6.11.3).
TEST(ConjugateGradient, ConvergesAsFastAsChebyshevSays) {
    constexpr std::size_t size = 200;
    constexpr double condition = 100;
    Numbers eigenvalues(size);
    for (std::size_t i = 0; i < size; ++i) eigenvalues[i] = 1 + (condition - 1) * static_cast<double>(i) / (size - 1);
    const DenseMatrix a = diagonal_of(eigenvalues);
    Random random(5);
    const Numbers solution = random_vector(size, random);
    const double first = PlainSystem(a, a.times(solution)).energy_of_error(solution);
    const double ratio = (std::sqrt(condition) - 1) / (std::sqrt(condition) + 1);
    double last = first;
    for (int k = 1; k <= 60; ++k) {
        PlainSystem system(a, a.times(solution));
        conjugate_gradient(system, {.iterations = k});
        const double error = system.energy_of_error(solution);
        EXPECT_LE(std::sqrt(error), 2 * std::pow(ratio, k) * std::sqrt(first)) << k;
        EXPECT_LT(error, last) << k;
        last = error;
    }
}

TEST(ConjugateGradient, SolvesRandomSystemsAsEliminationDoes) {
    Random random(6);
    for (int iteration = 0; iteration < 40; ++iteration) {
        const std::size_t size = 1 + random.below(30);
        const DenseMatrix a = random_positive_definite(size, 0.5, random);
        const Numbers b = random_vector(size, random), expected = a.solve(b);
        PlainSystem plain(a, b), diagonal(a, b), whole(a, b), other(a, b);
        diagonal.use_diagonal();
        whole.inverse = [&](const Numbers& r) { return a.solve(r); };
        const DenseMatrix m = random_positive_definite(size, 2, random);
        other.inverse = [&](const Numbers& r) { return m.solve(r); };
        for (PlainSystem* system : {&plain, &diagonal, &whole, &other}) {
            const GradientResult result = conjugate_gradient(*system, to_the_end);
            EXPECT_EQ(result.end, GradientEnd::converged) << iteration;
            EXPECT_LT(largest_difference(system->x, expected), 1e-9) << iteration << " " << result.iterations;
        }
        PlainSystem again(a, b);
        again.inverse = whole.inverse;
        EXPECT_EQ(conjugate_gradient(again, {.iterations = 10, .relative = 1e-20}).iterations, 1) << iteration;
    }
}

TEST(ConjugateGradient, SingularSystemsAreSolvedWhereTheyCanBe) {
    Random random(7);
    Numbers solution = random_vector(30, random);
    const DenseMatrix a = laplacian_of_chain(30, false);
    PlainSystem system(a, a.times(solution));
    EXPECT_EQ(conjugate_gradient(system, {.iterations = 100, .relative = 1e-24}).end, GradientEnd::converged);
    // What all have alike is as it was: none.
    const double mean = std::accumulate(solution.begin(), solution.end(), 0.0) / 30;
    for (double& value : solution) value -= mean;
    EXPECT_LT(largest_difference(system.x, solution), 1e-10);

    PlainSystem impossible(a, Numbers(30, 1.0));
    EXPECT_EQ(conjugate_gradient(impossible, to_the_end).end, GradientEnd::indefinite);
    EXPECT_EQ(impossible.x, Numbers(30, 0.0));
}

TEST(ConjugateGradient, WhatIsFilteredOutKeepsItsValue) {
    Random random(8);
    const DenseMatrix a = random_positive_definite(12, 1, random);
    const std::vector<std::size_t> fixed{0, 5, 11};
    PlainSystem system(a, random_vector(12, random));
    system.x = random_vector(12, random);
    const Numbers start = system.x;
    system.inverse = [&](const Numbers& r) {
        Numbers z = r;
        for (const std::size_t i : fixed) z[i] = 0;
        return z;
    };
    EXPECT_EQ(conjugate_gradient(system, to_the_end).end, GradientEnd::converged);
    // The same by elimination, with rows that say so.
    DenseMatrix held = a;
    Numbers right = system.b;
    for (const std::size_t i : fixed) {
        for (std::size_t c = 0; c < 12; ++c) held.at(i, c) = c == i ? 1 : 0;
        right[i] = start[i];
        EXPECT_EQ(system.x[i], start[i]);
    }
    EXPECT_LT(largest_difference(system.x, held.solve(right)), 1e-10);
}

TEST(ConjugateGradient, EndsWithTheFirstResidualWithinTheLimits) {
    Random random(9);
    const DenseMatrix a = laplacian_of_square(8);
    const Numbers b = random_vector(64, random);
    const double first = dot_product(b, b);
    for (const GradientLimits limits : {GradientLimits{200, 0, 1e-4}, GradientLimits{200, 1e-3, 0},
                                        GradientLimits{200, 1e-9, 1e-4}, GradientLimits{200, 1e-3, 1e-12}}) {
        PlainSystem system(a, b), shorter(a, b);
        const GradientResult result = conjugate_gradient(system, limits);
        const double enough = std::max(limits.absolute, limits.relative * first);
        ASSERT_EQ(result.end, GradientEnd::converged);
        ASSERT_GT(result.iterations, 1);
        EXPECT_LE(dot_product(system.r, system.r), enough);
        conjugate_gradient(shorter, {.iterations = result.iterations - 1});
        EXPECT_GT(dot_product(shorter.r, shorter.r), enough);
    }
}

}  // namespace
}  // namespace embody::physics::linear
