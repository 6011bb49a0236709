// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/near_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "foundation/random.h"

namespace embody::physics::fluid {
namespace {

Vec3 random_place(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}

// What bounds are within the reach of a point of the way has to be among those that are found, in the order of adding.
TEST(NearTriangles, NoneThatIsInReachIsLeftOut) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        const double reach = random.between(0.02, 0.8), size = random.between(0.01, 1);
        Bounds box;
        for (int i = 0; i < 2; ++i) box.add(random_place(random, 1));
        if (seed % 5 == 0) box.upper.y = box.lower.y;  // flat
        NearTriangles triangles;
        triangles.begin(box, reach);
        std::vector<Bounds> bounds(static_cast<std::size_t>(random.between(1, 80)));
        for (Bounds& each : bounds) {
            const Vec3 middle = random_place(random, 1.5);
            NearTriangle triangle;
            for (Vec3& corner : triangle.corners) each.add(corner = middle + random_place(random, size));
            triangles.add(triangle);
        }
        triangles.finish();
        for (int query = 0; query < 100; ++query) {
            const Vec3 a = random_place(random, 1.2), b = a + random_place(random, 2 * reach);
            const auto around = triangles.around(a), along = triangles.along(a, b);
            EXPECT_TRUE(std::ranges::is_sorted(around));
            EXPECT_TRUE(std::ranges::is_sorted(along));
            for (std::uint32_t i = 0; i < bounds.size(); ++i) {
                if (contains(enlarged(bounds[i], reach), a)) {
                    EXPECT_TRUE(std::ranges::binary_search(around, i)) << seed;
                }
                for (const double part : {0.0, 0.3, 0.5, 1.0}) {
                    if (contains(bounds[i], a + part * (b - a))) {
                        EXPECT_TRUE(std::ranges::binary_search(along, i)) << seed;
                    }
                }
            }
        }
    }
}

TEST(NearTriangles, APointForABoxIsAsked) {
    NearTriangles triangles;
    triangles.begin({{1, 1, 1}, {1, 1, 1}}, 0);
    for (int i = 0; i < 30; ++i) triangles.add({{Vec3{1, 1, 1}, Vec3{2, 1, 1}, Vec3{1, 2, 1}}, {0, 0, 1}});
    triangles.finish();
    EXPECT_EQ(triangles.around({1, 1, 1}).size(), 30u);
}

}  // namespace
}  // namespace embody::physics::fluid
