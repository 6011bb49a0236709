// SPDX-License-Identifier: MIT
// Loops over polytopes give the bits of a plain loop on every width that this processor has, ties and zeros included.
#include "physics/collision/shapes/polytope_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "foundation/random.h"
#include "math/kernel_width.h"

namespace embody::physics::collision {
namespace {

constexpr std::size_t count = 48;

/// Random vectors on a coarse grid, so that many are equal or as far.
struct Vectors {
    std::vector<double> x, y, z;
    std::vector<float> rough_x, rough_y, rough_z;

    explicit Vectors(Random& random) {
        const auto coordinate = [&] { return static_cast<int>(random.below(5)) - 2; };
        for (std::size_t i = 0; i < count; ++i) {
            x.push_back(coordinate());
            y.push_back(coordinate());
            z.push_back(coordinate());
        }
        rough_x.assign(x.begin(), x.end());
        rough_y.assign(y.begin(), y.end());
        rough_z.assign(z.begin(), z.end());
    }
    [[nodiscard]] double along(std::size_t i, const double* d) const { return x[i] * d[0] + y[i] * d[1] + z[i] * d[2]; }
    [[nodiscard]] VectorLanes<double> lanes() const { return {x.data(), y.data(), z.data(), count}; }
    [[nodiscard]] VectorLanes<float> rough_lanes() const {
        return {rough_x.data(), rough_y.data(), rough_z.data(), count};
    }
};

Extreme first_highest(const std::vector<double>& values) {
    const auto highest = std::max_element(values.begin(), values.end());
    return {*highest, static_cast<std::uint32_t>(highest - values.begin())};
}

class PolytopeKernelsOf : public testing::TestWithParam<int> {};

TEST_P(PolytopeKernelsOf, find_what_a_plain_loop_finds) {
    const PolytopeKernels* kernels = kernels_of<PolytopeKernels>(GetParam());
    if (kernels == nullptr) GTEST_SKIP() << "not on this processor";
    Random random(5);
    for (int trial = 0; trial < 200; ++trial) {
        const Vectors vectors(random);
        const double d[3] = {static_cast<double>(random.below(3)) - 1, static_cast<double>(random.below(3)) - 1,
                             0.5 * static_cast<double>(random.below(3))};
        const float rough_d[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
        std::vector<double> along, reach, heights, bounds, lowered;
        std::vector<std::uint32_t> low;
        for (std::size_t i = 0; i < count; ++i) {
            along.push_back(vectors.along(i, d));
            reach.push_back(static_cast<double>(random.below(3)));
            heights.push_back(along[i] - reach[i]);
            bounds.push_back(static_cast<double>(random.below(4)) - 2);
            lowered.push_back(std::min(bounds[i], heights[i]));
            if (along[i] <= 0.5) low.push_back(static_cast<std::uint32_t>(i));
        }

        const Extreme farthest = kernels->farthest(vectors.lanes(), d);
        EXPECT_EQ(farthest.along, first_highest(along).along);
        EXPECT_EQ(farthest.index, first_highest(along).index);
        const Extent extent = kernels->extent(vectors.lanes(), d);
        EXPECT_EQ(extent.lowest, *std::min_element(along.begin(), along.end()));
        EXPECT_EQ(extent.highest, farthest.along);
        EXPECT_EQ(kernels->farthest_roughly(vectors.rough_lanes(), rough_d), first_highest(along).index);

        std::vector<double> found_heights(count);
        EXPECT_EQ(kernels->heights_over_faces(vectors.lanes(), reach.data(), d, found_heights.data()),
                  first_highest(heights).along);
        EXPECT_EQ(found_heights, heights);
        const Extreme bound = kernels->lower_bounds(vectors.lanes(), reach.data(), d, bounds.data());
        EXPECT_EQ(bound.along, first_highest(lowered).along);
        EXPECT_EQ(bound.index, first_highest(lowered).index);
        EXPECT_EQ(bounds, lowered);

        std::vector<std::uint32_t> found(count);
        found.resize(kernels->find_low(vectors.lanes(), d, 0.5, found.data()));
        EXPECT_EQ(found, low);
    }
}

TEST_P(PolytopeKernelsOf, find_nothing_among_no_vectors) {
    const PolytopeKernels* kernels = kernels_of<PolytopeKernels>(GetParam());
    if (kernels == nullptr) GTEST_SKIP() << "not on this processor";
    const double d[3] = {1, 0, 0};
    EXPECT_EQ(kernels->farthest({nullptr, nullptr, nullptr, 0}, d).along, -1e300);
}

INSTANTIATE_TEST_SUITE_P(EachWidth, PolytopeKernelsOf, testing::Values(4, 8, 16));

}  // namespace
}  // namespace embody::physics::collision
