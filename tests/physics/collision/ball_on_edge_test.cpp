// SPDX-License-Identifier: MIT
// A ball is on an edge where its normal leans from every face by more than the bend of a smooth surface: there nothing
// carries the corners of the grain that it stands for (docs/physics/grains.md).
#include <algorithm>
#include <array>

#include "physics/collision/collision_probe.h"
#include "physics/collision/queries/ball_touch.h"

namespace embody::physics::collision {
namespace {

constexpr double radius = 0.05, sunk = 1e-4;

/// A ball that touches a place, the normal there, and the cosine by which that leans from the nearest face.
struct Place {
    Vec3 point, normal;
    double cosine = 0;
};

void expect_told(const std::vector<const CollisionShape*>& grounds, const Place& place, Random& random, int& on_edge) {
    const double smooth = std::cos(smooth_edge_angle);
    if (std::fabs(place.cosine - smooth) < 1e-3) return;
    const bool leans = place.cosine < smooth;
    on_edge += leans ? 1 : 0;
    const auto ball = make_shape(SphereShape{radius});
    const Transform pose{{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)},
                         random_rotation(random)};
    const Vec3 center = transform_point(pose, place.point + place.normal * (radius - sunk));
    for (const CollisionShape* ground : grounds) {
        for (const bool is_first : {true, false}) {
            const auto manifolds = is_first ? contacts(*ball, {center, {}}, *ground, pose, 0)
                                            : contacts(*ground, pose, *ball, {center, {}}, 0);
            ASSERT_EQ(manifolds.size(), 1u);
            EXPECT_EQ(manifolds[0].is_on_edge, leans) << "cosine " << place.cosine;
        }
    }
}

// Twelve triangles; a corner's bits are the signs of its coordinates.
MeshShape box_mesh(Vec3 half) {
    MeshShape mesh;
    for (const Vec3& corner : corner_points(half)) mesh.positions.push_back(to_vec3f(corner));
    for (const auto& [a, b, c, d] : {std::array{0u, 4u, 6u, 2u},
                                     {1u, 3u, 7u, 5u},
                                     {0u, 1u, 5u, 4u},
                                     {2u, 6u, 7u, 3u},
                                     {0u, 2u, 3u, 1u},
                                     {4u, 5u, 7u, 6u}}) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

TEST(BallOnEdge, of_boxes_hulls_and_meshes_where_the_normal_leans_from_every_face) {
    Random random(9);
    const auto side = [&] { return random.between(0, 1) < 0.5 ? -1.0 : 1.0; };
    int on_edge = 0;
    constexpr int places = 300;
    for (int i = 0; i < places; ++i) {
        const std::array half{random.between(0.1, 0.5), random.between(0.1, 0.5), random.between(0.1, 0.5)};
        const Vec3 size{half[0], half[1], half[2]};
        std::array<double, 3> at{}, towards{};
        const int faces = 1 + i % 3, first = i / 3 % 3;  // a face, an edge, a corner
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>((first + k) % 3);
            const double sign = side();
            at[axis] = half[axis] * (k < faces ? sign : random.between(-0.9, 0.9));
            if (k < faces) towards[axis] = sign * random.between(0.01, 1);
        }
        const Vec3 normal = normalized(Vec3{towards[0], towards[1], towards[2]});
        const Place place{
            {at[0], at[1], at[2]}, normal, std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)})};
        const auto box = make_shape(BoxShape{size}), hull = make_shape(HullShape{corner_points(size)}),
                   mesh = make_shape(box_mesh(size));
        expect_told({box.get(), hull.get(), mesh.get()}, place, random, on_edge);
    }
    EXPECT_GT(on_edge, places / 4);
    EXPECT_LT(on_edge, places * 3 / 4);
}

TEST(BallOnEdge, of_cylinders_on_the_rim_alone) {
    Random random(10);
    int on_edge = 0;
    constexpr int places = 100;
    for (int i = 0; i < places; ++i) {
        const CylinderShape shape{random.between(0.1, 0.5), random.between(0.1, 0.5)};
        const double lean = random.between(0, 1.57), around = random.between(-3, 3);
        const Vec3 outwards{std::cos(around), 0, std::sin(around)};
        const Vec3 normal = outwards * std::sin(lean) + Vec3{0, std::cos(lean), 0};
        const auto cylinder = make_shape(shape);
        const Place place{outwards * shape.radius + Vec3{0, shape.half_height, 0}, normal,
                          std::max(std::sin(lean), std::cos(lean))};
        expect_told({cylinder.get()}, place, random, on_edge);
    }
    EXPECT_GT(on_edge, places / 4);
}

TEST(BallOnEdge, never_of_what_has_none) {
    Random random(11);
    int on_edge = 0;
    const auto ball = make_shape(SphereShape{0.2}), capsule = make_shape(CapsuleShape{0.2, 0.3});
    for (int i = 0; i < 50; ++i) {
        const Vec3 normal = random_direction(random);
        expect_told({ball.get()}, {normal * 0.2, normal, 1}, random, on_edge);
        const Vec3 middle{0, normal.y > 0 ? 0.3 : -0.3, 0};
        expect_told({capsule.get()}, {middle + normal * 0.2, normal, 1}, random, on_edge);
    }
    EXPECT_EQ(on_edge, 0);
}

}  // namespace
}  // namespace embody::physics::collision
