// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/body_centred_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "foundation/random.h"

namespace embody::geometry {
namespace {

TEST(BodyCentredGrid, FillsABoxExactly) {
    Random random(7);
    for (int i = 0; i < 30; ++i) {
        std::array<int, 3> cells{};
        for (int& count : cells) count = 1 + static_cast<int>(random.below(5));
        const Vec3 half{random.between(0.1, 2), random.between(0.1, 2), random.between(0.1, 2)};
        const TetrahedralMesh mesh = body_centred_grid(cells, [&](Vec3 p) { return scale(half, p); });
        EXPECT_EQ(mesh.tetrahedra.size(), grid_tetrahedra(cells));
        for (const Tetrahedron& t : mesh.tetrahedra) ASSERT_GT(signed_volume(mesh, t), 0);
        EXPECT_NEAR(volume(mesh) / (8 * half.x * half.y * half.z), 1, 1e-12);
        // Its surface is the box's: closed, of four triangles a face, with Euler's number of a ball.
        const auto face = [&](int a, int b) {
            return cells[static_cast<std::size_t>(a)] * cells[static_cast<std::size_t>(b)];
        };
        EXPECT_EQ(mesh.surface.size(), static_cast<std::size_t>(8 * (face(0, 1) + face(1, 2) + face(2, 0))));
        std::set<std::uint32_t> corners;
        for (const auto& triangle : mesh.surface) corners.insert(triangle.begin(), triangle.end());
        EXPECT_EQ(2 * corners.size(), mesh.surface.size() + 4);
        for (const std::uint32_t node : corners) {
            const Vec3 p = mesh.nodes[node];
            EXPECT_NEAR(std::max({std::abs(p.x / half.x), std::abs(p.y / half.y), std::abs(p.z / half.z)}), 1, 1e-12);
        }
    }
}

TEST(BodyCentredGrid, IsItsOwnMirrorImage) {
    const TetrahedralMesh mesh = body_centred_grid({4, 2, 3}, [](Vec3 p) { return p; });
    // Sums over the corners of each tetrahedron, at multiples of 1/12, so that rounding hides none.
    const auto middles = [&](Vec3 mirror) {
        std::multiset<std::array<long, 3>> all;
        for (const Tetrahedron& t : mesh.tetrahedra) {
            Vec3 sum;
            for (const std::uint32_t node : t) sum += scale(mirror, mesh.nodes[node]);
            all.insert({std::lround(12 * sum.x), std::lround(12 * sum.y), std::lround(12 * sum.z)});
        }
        return all;
    };
    for (const Vec3 mirror : {Vec3{-1, 1, 1}, Vec3{1, -1, 1}, Vec3{1, 1, -1}})
        EXPECT_EQ(middles(mirror), middles({1, 1, 1}));
}

}  // namespace
}  // namespace embody::geometry
