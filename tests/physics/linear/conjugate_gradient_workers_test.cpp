// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "foundation/task_pool.h"
#include "physics/linear/conjugate_gradient.h"
#include "physics/linear/dense_matrix.h"

namespace embody::physics::linear {
namespace {

using Numbers = std::vector<double>;

/// A chain that workers share by blocks; sums are taken block by block.
struct SharedChain {
    static constexpr std::size_t blocks = 7, block_size = 11, size = blocks * block_size;
    Numbers b, x = Numbers(size, 0.0), r = x, z = x, p = x, q = x;
    std::array<double, blocks> sums{};
    Barrier barrier;

    SharedChain(Numbers right, int workers) : b(std::move(right)), barrier(workers) {}
};
struct WorkerOfChain {
    SharedChain& of;
    std::size_t first, last;

    template <class Work>
    double sum_over_blocks(const Work& work) {
        for (std::size_t block = first; block < last; ++block)
            of.sums[block] = work(block * SharedChain::block_size, (block + 1) * SharedChain::block_size);
        of.barrier.wait();
        const double sum = std::accumulate(of.sums.begin(), of.sums.end(), 0.0);
        of.barrier.wait();
        return sum;
    }
    // The diagonal grows along the chain.
    static double row_times(const Numbers& x, std::size_t i) {
        const double left = i > 0 ? x[i - 1] : 0, right = i + 1 < x.size() ? x[i + 1] : 0;
        return (2 + 0.1 * static_cast<double>(i)) * x[i] - left - right;
    }
    GradientResidual precondition(std::size_t from, std::size_t to, double& sum) {
        for (std::size_t i = from; i < to; ++i)
            sum += of.r[i] * (of.z[i] = of.r[i] / (2 + 0.1 * static_cast<double>(i)));
        return {sum, sum};
    }
    GradientResidual begin() {
        const double sum = sum_over_blocks([&](std::size_t from, std::size_t to) {
            double own = 0;
            for (std::size_t i = from; i < to; ++i) of.r[i] = of.b[i] - row_times(of.x, i);
            return precondition(from, to, own).product;
        });
        return {sum, sum};
    }
    void turn(double beta) {
        sum_over_blocks([&](std::size_t from, std::size_t to) {
            for (std::size_t i = from; i < to; ++i) of.p[i] = of.z[i] + beta * of.p[i];
            return 0.0;
        });
    }
    double multiply() {
        return sum_over_blocks([&](std::size_t from, std::size_t to) {
            double own = 0;
            for (std::size_t i = from; i < to; ++i) own += of.p[i] * (of.q[i] = row_times(of.p, i));
            return own;
        });
    }
    GradientResidual advance(double alpha) {
        const double sum = sum_over_blocks([&](std::size_t from, std::size_t to) {
            double own = 0;
            for (std::size_t i = from; i < to; ++i) {
                of.x[i] += alpha * of.p[i];
                of.r[i] -= alpha * of.q[i];
            }
            return precondition(from, to, own).product;
        });
        return {sum, sum};
    }
};

TEST(ConjugateGradient, WorkersSideBySideComeToTheSameBits) {
    Random random(10);
    const Numbers b = random_vector(SharedChain::size, random);
    const auto solve = [&](int workers) {
        SharedChain chain(b, workers);
        TaskPool pool(workers);
        std::vector<int> iterations(static_cast<std::size_t>(workers));
        pool.run([&](int worker) {
            const auto own = static_cast<std::size_t>(worker), count = static_cast<std::size_t>(workers);
            WorkerOfChain system{chain, SharedChain::blocks * own / count, SharedChain::blocks * (own + 1) / count};
            const GradientResult result = conjugate_gradient(system, {.iterations = 100, .relative = 1e-20});
            iterations[own] = result.end == GradientEnd::converged ? result.iterations : -1;
        });
        for (const int own : iterations) EXPECT_EQ(own, iterations[0]);
        EXPECT_GT(iterations[0], 3);
        return chain.x;
    };
    const Numbers alone = solve(1);
    EXPECT_EQ(solve(2), alone);
    EXPECT_EQ(solve(3), alone);
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_NEAR(WorkerOfChain::row_times(alone, i), b[i], 1e-9);
}

}  // namespace
}  // namespace embody::physics::linear
