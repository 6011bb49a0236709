// SPDX-License-Identifier: MIT
#include "physics/linear/vectors.h"

#include <gtest/gtest.h>

#include <vector>

namespace embody::physics::linear {
namespace {

TEST(Vectors, SumsAndStepsAreThoseOfNumbersOneByOne) {
    for (std::size_t size = 0; size < 12; ++size) {
        std::vector<double> a(size), b(size), x(size), r(size);
        double expected = 0;
        for (std::size_t i = 0; i < size; ++i) {
            // Small whole numbers: exact in any order.
            a[i] = static_cast<double>(i) - 3;
            b[i] = 2 * static_cast<double>(i) + 1;
            x[i] = 10;
            r[i] = static_cast<double>(i);
            expected += a[i] * b[i];
        }
        EXPECT_EQ(dot_product(a, b), expected) << size;
        step_along(2, a, b, x, r);
        std::vector<double> p = a;
        turn_direction(-3, b, p);
        for (std::size_t i = 0; i < size; ++i) {
            EXPECT_EQ(x[i], 10 + 2 * a[i]);
            EXPECT_EQ(r[i], static_cast<double>(i) - 2 * b[i]);
            EXPECT_EQ(p[i], b[i] - 3 * a[i]);
        }
    }
}

}  // namespace
}  // namespace embody::physics::linear
