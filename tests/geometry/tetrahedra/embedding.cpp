// SPDX-License-Identifier: MIT
#include "geometry/tetrahedra/embedding.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/sample_meshes.h"
#include "geometry/tetrahedra/fill.h"

namespace embody::geometry {
namespace {

struct Drawn {
    TriangleMesh drawn;
    TetrahedralMesh mesh;
    std::vector<EmbeddedPoint> points;
};

// A ball embedded in its tetrahedra, with a rod that sticks out.
Drawn make_drawn() {
    Drawn made;
    made.drawn = make_sphere(0.2);
    made.mesh = fill_with_tetrahedra(made.drawn, {.tetrahedra = 500}).value().mesh;
    append(made.drawn, make_box({0.4, 0.01, 0.01}));
    made.points = embed(made.drawn.positions, made.mesh).value();
    return made;
}

TEST(Embedding, ReproducesThePositions) {
    const Drawn made = make_drawn();
    ASSERT_EQ(made.points.size(), made.drawn.positions.size());
    for (std::size_t i = 0; i < made.points.size(); ++i) {
        const auto& w = made.points[i].weights;
        EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-12);
        EXPECT_LT(distance(position(made.points[i], made.mesh, made.mesh.nodes), to_vec3(made.drawn.positions[i])),
                  1e-12);
    }
}

TEST(Embedding, FollowsAnAffineMap) {
    const Drawn made = make_drawn();
    const Mat3 map{{1.5, 0.2, 0}, {-0.3, 0.7, 0.1}, {0.4, 0, 1.1}};
    const Vec3 shift{3, -1, 2};
    std::vector<Vec3> nodes;
    for (const Vec3 node : made.mesh.nodes) nodes.push_back(map * node + shift);
    for (std::size_t i = 0; i < made.points.size(); ++i) {
        const Vec3 expected = map * to_vec3(made.drawn.positions[i]) + shift;
        EXPECT_LT(distance(position(made.points[i], made.mesh, nodes), expected), 1e-12);
    }
}

TEST(Embedding, APlaceWithinHasNoNegativeWeight) {
    const TetrahedralMesh mesh = fill_with_tetrahedra(make_box({0.5, 0.5, 0.5}), {.tetrahedra = 1000}).value().mesh;
    std::vector<Vec3f> places;
    for (const Tetrahedron& t : mesh.tetrahedra) {
        places.push_back(to_vec3f((mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]] + mesh.nodes[t[3]]) / 4));
    }
    const auto points = embed(places, mesh).value();
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(points[i].tetrahedron, i);
        for (const double w : points[i].weights) EXPECT_NEAR(w, 0.25, 1e-4);
    }
}

TEST(Embedding, WorksOnThingsOfAMillimetre) {
    const TriangleMesh ball = make_sphere(5e-4);
    const TetrahedralMesh mesh = fill_with_tetrahedra(ball, {.tetrahedra = 20000}).value().mesh;
    const auto points = embed(ball.positions, mesh).value();
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT(distance(position(points[i], mesh, mesh.nodes), to_vec3(ball.positions[i])), 1e-15);
    }
}

TEST(Embedding, RefusesWhatCannotBeCarried) {
    EXPECT_FALSE(embed({{0, 0, 0}}, {}).ok());
    const TetrahedralMesh mesh = fill_with_tetrahedra(make_box({1, 1, 1})).value().mesh;
    const auto refused = embed({{0, 0, 0}, {std::numeric_limits<float>::infinity(), 0, 0}}, mesh);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().where, "embedding: positions[1]");
}

}  // namespace
}  // namespace embody::geometry
