// SPDX-License-Identifier: MIT
#include "math/kernel_width.h"

#include <gtest/gtest.h>

namespace embody {
namespace {

struct WidthKernels {
    int width;
    static const WidthKernels lanes_4, lanes_8, lanes_16;
};
constinit const WidthKernels WidthKernels::lanes_4{4}, WidthKernels::lanes_8{8}, WidthKernels::lanes_16{16};

TEST(KernelWidth, WidthsThatWereNotCompiledAreRefused) {
    for (const int lanes : {-4, 0, 1, 2, 5, 12, 32, 64}) {
        EXPECT_FALSE(has_lanes(lanes)) << lanes;
        EXPECT_EQ(kernels_of<WidthKernels>(lanes), nullptr) << lanes;
    }
}

TEST(KernelWidth, EveryProcessorSupportsFour) {
    EXPECT_TRUE(has_lanes(4));
    ASSERT_NE(kernels_of<WidthKernels>(4), nullptr);
}

TEST(KernelWidth, KernelsAreThoseOfTheWidth) {
    int widest = 0;
    for (const int lanes : {4, 8, 16}) {
        const WidthKernels* kernels = kernels_of<WidthKernels>(lanes);
        EXPECT_EQ(kernels != nullptr, has_lanes(lanes)) << lanes;
        if (kernels == nullptr) continue;
        EXPECT_EQ(kernels->width, lanes);
        widest = lanes;
    }
    EXPECT_EQ(widest_kernels<WidthKernels>().width, widest);
}

}  // namespace
}  // namespace embody
