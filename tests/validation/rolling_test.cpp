// SPDX-License-Identifier: MIT
// What is round rolls: on any ground v = ω r and keeps it, straight and level, and what slides at first ends at its
// share of the first speed (2/3 a cylinder, 5/7 a ball). What rolls round and round, without rolling friction, loses
// nothing: cones on their side, leaning coins (Euler's disk).
#include <gtest/gtest.h>

#include <string>

#include "validation/reference.h"

namespace embody::physics {
namespace {

constexpr double mu = 0.5;
constexpr double far = 1000;  // m: how far flat ground reaches

const Quat lying = from_axis_angle({1, 0, 0}, pi / 2);  // axis along Z

// Along X from −12 m, level at height 0.
void add_ground(World& world, const std::string& kind, double friction_of_ground) {
    BodyDefinition ground{.kind = BodyKind::static_body, .material = friction(friction_of_ground)};
    ShapeDefinition shape = PlaneShape{};
    constexpr int columns = 180, rows = 12;
    constexpr double cell = 2;
    if (kind == "box" || kind == "kinematic box") {
        shape = BoxShape{{far, 1, far}};
        ground.position = {0, -1, 0};
        if (kind == "kinematic box") ground.kind = BodyKind::kinematic_body;
    } else if (kind == "hull") {
        HullShape hull;
        for (int i = 0; i < 24; ++i) {
            const double x = std::cos(i * pi / 12), z = std::sin(i * pi / 12);
            hull.points.push_back({far * x, 0, far * z});
            hull.points.push_back({0.9 * far * x, -20, 0.9 * far * z});
        }
        shape = hull;
    } else if (kind == "heightfield") {
        shape = HeightfieldShape{columns, rows, cell, cell, std::vector<float>(std::size_t{columns} * rows)};
        ground.position = {-12, 0, -11};
    } else if (kind == "mesh") {
        MeshShape mesh;
        for (int r = 0; r < rows; ++r) {
            for (int c = 0; c < columns; ++c)
                mesh.positions.push_back({static_cast<float>(c * cell), 0, static_cast<float>(r * cell)});
        }
        for (std::uint32_t r = 0; r + 1 < rows; ++r) {
            for (std::uint32_t c = 0; c + 1 < columns; ++c) {
                const std::uint32_t i = r * columns + c;
                mesh.triangles.push_back({i, i + columns, i + 1});
                mesh.triangles.push_back({i + 1, i + columns, i + columns + 1});
            }
        }
        shape = mesh;
        ground.position = {-12, 0, -11};
    }
    ground.shape = world.create_shape(shape).value();
    ASSERT_TRUE(world.create_body(ground));
}

// Axis along Y, radius r.
ShapeDefinition round_shape(const std::string& kind, double r) {
    if (kind == "sphere") return SphereShape{r};
    if (kind == "capsule") return CapsuleShape{r, r};
    if (kind == "cylinder") return CylinderShape{r, r};
    if (kind == "wheel") return CylinderShape{r, r / 4};
    CompoundShape pair_of_wheels;
    pair_of_wheels.children.push_back({CylinderShape{r, r / 4}, {{0, -r, 0}, {}}});
    pair_of_wheels.children.push_back({CylinderShape{r, r / 4}, {{0, r, 0}, {}}});
    pair_of_wheels.children.push_back({CylinderShape{r / 4, r}, {}});
    return pair_of_wheels;
}

struct Rolling {
    std::unique_ptr<World> world;
    BodyHandle body;
};

Rolling start_rolling(const std::string& ground, const std::string& shape, double r, double speed, double spin) {
    auto world = make_world({});
    add_ground(*world, ground, mu);
    const auto body = world
                          ->create_body({.shape = world->create_shape(round_shape(shape, r)).value(),
                                         .position = {0, r, 0},
                                         .rotation = lying,
                                         .linear_velocity = {speed, 0, 0},
                                         .angular_velocity = {0, 0, -spin},
                                         .material = friction(mu),
                                         .allow_sleep = false})
                          .value();
    return {std::move(world), body};
}

TEST(Rolling, EveryRoundShapeKeepsItsSpeedOnEveryGround) {
    for (const std::string ground : {"plane", "box", "kinematic box", "hull", "mesh", "heightfield"}) {
        for (const std::string shape : {"sphere", "capsule", "cylinder", "wheel", "pair of wheels"}) {
            for (const double speed : {0.1, 1.0, 2.0, 5.0, 20.0, 100.0}) {
                const double r = speed == 20 ? 0.3 : 0.06;
                const Rolling rolling = start_rolling(ground, shape, r, speed, speed / r);
                double highest = 0, lowest = 0;
                for (int i = 0; i < 180; ++i) {
                    rolling.world->step();
                    const double height = rolling.world->pose(rolling.body).position.y - r;
                    highest = std::max(highest, height);
                    lowest = std::min(lowest, height);
                }
                const std::string what = shape + " on " + ground + " at " + std::to_string(speed);
                const Vec3 v = rolling.world->linear_velocity(rolling.body);
                const double rim = -rolling.world->angular_velocity(rolling.body).z * r;
                EXPECT_NEAR(v.x, speed, 1e-3 * speed) << what;
                EXPECT_NEAR(rim, v.x, 1e-3 * speed) << what;
                EXPECT_LT(highest, 2e-4) << what;
                EXPECT_GT(lowest, -1e-3) << what;
                EXPECT_LT(std::fabs(rolling.world->pose(rolling.body).position.z), 2e-3 * 3 * speed + 1e-3) << what;
            }
        }
    }
}

TEST(Rolling, SlidingBodiesEndAtTheKnownFractionOfTheirSpeed) {
    for (const std::string ground : {"plane", "box", "mesh"}) {
        for (const double speed : {1.0, 5.0}) {
            for (const auto& [shape, share] :
                 {std::pair<std::string, double>{"sphere", 5.0 / 7}, {"cylinder", 2.0 / 3}, {"wheel", 2.0 / 3}}) {
                const Rolling rolling = start_rolling(ground, shape, 0.06, speed, 0);
                run(*rolling.world, 1);
                const double v = rolling.world->linear_velocity(rolling.body).x;
                const double rim = -rolling.world->angular_velocity(rolling.body).z * 0.06;
                EXPECT_NEAR(v, share * speed, 0.005 * speed) << shape << " on " << ground << " at " << speed;
                EXPECT_NEAR(rim, v, 1e-3 * speed) << shape << " on " << ground << " at " << speed;
            }
        }
    }
}

// On its side, apex in the origin, the half angle β between axis and ground: ω = σ along the line that touches, the
// axis goes round at σ tan β, and nothing changes either.
TEST(Rolling, ConeOnItsSideKeepsItsEnergy) {
    for (const std::string ground : {"plane", "box"}) {
        for (const auto& [r, height, spin] :
             {std::array{0.3, 0.6, 3.0}, std::array{0.05, 0.2, 6.0}, std::array{0.1, 0.15, 2.0}}) {
            const double half_angle = std::atan2(r, height);
            const auto world = make_world({});
            add_ground(*world, ground, 1);
            const Vec3 axis{std::cos(half_angle), std::sin(half_angle), 0}, omega{spin, 0, 0};
            const auto body = world
                                  ->create_body({.shape = world->create_shape(ConeShape{r, height / 2}).value(),
                                                 .position = axis * (height / 2),
                                                 .rotation = from_two_vectors({0, -1, 0}, axis),
                                                 .linear_velocity = cross(omega, axis * (0.75 * height)),
                                                 .angular_velocity = omega,
                                                 .material = friction(1),
                                                 .allow_sleep = false})
                                  .value();
            const double start = world->conserved().kinetic_energy, all = energy(*world);
            double most = all, way = 0;
            Vec3 last = axis;
            for (int i = 0; i < 600; ++i) {
                world->step();
                most = std::max(most, energy(*world));
                const Vec3 now = rotate(world->pose(body).rotation, {0, -1, 0});
                way += std::atan2(last.z * now.x - last.x * now.z, last.x * now.x + last.z * now.z);
                last = now;
            }
            EXPECT_NEAR(world->conserved().kinetic_energy, start, 0.005 * start) << ground << " r " << r;
            EXPECT_LE(most, all + 1e-6 * start) << ground << " r " << r;
            EXPECT_NEAR(std::fabs(way) / 10, spin * std::tan(half_angle), 0.005 * spin * std::tan(half_angle))
                << ground << " r " << r;
        }
    }
}

struct Disc {
    double radius, half_height, lean;  // m, m, rad between its axis and the vertical
};

// Steady rolling about a centre of mass at rest: ω goes through the place that touches, r from the centre of mass;
// dL/dt = Ω × L = m g r × n. For a thin disc Ω² sin α = 4 g / r.
struct SteadyRolling {
    Vec3 arm, omega;
    double rate;
};
SteadyRolling steady_rolling(const Disc& disc, double mass, const Mat3& inertia) {
    const Vec3 axis{std::sin(disc.lean), std::cos(disc.lean), 0}, down{std::cos(disc.lean), -std::sin(disc.lean), 0};
    const Vec3 arm = down * disc.radius - axis * disc.half_height, along = normalized(arm);
    const double rate = -disc.radius / length(arm) / std::sin(disc.lean);
    const Vec3 momentum = down * (inertia(0, 0) * dot(along, down)) + axis * (inertia(1, 1) * dot(along, axis));
    const double turning = cross(Vec3{0, rate, 0}, momentum).z, moment = cross(arm, Vec3{0, mass * gravity, 0}).z;
    const double speed = std::sqrt(moment / turning);
    return {arm, along * speed, rate * speed};
}

TEST(Rolling, LeaningDiscGoesRoundAtItsRate) {
    for (const std::string ground : {"plane", "box"}) {
        for (const Disc& disc :
             {Disc{0.05, 0.0015, 5 * pi / 180}, Disc{0.05, 0.0015, 10 * pi / 180}, Disc{0.05, 0.0015, 30 * pi / 180},
              Disc{0.05, 0.01, 30 * pi / 180}, Disc{0.012, 0.001, 20 * pi / 180}, Disc{0.3, 0.02, 15 * pi / 180}}) {
            const auto world = make_world({});
            add_ground(*world, ground, 1);
            const Vec3 axis{std::sin(disc.lean), std::cos(disc.lean), 0};
            const auto shape = world->create_shape(CylinderShape{disc.radius, disc.half_height}).value();
            const auto body = world
                                  ->create_body({.shape = shape,
                                                 .rotation = from_two_vectors({0, 1, 0}, axis),
                                                 .material = friction(1),
                                                 .allow_sleep = false})
                                  .value();
            const SteadyRolling steady = steady_rolling(disc, world->mass(body), world->inertia(body));
            EXPECT_TRUE(world->set_pose(body, {{0, -steady.arm.y, 0}, from_two_vectors({0, 1, 0}, axis)}));
            EXPECT_TRUE(world->set_velocity(body, {}, steady.omega));
            const double start = energy(*world);
            double most = start, least_lean = disc.lean, most_lean = disc.lean, way = 0;
            Vec3 last = axis;
            for (int i = 0; i < 180; ++i) {
                world->step();
                most = std::max(most, energy(*world));
                const Vec3 now = rotate(world->pose(body).rotation, {0, 1, 0});
                const double lean = std::atan2(std::hypot(now.x, now.z), std::fabs(now.y));
                least_lean = std::min(least_lean, lean);
                most_lean = std::max(most_lean, lean);
                way += std::atan2(last.z * now.x - last.x * now.z, last.x * now.x + last.z * now.z);
                last = now;
            }
            const std::string what = ground + ", r " + std::to_string(disc.radius) + ", " +
                                     std::to_string(disc.lean * 180 / pi) + " degrees";
            EXPECT_NEAR(std::remainder(way / 3 - steady.rate, 2 * pi * 60), 0, 0.02 * std::fabs(steady.rate)) << what;
            EXPECT_GT(least_lean, 0.97 * disc.lean) << what;
            EXPECT_LT(most_lean, 1.03 * disc.lean) << what;
            EXPECT_LE(most, start + 1e-6 * std::fabs(start)) << what;
        }
    }
}

// Nothing slips under a coin that is spun on its edge: it nods to and fro and goes on.
TEST(Rolling, SpunCoinGoesOnSpinning) {
    for (const std::string ground : {"plane", "box"}) {
        const double r = 0.012, half = 0.001, lean = 85 * pi / 180;
        const auto world = make_world({});
        add_ground(*world, ground, 0.5);
        const Vec3 axis{std::sin(lean), std::cos(lean), 0};
        const auto body = world
                              ->create_body({.shape = world->create_shape(CylinderShape{r, half}).value(),
                                             .position = {0, r * axis.x + half * axis.y, 0},
                                             .rotation = from_two_vectors({0, 1, 0}, axis),
                                             .angular_velocity = {0, 60, 0},
                                             .material = friction(0.5),
                                             .allow_sleep = false})
                              .value();
        const double start = energy(*world);
        for (int i = 0; i < 600; ++i) {
            world->step();
            EXPECT_LE(energy(*world), start * (1 + 1e-6)) << ground << " step " << i;
        }
        EXPECT_GT(energy(*world), 0.98 * start) << ground;
        EXPECT_GT(std::fabs(world->angular_velocity(body).y), 50) << ground;
    }
}

// Rolling without slip on a slope trades height for motion and nothing else, wherever it goes.
TEST(Rolling, CoinOnASlopeKeepsItsEnergy) {
    const double slope = 8 * pi / 180;
    const auto world = make_world({});
    add_plane(*world, friction(1), slope);
    const Vec3 up{std::sin(slope), std::cos(slope), 0};
    const double r = 0.05, half = 0.002, lean = 65 * pi / 180;
    const Vec3 axis = rotate(from_axis_angle(normalized(Vec3{std::cos(slope), -std::sin(slope), 0}), lean), up);
    const Vec3 down = normalized(axis * dot(axis, up) - up), arm = down * r - axis * half;
    const Vec3 omega = axis * 40;
    const auto shape = world->create_shape(CylinderShape{r, half}).value();
    const auto body = world
                          ->create_body({.shape = shape,
                                         .position = up * -dot(arm, up),
                                         .rotation = from_two_vectors({0, 1, 0}, axis),
                                         .linear_velocity = cross(arm, omega),
                                         .angular_velocity = omega,
                                         .material = friction(1),
                                         .allow_sleep = false})
                          .value();
    const double start = energy(*world), kinetic = world->conserved().kinetic_energy;
    for (int i = 0; i < 180; ++i) {
        world->step();
        EXPECT_NEAR(energy(*world), start, 1e-4 * kinetic) << i;
    }
    EXPECT_GT(distance(world->pose(body).position, {}), 0.3);
}

}  // namespace
}  // namespace embody::physics
