// SPDX-License-Identifier: MIT
// What an obstacle is to a fluid, against formulas of simple shapes: distances, shares of cubes, drag, friction.
#include "physics/fluid/obstacles/obstacles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/collision/shapes/collision_shape.h"
#include "physics/fluid/liquid_block.h"
#include "physics/fluid/obstacles/obstacle_probe.h"
#include "physics/fluid/obstacles/obstacle_region.h"
#include "physics/fluid/obstacles/small_body.h"
#include "physics/fluid/obstacles/wall_friction.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {
namespace {

constexpr double h = 0.1;
constexpr double pi = std::numbers::pi;

Vec3 any_point(Random& random, double reach) {
    return {random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
}
Transform any_pose(Random& random) {
    return {any_point(random, 0.2), normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                                                    random.between(-1, 1)})};
}
const Bounds everywhere{{-3, -3, -3}, {3, 3, 3}};

MeshShape mesh_of_box(Vec3 half) {
    MeshShape mesh;
    for (int i = 0; i < 8; ++i) {
        const auto side = [&](int axis) { return static_cast<float>(i >> axis & 1 ? half[axis] : -half[axis]); };
        mesh.positions.push_back({side(0), side(1), side(2)});
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

// Signed distance of a box about the origin, exact inside and out.
double distance_of_box(Vec3 half, Vec3 p) {
    const Vec3 out = abs(p) - half;
    const Vec3 beyond{std::max(out.x, 0.0), std::max(out.y, 0.0), std::max(out.z, 0.0)};
    return length(beyond) + std::min(std::max({out.x, out.y, out.z}), 0.0);
}

TEST(ObstacleProbe, OutOfReachThereIsNothing) {
    const auto shape = CollisionShape::create(SphereShape{0.3}).value();
    ObstacleProbe probe(*shape, {{10, 0, 0}, {}}, {});
    EXPECT_FALSE(probe.look_at({{-1, -1, -1}, {1, 1, 1}}, 0.5));
    EXPECT_EQ(probe.nearest({0, 0, 0}).distance, 0.5);
    EXPECT_FALSE(probe.crossing({0, 0, 0}, {0, 0, 0}));
    float fractions[8] = {};
    probe.add_octants({0, 0, 0}, h, fractions);
    for (const float fraction : fractions) EXPECT_EQ(fraction, 0);
}

TEST(ObstacleProbe, BallsAndCapsulesAreAsFarAsTheirFormulaSays) {
    Random random(1);
    const auto ball = CollisionShape::create(SphereShape{0.3}).value();
    const auto capsule = CollisionShape::create(CapsuleShape{0.2, 0.4}).value();
    for (int trial = 0; trial < 300; ++trial) {
        const Transform pose = any_pose(random);
        const Vec3 p = any_point(random, 1);
        const Vec3 local = transform_point(inverse(pose), p);
        ObstacleProbe near_ball(*ball, pose, {}), near_capsule(*capsule, pose, {});
        ASSERT_TRUE(near_ball.look_at(everywhere, 9) && near_capsule.look_at(everywhere, 9));
        const ObstacleDistance from_ball = near_ball.nearest(p), from_capsule = near_capsule.nearest(p);
        EXPECT_NEAR(from_ball.distance, length(local) - 0.3, 1e-9);
        EXPECT_NEAR(from_capsule.distance, length(local - Vec3{0, std::clamp(local.y, -0.4, 0.4), 0}) - 0.2, 1e-9);
        EXPECT_NEAR(length(from_ball.normal), 1, 1e-9);
        EXPECT_NEAR(dot(from_ball.normal, normalized(p - pose.position)), 1, 1e-9);
    }
}

TEST(ObstacleProbe, BoxesAreExactInsideAndNeverTooFarOutside) {
    Random random(2);
    const Vec3 half{0.3, 0.2, 0.5};
    const auto box = CollisionShape::create(BoxShape{half}).value();
    for (int trial = 0; trial < 500; ++trial) {
        const Transform pose = any_pose(random);
        const Vec3 p = any_point(random, 1), local = transform_point(inverse(pose), p);
        ObstacleProbe probe(*box, pose, {});
        ASSERT_TRUE(probe.look_at(everywhere, 9));
        const double exact = distance_of_box(half, local), found = probe.nearest(p).distance;
        const Vec3 out = abs(local) - half;
        const bool over_face = (out.x > 0) + (out.y > 0) + (out.z > 0) <= 1;
        EXPECT_LE(found, exact + 1e-9);
        EXPECT_EQ(found < 0, exact < 0);
        if (over_face) {
            EXPECT_NEAR(found, exact, 1e-9);
        }
    }
}

TEST(ObstacleProbe, AClosedMeshIsTheSolidThatItEncloses) {
    Random random(3);
    const Vec3 half{0.3, 0.2, 0.5};
    const auto mesh = CollisionShape::create(mesh_of_box(half)).value();
    const auto box = CollisionShape::create(BoxShape{half}).value();
    for (int trial = 0; trial < 300; ++trial) {
        const Transform pose = any_pose(random);
        ObstacleProbe probe(*mesh, pose, {}), solid(*box, pose, {});
        ASSERT_TRUE(probe.look_at(everywhere, 9) && solid.look_at(everywhere, 9));
        EXPECT_TRUE(probe.is_surface());
        EXPECT_FALSE(solid.is_surface());
        const Vec3 p = any_point(random, 1);
        EXPECT_NEAR(probe.nearest(p).distance, distance_of_box(half, transform_point(inverse(pose), p)), 1e-6);
        // A way from outside meets both alike.
        const Vec3 to = any_point(random, 1);
        if (distance_of_box(half, transform_point(inverse(pose), p)) < 0) continue;
        const auto a = probe.crossing(p, to), b = solid.crossing(p, to);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_NEAR(a->fraction, b->fraction, 1e-6);
        EXPECT_NEAR(dot(a->normal, b->normal), 1, 1e-6);
    }
}

TEST(ObstacleProbe, AClosedMeshEnclosesWhatItsSolidHas) {
    Random random(9);
    const Vec3 half{0.3, 0.2, 0.5};
    const auto mesh = CollisionShape::create(mesh_of_box(half)).value();
    MeshShape without_lid = mesh_of_box(half);
    without_lid.triangles.resize(without_lid.triangles.size() - 2);
    const auto open = CollisionShape::create(without_lid).value();
    const auto box = CollisionShape::create(BoxShape{half}).value();
    for (int trial = 0; trial < 300; ++trial) {
        const Transform pose = any_pose(random);
        const Vec3 p = any_point(random, 0.6);
        const bool is_inside = distance_of_box(half, transform_point(inverse(pose), p)) < 0;
        EXPECT_EQ(ObstacleProbe(*mesh, pose, {}).encloses(p), is_inside);
        EXPECT_FALSE(ObstacleProbe(*open, pose, {}).encloses(p));
        EXPECT_FALSE(ObstacleProbe(*box, pose, {}).encloses(p));
    }
}

TEST(ObstacleProbe, APlaneIsAHalfSpace) {
    Random random(4);
    const auto plane = CollisionShape::create(PlaneShape{{0, 2, 0}, 0.1}).value();
    ObstacleProbe probe(*plane, {}, {});
    ASSERT_TRUE(probe.look_at(everywhere, 9));
    EXPECT_NEAR(probe.nearest({3, -0.4, 1}).distance, -0.5, 1e-12);
    EXPECT_NEAR(probe.nearest({3, 0.4, 1}).distance, 0.3, 1e-12);
    EXPECT_FALSE(probe.is_thinner({0, -1, 0}, {0, 1, 0}, 100));
    const auto crossing = probe.crossing({0, 1.1, 0}, {0, -0.9, 0});
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->fraction, 0.5, 1e-9);
    EXPECT_FALSE(probe.look_at({{0, 5, 0}, {1, 6, 1}}, 1));
}

TEST(ObstacleProbe, KnowsHowThinItIs) {
    const auto box = CollisionShape::create(BoxShape{{1, 0.05, 1}}).value();
    for (const auto& shape : {CollisionShape::create(BoxShape{{1, 0.05, 1}}).value().release(),
                              CollisionShape::create(mesh_of_box({1, 0.05, 1})).value().release()}) {
        const std::unique_ptr<CollisionShape> owned(shape);
        ObstacleProbe probe(*owned, {}, {});
        ASSERT_TRUE(probe.look_at(everywhere, 9));
        EXPECT_TRUE(probe.is_thinner({0, 0.03, 0}, {0, 1, 0}, 0.09));
        EXPECT_FALSE(probe.is_thinner({0, 0.03, 0}, {0, 1, 0}, 0.07));
    }
}

TEST(ObstacleProbe, OctantsOfABoxAlongTheAxesAreExact) {
    Random random(5);
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 half{random.between(0.2, 0.4), random.between(0.2, 0.4), random.between(0.2, 0.4)};
        const auto box = CollisionShape::create(BoxShape{half}).value();
        ObstacleProbe probe(*box, {}, {});
        ASSERT_TRUE(probe.look_at(everywhere, 9));
        // Cubes at a face or an edge of it: at most two sides cut.
        Vec3 p = any_point(random, 0.1);
        p.x = half.x + random.between(-h, h) / 2;
        if (trial % 2 == 0) p.z = half.z + random.between(-h, h) / 2;
        float fractions[8] = {};
        probe.add_octants(p, h, fractions);
        for (int octant = 0; octant < 8; ++octant) {
            double wanted = 1;
            for (int a = 0; a < 3; ++a) {
                const double low = p[a] + (octant >> a & 1 ? 0 : -h / 2), high = low + h / 2;
                wanted *= std::clamp(std::min(high, half[a]) - std::max(low, -half[a]), 0.0, h / 2) / (h / 2);
            }
            EXPECT_NEAR(fractions[octant], wanted, 1e-6);
        }
    }
}

TEST(ObstacleProbe, OctantsSumToTheVolume) {
    Random random(6);
    const auto volume_of = [&](const ShapeDefinition& definition) {
        const auto shape = CollisionShape::create(definition).value();
        ObstacleProbe probe(*shape, any_pose(random), {});
        EXPECT_TRUE(probe.look_at(everywhere, 9));
        constexpr double edge = 0.05;
        double sum = 0;
        for (int z = -20; z < 20; ++z) {
            for (int y = -20; y < 20; ++y) {
                for (int x = -20; x < 20; ++x) {
                    const Vec3 p{(x + 0.5) * edge, (y + 0.5) * edge, (z + 0.5) * edge};
                    float fractions[8] = {};
                    probe.add_octants(p, edge, fractions);
                    for (const float fraction : fractions) sum += fraction;
                }
            }
        }
        return sum * edge * edge * edge / 8;
    };
    EXPECT_NEAR(volume_of(BoxShape{{0.3, 0.2, 0.4}}), 0.6 * 0.4 * 0.8, 0.01 * 0.192);
    EXPECT_NEAR(volume_of(SphereShape{0.4}), 4 / 3.0 * pi * 0.064, 0.01 * 0.268);
    EXPECT_NEAR(volume_of(CylinderShape{0.3, 0.4}), pi * 0.09 * 0.8, 0.01 * 0.226);
    EXPECT_NEAR(volume_of(CapsuleShape{0.2, 0.3}), pi * 0.04 * 0.6 + 4 / 3.0 * pi * 0.008, 0.01 * 0.109);
}

struct Water : LiquidBlock {
    explicit Water(std::span<FluidObstacle> met = {}) : LiquidBlock(h, fill_cells(h, {0, 0, 0}, {12, 12, 12}), met) {}
};

TEST(ObstacleRegion, FractionsOfEachDirectionSumToTheVolume) {
    Random random(7);
    Water water;
    for (int trial = 0; trial < 5; ++trial) {
        Transform pose = any_pose(random);
        pose.position = {0.6 + random.between(-h, h), 0.6 + random.between(-h, h), 0.6 + random.between(-h, h)};
        const auto shape = CollisionShape::create(BoxShape{{0.27, 0.31, 0.23}}).value();
        ObstacleProbe probe(*shape, pose, {});
        ObstacleRegion region;
        const Cell lower = water.cell_at({-0.25, -0.25, -0.25}), upper = water.cell_at({1.45, 1.45, 1.45});
        region.begin(water.grid, lower, upper);
        ASSERT_TRUE(region.add(probe));
        region.finish();
        double volume[3] = {}, kernel = 0;
        for (int z = lower[2]; z < upper[2]; ++z) {
            for (int y = lower[1]; y < upper[1]; ++y) {
                for (int x = lower[0]; x < upper[0]; ++x) {
                    const int at = region.index({x, y, z});
                    for (int axis = 0; axis < 3; ++axis) volume[axis] += region.filled(axis, at);
                    kernel += 1 - region.room(at);
                    // Distances are those of the probe.
                    const double exact = distance_of_box({0.27, 0.31, 0.23},
                                                         transform_point(inverse(pose), water.grid.center({x, y, z})));
                    EXPECT_LE(region.distance(at) * h, std::clamp(exact, -2 * h, 2 * h) + 1e-6);
                }
            }
        }
        const double exact = 8 * 0.27 * 0.31 * 0.23 / (h * h * h);
        for (const double found : volume) EXPECT_NEAR(found, exact, 0.01 * exact);
        EXPECT_NEAR(kernel, exact, 0.03 * exact);  // with what thin edges shut
    }
}

TEST(ObstacleRegion, OutOfReachNothingIsAdded) {
    Water water;
    const auto shape = CollisionShape::create(SphereShape{0.1}).value();
    ObstacleProbe probe(*shape, {{50, 0, 0}, {}}, {});
    ObstacleRegion region;
    region.begin(water.grid, water.cell_at({0.1, 0.1, 0.1}), water.cell_at({0.9, 0.9, 0.9}));
    EXPECT_FALSE(region.add(probe));
    region.finish();
    EXPECT_EQ(region.fraction(0, region.index(water.cell_at({0.5, 0.5, 0.5}))), 0);
    EXPECT_EQ(region.room(region.index(water.cell_at({0.5, 0.5, 0.5}))), 1);
}

TEST(ObstacleRegion, AWallThinnerThanACellShutsItsFaces) {
    Water water;
    for (const double y : {0.6, 0.63, 0.65}) {
        const auto shape = CollisionShape::create(BoxShape{{2, 0.005, 2}}).value();
        ObstacleProbe probe(*shape, {{0.6, y, 0.6}, {}}, {});
        ObstacleRegion region;
        region.begin(water.grid, water.cell_at({0.15, 0.15, 0.15}), water.cell_at({1.05, 1.05, 1.05}));
        ASSERT_TRUE(region.add(probe));
        region.finish();
        // Between what is well below and well above of it there is a face that is shut and marked, in every column.
        for (double x = 0.35; x < 0.9; x += h) {
            int shut = 0;
            for (double at = 0.45; at < 0.8; at += h) {
                const int cell = region.index(water.cell_at({x, at, 0.55}));
                const bool is_shut = region.fraction(1, cell) == 1;
                shut += is_shut;
                EXPECT_EQ(is_shut, (region.thin(cell) & closed_y) != 0);
                if (is_shut) {
                    EXPECT_LT(region.filled(1, cell), 0.2f);
                    EXPECT_TRUE(region.thin(cell) & near_thin);
                }
                EXPECT_EQ(region.thin(cell) & closed_y ? region.fraction(1, cell) : 1, 1);
            }
            EXPECT_GE(shut, 1);
            EXPECT_LE(shut, 2);
        }
    }
}

TEST(ObstacleRegion, ASmallVolumeIsSpreadAroundItsCentre) {
    Random random(8);
    Water water;
    const Cell lower = water.cell_at({0.15, 0.15, 0.15}), upper = water.cell_at({1.05, 1.05, 1.05});
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 place = Vec3{0.6, 0.6, 0.6} + any_point(random, 0.2);
        constexpr double volume = 2e-4;
        ObstacleRegion region;
        region.begin(water.grid, lower, upper);
        region.spread(place, volume);
        for (int axis = 0; axis < 4; ++axis) {
            double sum = 0;
            Vec3 center;
            for (int z = lower[2]; z < upper[2]; ++z) {
                for (int y = lower[1]; y < upper[1]; ++y) {
                    for (int x = lower[0]; x < upper[0]; ++x) {
                        const int at = region.index({x, y, z});
                        const double fraction = axis < 3 ? region.fraction(axis, at) : 1 - region.room(at);
                        sum += fraction;
                        center +=
                            fraction * (axis < 3 ? water.face_center(axis, {x, y, z}) : water.grid.center({x, y, z}));
                    }
                }
            }
            EXPECT_NEAR(sum * h * h * h, volume, 1e-9);
            EXPECT_LT(length(center / sum - place), 1e-5);
        }
    }
}

TEST(FluidObstacles, WithoutAnyAllIsOpen) {
    Water water;
    for (const Cell& corner : water.grid.tiles()) {
        water.grid.for_cells(corner, [&](int cell, const Cell&) {
            for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(water.grid.open[axis][cell], 1);
            EXPECT_EQ(water.grid.room[cell], 1);
            EXPECT_EQ(water.grid.obstacle_owner[cell], -1);
        });
    }
    EXPECT_EQ(water.obstacles.unexpected_displacement(), 0);
    EXPECT_EQ(water.obstacles.velocity_at(-1, {1, 2, 3}), Vec3{});
}

TEST(FluidObstacles, StaticAndMovingOnesAreMeasuredAlike) {
    const auto shape = CollisionShape::create(SphereShape{0.3}).value();
    FluidObstacle ball{.shape = shape.get(), .pose = {{0.62, 0.58, 0.6}, {}}, .center = {0.62, 0.58, 0.6}};
    Water moving(std::span(&ball, 1));
    ball.is_static = true;
    Water fixed(std::span(&ball, 1));
    ASSERT_EQ(moving.obstacles.moving().size(), 1u);
    EXPECT_TRUE(fixed.obstacles.moving().empty());
    EXPECT_EQ(fixed.obstacles.fixed().size(), 1u);
    std::size_t shut = 0, owned = 0;
    for (const Cell& corner : fixed.grid.tiles()) {
        fixed.grid.for_cells(corner, [&](int cell, const Cell& c) {
            const double exact = length(fixed.grid.center(c) - ball.center) / h - 3;
            EXPECT_EQ(moving.grid.obstacle[cell], fixed.grid.obstacle[cell]);
            if (fixed.grid.obstacle[cell] > -0.4f) {
                EXPECT_NEAR(fixed.grid.obstacle[cell], std::clamp(exact, -2.0, 2.0), 1e-4);
            }
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(moving.grid.open[axis][cell], fixed.grid.open[axis][cell], 1e-6);
                shut += fixed.grid.open[axis][cell] == 0;
            }
            EXPECT_EQ(fixed.grid.obstacle_owner[cell], -1);
            EXPECT_EQ(moving.grid.obstacle_owner[cell], exact < 2 - 1e-6 ? 0 : -1);
            owned += moving.grid.obstacle_owner[cell] == 0;
        });
    }
    EXPECT_GT(shut, 100u);
    EXPECT_GT(owned, 300u);
}

TEST(FluidObstacles, KnowHowFarTheyAreFromWhereTheyWereLeft) {
    const auto shape = CollisionShape::create(BoxShape{{0.1, 0.1, 0.1}}).value();
    FluidObstacle box{.body = 4, .shape = shape.get(), .pose = {{0.6, 0.6, 0.6}, {}}, .center = {0.6, 0.6, 0.6}};
    box.linear_velocity = {1, 0, 0};
    box.angular_velocity = {0, 3, 0};
    Water water(std::span(&box, 1));
    FluidObstacles& obstacles = water.obstacles;
    const Vec3 p{0.7, 0.6, 0.6};
    EXPECT_LT(length(obstacles.velocity_at(0, p) - Vec3{1, 0, -0.3}), 1e-9);
    box.acceleration = {0, -10, 0};
    obstacles.accelerate(0.02);
    EXPECT_NEAR(obstacles.moving()[0].linear_velocity.y, -0.2, 1e-12);
    obstacles.advance(0.02);
    obstacles.end();

    // Where it was left: not displaced. 5 cm aside: by that much. It catches up by what makes it so in a second.
    box.center = obstacles.moving()[0].center;
    box.pose = {box.center, obstacles.moving()[0].rotation};
    obstacles.begin(std::span(&box, 1), {}, water.grid);
    EXPECT_NEAR(obstacles.unexpected_displacement(), 0, 1e-12);
    box.center.z += 0.05;
    box.pose.position.z += 0.05;
    obstacles.begin(std::span(&box, 1), {}, water.grid);
    EXPECT_NEAR(obstacles.unexpected_displacement(), 0.05, 1e-9);
    obstacles.begin_catching_up();
    EXPECT_NEAR(obstacles.moving()[0].linear_velocity.z, 0.05, 1e-9);
    obstacles.end_catching_up();
    EXPECT_LT(length(obstacles.moving()[0].center - box.center), 1e-12);
    // Put far away from outside it was not moved through the fluid.
    box.version = 1;
    box.center.z += 3;
    box.pose.position.z += 3;
    obstacles.begin(std::span(&box, 1), {}, water.grid);
    EXPECT_EQ(obstacles.unexpected_displacement(), 0);
    for (const Bounds& reach : obstacles.in_reach(0.02, h)) {
        EXPECT_TRUE(contains(reach, enlarged(shape->bounds(box.pose), 6 * h)));
    }
}

TEST(SmallBody, DragIsThatOfASphere) {
    constexpr double radius = 0.01, density = 1000, viscosity = 0.001;
    EXPECT_GT(drag_of_sphere(radius, 0, density, viscosity), 0);  // the limit of slow motion
    for (const double speed : {1e-4, 0.01, 1.0, 10.0}) {
        const double reynolds = density * speed * 2 * radius / viscosity;
        const double root = 0.63 + 4.8 / std::sqrt(reynolds), coefficient = root * root;
        const double force = coefficient * density / 2 * speed * speed * pi * radius * radius;
        EXPECT_NEAR(drag_of_sphere(radius, speed, density, viscosity) * speed, force, 1e-9 * force);
    }
    // Creeping: within 5 % of Stokes's 6 π μ r.
    const double creeping = drag_of_sphere(radius, 0, density, 10);
    EXPECT_NEAR(creeping, 6 * pi * 10 * radius, 0.05 * creeping);
}

TEST(SmallBody, TakesFromTheLiquidWhatItIsGiven) {
    Random random(9);
    const auto shape = CollisionShape::create(SphereShape{0.02}).value();
    for (int trial = 0; trial < 10; ++trial) {
        const Vec3 center = Vec3{0.6, 0.6, 0.6} + any_point(random, 0.1);
        FluidObstacle grain{.shape = shape.get(), .pose = {center, {}}, .center = center};
        grain.inverse_mass = 1 / 0.04;
        grain.linear_velocity = any_point(random, 2);
        Water water(std::span(&grain, 1));
        MovingObstacle& moving = water.obstacles.moving().front();
        ASSERT_TRUE(moving.is_small && moving.is_in_reach);
        const Vec3 before = moving.linear_velocity;
        const Vec3 liquid = water.face_momenta().linear;
        constexpr double particle_mass = 1000 * h * h * h / 8;
        const FluidProperties matter{.density = 1000, .particle_volume = h * h * h / 8};
        drag_small_body(water.grid, matter, 0.01, moving);
        const Vec3 given = water.face_momenta().linear - liquid;
        EXPECT_LT(length(moving.linear_velocity), length(before));
        EXPECT_GT(dot(moving.linear_velocity, before), 0);
        EXPECT_LT(length(grain.impulse - (moving.linear_velocity - before) * 0.04), 1e-12);
        EXPECT_LT(length(given * particle_mass + grain.impulse), 1e-4 * length(grain.impulse));
    }
}

TEST(WallFriction, IsTheTurbulentStressBeyondTheLaminarOne) {
    constexpr double nu = 1e-6, y = 0.01;
    EXPECT_EQ(turbulent_stress(0.1 * nu / y, y, nu), 0);
    EXPECT_EQ(turbulent_stress(100 * nu / y, y, nu), 0);  // laminar below 158
    for (const double speed : {0.05, 0.5, 5.0}) {
        const double all = 0.0225 * speed * speed * std::pow(nu / (speed * y), 0.25);
        EXPECT_NEAR(turbulent_stress(speed, y, nu), all - nu * speed / y, 1e-9 * all);
    }
    EXPECT_TRUE(std::isfinite(turbulent_stress(0, y, nu)));
    EXPECT_TRUE(std::isfinite(turbulent_stress(1, y, 0)));
}

TEST(WallFriction, SlowsTheLayerAtAWallAndPullsAtIt) {
    const auto shape = CollisionShape::create(BoxShape{{3, 0.4, 3}}).value();
    // One that is moved by nobody, from below; at rest, and as fast as the liquid.
    for (const double speed : {0.0, 2.0}) {
        FluidObstacle floor{.shape = shape.get(), .pose = {{0.6, -0.4, 0.6}, {}}, .center = {0.6, -0.4, 0.6}};
        floor.linear_velocity = {speed, 0, 0};
        Water water(std::span(&floor, 1));
        PressureSystem system;
        system.build(water.grid, {}, water.workers);
        water.set_velocity([](Vec3) { return Vec3{2, 0, 0}; });
        const double before = water.face_momenta().linear.x;
        constexpr double particle_mass = 1000 * h * h * h / 8;
        const FluidProperties matter{.density = 1000, .particle_volume = h * h * h / 8};
        apply_wall_friction(water.grid, water.obstacles, matter, 0.01, water.workers);
        const double lost = (before - water.face_momenta().linear.x) * particle_mass;
        const float first = water.grid.velocity[0][water.index_at({0.6, 0.05, 0.6})];
        EXPECT_EQ(water.grid.velocity[0][water.index_at({0.6, 0.25, 0.6})], 2);
        if (speed == 0) {
            EXPECT_LT(first, 2);
            EXPECT_GT(first, 1.9f);
            EXPECT_NEAR(floor.impulse.x, lost, 1e-3 * lost);
            EXPECT_GT(lost, 0);
        } else {
            EXPECT_EQ(first, 2);
            EXPECT_EQ(floor.impulse.x, 0);
        }
        EXPECT_EQ(floor.impulse.y, 0);
    }
}

}  // namespace
}  // namespace embody::physics::fluid
