// SPDX-License-Identifier: MIT
#include "physics/deformable/cloth/anderson_mixing.h"

#include <gtest/gtest.h>

#include "foundation/random.h"

namespace embody::physics::deformable {
namespace {

// A linear map of n numbers comes to its fixed point with n + 1 errors, whether its iteration converges or not.
TEST(AndersonMixing, FindsTheFixedPointOfALinearMap) {
    Random random(5);
    for (int trial = 0; trial < 20; ++trial) {
        constexpr std::size_t nodes = 2;
        double matrix[6][6];
        std::vector<double> fixed(6);
        for (std::size_t i = 0; i < 6; ++i) {
            fixed[i] = random.between(-1, 1);
            for (std::size_t k = 0; k < 6; ++k) matrix[i][k] = (i == k ? 1.5 : 0) + random.between(-0.2, 0.2);
        }
        std::vector<Vec3> x(nodes), weight(nodes, Vec3{1, 2, 3});
        const auto error_of = [&](const std::vector<Vec3>& at) {
            std::vector<Vec3> error(nodes);
            for (std::size_t i = 0; i < 6; ++i) {
                double sum = 0;
                for (std::size_t k = 0; k < 6; ++k)
                    sum += matrix[i][k] * (fixed[k] - at[k / 3][static_cast<int>(k % 3)]);
                error[i / 3][static_cast<int>(i % 3)] = sum;
            }
            return error;
        };
        const double before = length(error_of(x)[0]) + length(error_of(x)[1]);
        AndersonMixing mixing;
        for (int i = 0; i < 8; ++i) x = mixing.next(x, error_of(x), weight);
        EXPECT_LT(length(error_of(x)[0]) + length(error_of(x)[1]), 1e-3 * before);
    }
}

}  // namespace
}  // namespace embody::physics::deformable
