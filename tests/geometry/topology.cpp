// SPDX-License-Identifier: MIT
#include "geometry/topology.h"

#include <gtest/gtest.h>

#include "foundation/random.h"
#include "geometry/mass_properties.h"
#include "geometry/sample_meshes.h"

namespace embody::geometry {
namespace {

TEST(Weld, EmptyMeshStaysEmpty) {
    EXPECT_TRUE(weld({}, 1e-6).triangles.empty());
    EXPECT_FALSE(is_closed({}));
    EXPECT_EQ(find_topology({}).component_count, 0u);
}

TEST(Weld, SoupBecomesTheMeshAgain) {
    for (const double tolerance : {0.0, 1e-6}) {
        const TriangleMesh box = weld(make_soup(make_box({1, 2, 3})), tolerance);
        EXPECT_EQ(box.positions.size(), 8u);
        EXPECT_EQ(box.triangles.size(), 12u);
    }
}

TEST(Weld, NegativeZeroEqualsZero) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    EXPECT_EQ(weld(mesh, 0).positions.size(), 4u);
}

TEST(Weld, ClosesGapsUpToTheToleranceOnly) {
    TriangleMesh soup = make_soup(make_torus(2, 0.5));
    Random random(2);
    for (Vec3f& p : soup.positions) p.x += float(random.between(-1e-5, 1e-5));
    EXPECT_FALSE(find_topology(weld(soup, 1e-7)).is_closed());
    EXPECT_TRUE(find_topology(weld(soup, 1e-4)).is_closed());
}

TEST(Weld, DropsDegenerateAndCopiedTriangles) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({2, 3, 0});  // the first triangle, beginning at another corner
    mesh.triangles.push_back({0, 3, 2});  // the first triangle, reversed
    EXPECT_EQ(weld(mesh, 0).triangles.size(), 12u);
}

TEST(Topology, PoleTrianglesOfASphereVanishAndItIsClosed) {
    const TriangleMesh sphere = weld(make_sphere(1, 16, 8), 1e-6);
    const Topology topology = find_topology(sphere);
    EXPECT_TRUE(topology.is_closed());
    EXPECT_EQ(sphere.positions.size() + sphere.triangles.size(), topology.edge_count + 2);
}

TEST(Topology, OpenBoxHasFourBoundaryEdges) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.triangles.resize(10);
    EXPECT_EQ(find_topology(mesh).boundary_edges, 4u);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(Topology, InconsistentAndCrowdedEdgesAreNotClosed) {
    TriangleMesh mesh = make_box({1, 1, 1});
    std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
    EXPECT_EQ(find_topology(mesh).inconsistent_edges, 3u);
    EXPECT_FALSE(is_closed(mesh));
    mesh = make_box({1, 1, 1});
    mesh.triangles.push_back({0, 3, 7});
    EXPECT_EQ(find_topology(mesh).crowded_edges, 2u);
    EXPECT_FALSE(is_closed(mesh));
}

TEST(Topology, ComponentsAreNumberedByFirstTriangle) {
    TriangleMesh mesh = make_box({1, 1, 1});
    append(mesh, make_box({1, 1, 1}, {5, 0, 0}));
    append(mesh, make_box({1, 1, 1}, {-5, 0, 0}));
    const Topology topology = find_topology(mesh);
    ASSERT_EQ(topology.component_count, 3u);
    EXPECT_EQ(topology.component_of[0], 0u);
    EXPECT_EQ(topology.component_of[35], 2u);
    const auto parts = split_components(mesh, topology);
    EXPECT_NEAR(integrate_polyhedron(parts[2]).center.x, -5, 1e-12);
    EXPECT_EQ(parts[2].positions.size(), 8u);
}

TEST(OrientedOutwards, CorrectsRandomlyReversedTriangles) {
    TriangleMesh mesh = weld(make_torus(2, 0.5), 1e-6);
    append(mesh, make_box({1, 1, 1}, {9, 0, 0}));
    const double volume = integrate_polyhedron(mesh).volume;
    Random random(4);
    for (auto& t : mesh.triangles) {
        if (random.below(2) == 0) std::swap(t[0], t[1]);
    }
    const TriangleMesh mended = oriented_outwards(mesh);
    EXPECT_TRUE(find_topology(mended).is_closed());
    EXPECT_NEAR(integrate_polyhedron(mended).volume, volume, 1e-9);
}

TEST(OrientedOutwards, MoebiusStripStaysInconsistentAndEnds) {
    TriangleMesh mesh;
    constexpr std::uint32_t n = 20;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double u = 2 * pi * i / n;
        for (const double s : {-0.3, 0.3}) {
            const double r = 1 + s * std::cos(u / 2);
            mesh.positions.push_back(to_vec3f({r * std::cos(u), s * std::sin(u / 2), r * std::sin(u)}));
        }
        const std::uint32_t a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
    }
    EXPECT_GT(find_topology(oriented_outwards(mesh)).inconsistent_edges, 0u);
}

}  // namespace
}  // namespace embody::geometry
