// SPDX-License-Identifier: MIT
#include "physics/linear/column_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "foundation/random.h"
#include "math/kernel_width.h"

namespace embody::physics::linear {
namespace {

std::vector<float> numbers(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<float> all(count);
    for (float& value : all) value = static_cast<float>(random.between(-1, 1));
    return all;
}

/// The nine rows of each node's compliance, of a symmetric matrix: element (r, c) of the block (i, j) is at
/// (9 j + 3 c + r) stride + i.
struct Symmetric {
    std::vector<float> compliance;
    std::size_t stride;

    Symmetric(std::size_t nodes, std::uint64_t seed) : compliance(9 * nodes * nodes), stride(nodes) {
        Random random(seed);
        for (std::size_t i = 0; i < nodes; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                for (std::size_t k = 0; k < 9; ++k) {
                    const auto value = static_cast<float>(random.between(-1, 1));
                    at(i, j, k % 3, k / 3) = value;
                    at(j, i, k / 3, k % 3) = value;
                }
            }
        }
    }
    float& at(std::size_t i, std::size_t j, std::size_t r, std::size_t c) {
        return compliance[(9 * j + 3 * c + r) * stride + i];
    }
};

/// What each loop makes of the same numbers, one after the other.
std::vector<float> results(const ColumnKernels& kernels) {
    constexpr std::size_t stride = 48, count = 37;
    std::vector<float> moves = numbers(3 * stride, 1), w = numbers(stride, 2), all;
    const std::vector<float> compliance = numbers(9 * stride, 3), columns = numbers(6 * stride, 4);
    const float *a = columns.data(), *b = a + stride, *c = b + stride;
    kernels.add_moves(moves.data(), compliance.data(), stride, 0.3f, -1.7f, 0.9f);
    kernels.subtract_columns(w.data(), a, b, c, stride, 0.1f, 0.7f, -0.4f);
    float sums[3], blocks[9];
    kernels.dot_columns(w.data(), a, b, c, stride, sums);
    kernels.dot_blocks(a, stride, a + 3 * stride, stride, count, blocks);
    const Symmetric all_pairs(stride, 7);
    kernels.add_all_moves(moves.data(), all_pairs.compliance.data(), columns.data(), stride, 0, 3);
    std::vector<double> long_ones(moves.begin(), moves.end());
    const std::vector<double> taken(compliance.begin(), compliance.end());
    kernels.subtract_scaled(long_ones.data(), taken.data(), stride, 8, taken.data() + 40, count);
    for (const auto* part : {&moves, &w}) all.insert(all.end(), part->begin(), part->end());
    all.insert(all.end(), sums, sums + 3);
    all.insert(all.end(), blocks, blocks + 9);
    for (const double value : long_ones) all.push_back(static_cast<float>(value));
    return all;
}

TEST(ColumnKernels, AnyWidthGivesTheSameBits) {
    const std::vector<float> expected = results(*kernels_of<ColumnKernels>(4));
    int widths = 0;
    for (const int lanes : {8, 16}) {
        const ColumnKernels* kernels = kernels_of<ColumnKernels>(lanes);
        if (kernels == nullptr) continue;
        ++widths;
        EXPECT_EQ(results(*kernels), expected) << lanes;
    }
    if (widths == 0) GTEST_SKIP() << "this processor has no registers wider than four floats";
}

TEST(ColumnKernels, MovesOfAllAreThoseOfEachPair) {
    constexpr std::size_t stride = 48, tiles = stride / column_multiple;
    Symmetric matrix(stride, 8);
    const std::vector<float> forces = numbers(3 * stride, 9);
    std::vector<float> moves(3 * stride, 0.0f);
    // In two parts, as two workers would.
    for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>{0, 2}, {2, tiles}})
        widest_kernels<ColumnKernels>().add_all_moves(moves.data(), matrix.compliance.data(), forces.data(), stride,
                                                      first, last);
    for (std::size_t i = 0; i < stride; ++i) {
        for (std::size_t r = 0; r < 3; ++r) {
            double expected = 0;
            for (std::size_t j = 0; j < stride; ++j) {
                for (std::size_t c = 0; c < 3; ++c)
                    expected +=
                        static_cast<double>(matrix.at(i, j, r, c)) * static_cast<double>(forces[c * stride + j]);
            }
            EXPECT_NEAR(moves[r * stride + i], expected, 1e-4) << i << " " << r;
        }
    }
}

TEST(ColumnKernels, SumsAreThoseOfDoubles) {
    constexpr std::size_t stride = 64, count = 61;
    const std::vector<float> a = numbers(3 * stride, 5), b = numbers(3 * stride, 6);
    float blocks[9];
    widest_kernels<ColumnKernels>().dot_blocks(a.data(), stride, b.data(), stride, count, blocks);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            double sum = 0;
            for (std::size_t k = 0; k < count; ++k)
                sum += static_cast<double>(a[i * stride + k]) * static_cast<double>(b[j * stride + k]);
            EXPECT_NEAR(static_cast<double>(blocks[3 * i + j]), sum, 1e-5);
        }
    }
}

}  // namespace
}  // namespace embody::physics::linear
