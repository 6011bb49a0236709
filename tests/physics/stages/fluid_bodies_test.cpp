// SPDX-License-Identifier: MIT
// Fluids among bodies: what fills a region, what moves a liquid, what wakes one that sleeps, and what two fluids do to
// one body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "physics/inter/world.h"

namespace embody::physics {
namespace {

class FluidBodies : public testing::Test {
protected:
    void use(const WorldSettings& settings) { ASSERT_TRUE(world_->set_settings(settings)); }
    BodyHandle add_box(Vec3 half_extents, BodyDefinition definition) {
        definition.shape = world_->create_shape(BoxShape{half_extents}).value();
        return world_->create_body(definition).value();
    }
    BodyHandle add_fixed_box(Vec3 half_extents, Vec3 position) {
        return add_box(half_extents, {.kind = BodyKind::static_body, .position = position});
    }
    // Floor and walls around the unit square.
    void add_basin() {
        add_fixed_box({2, 0.5, 2}, {0.5, -0.5, 0.5});
        for (const double side : {-0.5, 1.5}) {
            add_fixed_box({0.5, 2, 2}, {side, 1, 0.5});
            add_fixed_box({0.5, 2, 0.5}, {0.5, 1, side});
        }
    }
    // Shallow, of large cells: it sleeps after few steps.
    FluidHandle add_pool(FluidDefinition water = {}, double cell_size = 0.25) {
        water.boxes = {{{0, 0, 0}, {1, 0.5, 1}}};
        water.cell_size = cell_size;
        return world_->create_fluid(water).value();
    }
    void run(int steps) {
        for (int i = 0; i < steps; ++i) world_->step();
    }
    bool is_asleep(FluidHandle fluid) const { return world_->fluid_particles(fluid).is_asleep; }
    void run_until_asleep(FluidHandle fluid) {
        for (int i = 0; i < 900 && !is_asleep(fluid); ++i) world_->step();
        ASSERT_TRUE(is_asleep(fluid));
    }
    std::size_t particles(FluidHandle fluid) const { return world_->fluid_particles(fluid).ids.size(); }
    double volume(const FluidDefinition& definition) {
        const FluidHandle fluid = world_->create_fluid(definition).value();
        return static_cast<double>(particles(fluid)) * world_->fluid_particles(fluid).particle_volume;
    }
    double fastest(FluidHandle fluid) const {
        double fastest = 0;
        for (const Vec3 velocity : world_->fluid_particles(fluid).velocities)
            fastest = std::max(fastest, length(velocity));
        return fastest;
    }

    std::unique_ptr<World> world_ = World::create().value();
};

std::vector<Vec3> corners(Vec3 lower, Vec3 upper) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
        points.push_back(
            {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z});
    return points;
}

TEST_F(FluidBodies, FillTheUnionOfTheirRegionsOnce) {
    const Vec3 zero, one{0.8, 0.4, 0.4}, half{0.4, 0.4, 0.4};
    const auto volume_of = [&](const std::vector<Bounds>& boxes, const std::vector<std::vector<Vec3>>& hulls) {
        return volume({.boxes = boxes, .hulls = hulls, .cell_size = 0.1});
    };
    const double whole = 0.8 * 0.4 * 0.4, rounding = 1e-9;
    EXPECT_NEAR(volume_of({{zero, one}}, {}), whole, rounding);
    EXPECT_NEAR(volume_of({{zero, one}, {zero, one}}, {}), whole, rounding) << "one box twice";
    EXPECT_NEAR(volume_of({{zero, one}, {zero, half}}, {}), whole, rounding) << "a box in another";
    EXPECT_NEAR(volume_of({}, {corners(zero, one)}), whole, rounding);
    EXPECT_NEAR(volume_of({}, {corners(zero, one), corners(zero, half)}), whole, rounding) << "a hull in another";
    EXPECT_NEAR(volume_of({{zero, half}}, {corners(zero, one)}), whole, rounding) << "a box in a hull";
    // A corner cut off along the diagonals of three faces: a sixth of the cube, but for the lattice's steps.
    const double sixth = volume_of({}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    EXPECT_NEAR(sixth, 1.0 / 6, 0.02);
}

TEST_F(FluidBodies, OfTooManyParticlesOrNoneAreRefused) {
    const auto field = [&](const FluidDefinition& definition) {
        const auto made = world_->create_fluid(definition);
        return made ? "" : made.error().where;
    };
    EXPECT_EQ(field({.hulls = {corners({0, 0, 0}, {50, 50, 50})}, .cell_size = 0.01}), "cell_size");
    EXPECT_EQ(field({.boxes = {{{0, 0, 0}, {50, 50, 50}}}, .cell_size = 0.01}), "cell_size");
    add_fixed_box({1, 1, 1}, {0, 0, 0});
    EXPECT_EQ(field({.boxes = {{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}}, .cell_size = 0.1}), "boxes") << "in a solid";
    const FluidHandle drop = world_->create_fluid({.points = {{0, 2, 0}}, .cell_size = 0.1}).value();
    const auto add = [&](std::vector<Vec3> places) {
        const auto added = world_->add_to_fluid(drop, places);
        return added ? "" : added.error().where;
    };
    EXPECT_EQ(add({{0, 0, 0}, {0.5, 0, 0}}), "places") << "in a solid";
    EXPECT_EQ(add({{0, 3, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}}), "places[1]");
    EXPECT_EQ(particles(drop), 1u);
    EXPECT_EQ(add({{0, 3, 0}, {0, 0, 0}}), "");
    EXPECT_EQ(particles(drop), 2u) << "the one in the solid is left out";
}

// The momentum, over that of the whole cube at the wall's speed, that a free cube of liquid has when a wall at one of
// its faces begins to move: pressure zero on five faces, its gradient given on the sixth, solved in double sines.
double momentum_of_pushed_cube() {
    constexpr double pi = 3.14159265358979323846;
    double sum = 0;
    for (int m = 1; m < 40; m += 2) {
        for (int n = 1; n < 40; n += 2) {
            const double k = pi * std::sqrt(m * m + n * n);
            sum += 64 / (std::pow(pi, 4) * m * m * n * n) * std::tanh(k) / k;
        }
    }
    return sum;
}

// A wall that is put 5 cm farther was moved there in one step: it pushes. One that comes from the other side was not.
TEST_F(FluidBodies, AWallThatIsPutALittleFartherPushesTheLiquid) {
    constexpr double displacement = 0.05;
    const auto momentum_after = [&](Vec3 from, Vec3 to) {
        world_ = World::create({.gravity = {0, 0, 0}}).value();
        const BodyHandle wall = add_fixed_box({0.2, 1, 1}, from);
        const FluidHandle water =
            world_->create_fluid({.boxes = {{{0, 0, 0}, {0.4, 0.4, 0.4}}}, .cell_size = 0.1}).value();
        run(2);
        EXPECT_LT(fastest(water), 1e-3) << "at rest as long as nothing moves";
        EXPECT_TRUE(world_->set_pose(wall, {to, {}}));
        run(1);
        EXPECT_EQ(particles(water), 512u);
        return world_->conserved().linear_momentum.x;
    };
    // In coarse cells the surface lies up to half a cell outside: the cube is between 0.4 and 0.5 m large.
    const double expected = momentum_of_pushed_cube() * 998 * 0.4 * 0.4 * 0.4 * displacement * 60;
    const double coarse = std::pow(0.5 / 0.4, 3);
    const double pushed = momentum_after({-0.2, 0.2, 0.2}, {-0.2 + displacement, 0.2, 0.2});
    EXPECT_GT(pushed, expected);
    EXPECT_LT(pushed, coarse * expected);
    // Through the liquid, from its other side, it would drag it along at 45 m/s.
    EXPECT_LT(std::fabs(momentum_after({0.6, 0.2, 0.2}, {-0.2 + displacement, 0.2, 0.2})), coarse * expected);
}

TEST_F(FluidBodies, CalmLiquidIsWokenByWhatHappensInItAndByNothingElse) {
    add_basin();
    const FluidHandle water = add_pool();
    run_until_asleep(water);
    BodyHandle stone;
    const std::vector<std::pair<const char*, std::function<void()>>> woken_by{
        {"a body that comes",
         [&] {
             stone = add_fixed_box({0.2, 0.2, 0.2}, {0.5, 0.2, 0.5});
         }},
        {"one that is put elsewhere",
         [&] {
             ASSERT_TRUE(world_->set_pose(stone, {{0.55, 0.2, 0.5}, {}}));
         }},
        {"one that is turned",
         [&] {
             ASSERT_TRUE(world_->set_pose(stone, {{0.55, 0.2, 0.5}, {0, 0.1, 0, 1}}));
         }},
        {"one that goes", [&] { ASSERT_TRUE(world_->destroy_body(stone)); }},
        {"other matter", [&] { ASSERT_TRUE(world_->set_fluid(water, *world_->fluid(water))); }},
        {"more of it", [&] {
             ASSERT_TRUE(world_->add_to_fluid(water, std::vector<Vec3>{{0.5, 1, 0.5}}));
         }}};
    for (const auto& [what, happens] : woken_by) {
        happens();
        run(1);
        EXPECT_FALSE(is_asleep(water)) << what;
        run_until_asleep(water);
    }
    const std::uint64_t before = world_->fluid_particles(water).version;
    const BodyHandle far = add_fixed_box({0.2, 0.2, 0.2}, {30, 0, 0});
    ASSERT_TRUE(world_->set_pose(far, {{31, 0, 0}, {}}));
    run(3);
    EXPECT_TRUE(is_asleep(water)) << "of what is far away it knows nothing";
    EXPECT_EQ(world_->fluid_particles(water).version, before);
}

TEST_F(FluidBodies, LiquidThatMayNotSleepDoesNot) {
    add_basin();
    const FluidHandle water = add_pool({.allow_sleep = false});
    run(400);
    EXPECT_FALSE(is_asleep(water));
    ASSERT_TRUE(world_->destroy_fluid(water));
    use({.sleeping = false});
    const FluidHandle other = add_pool();
    run(400);
    EXPECT_FALSE(is_asleep(other));
    use({});
    run_until_asleep(other);
}

// What sleeps on the ground wakes when liquid comes that pushes it.
TEST_F(FluidBodies, ASleeperWakesWhenLiquidPushesIt) {
    add_basin();
    const BodyHandle stone = add_box({0.2, 0.1, 0.2}, {.position = {0.5, 0.1, 0.5}, .mass = {.density = 500}});
    for (int i = 0; i < 300 && world_->sleep_state(stone) != SleepState::asleep; ++i) world_->step();
    ASSERT_EQ(world_->sleep_state(stone), SleepState::asleep);
    add_pool({}, 0.1);
    run(2);
    EXPECT_NE(world_->fluid_force(stone).force, Vec3{});
    EXPECT_NE(world_->sleep_state(stone), SleepState::asleep);
}

// What rests on the bottom is carried by the liquid, too: it wakes when that is taken away.
TEST_F(FluidBodies, ASleeperWakesWhenTheLiquidThatCarriedItGoes) {
    add_basin();
    const BodyHandle stone = add_box({0.2, 0.1, 0.2}, {.position = {0.5, 0.1, 0.5}, .mass = {.density = 2000}});
    const FluidHandle water = add_pool();
    run_until_asleep(water);
    ASSERT_EQ(world_->sleep_state(stone), SleepState::asleep);
    EXPECT_NE(world_->fluid_force(stone).force.y, 0);
    ASSERT_TRUE(world_->change_fluid(water, {0, 1'000'000}, [](std::uint32_t, Vec3&, Vec3&) { return false; }));
    EXPECT_EQ(particles(water), 0u);
    run(1);
    EXPECT_NE(world_->sleep_state(stone), SleepState::asleep);
    EXPECT_EQ(world_->fluid_force(stone).force, Vec3{});
}

// Two fluids do not see each other: each pushes as if it were alone.
TEST_F(FluidBodies, TwoPushABodyBySumOfTheirForces) {
    const auto force_of = [&](int fluids) {
        world_ = World::create().value();
        add_basin();
        const BodyHandle stone =
            add_box({0.2, 0.1, 0.2}, {.kind = BodyKind::kinematic_body, .position = {0.5, 0.25, 0.5}});
        for (int i = 0; i < fluids; ++i) add_pool({}, 0.1);
        run(2);
        return world_->fluid_force(stone).force.y;
    };
    const double one = force_of(1), displaced = 998 * 9.81 * 0.4 * 0.2 * 0.4;
    EXPECT_NEAR(one, displaced, 0.3 * displaced) << "Archimedes, in coarse cells";
    EXPECT_NEAR(force_of(2), 2 * one, 1e-9 * one);
}

// Without gravity nothing sinks, and liquid at rest sleeps where it floats.
TEST_F(FluidBodies, LiquidAtRestWithoutGravitySleeps) {
    use({.gravity = {0, 0, 0}});
    const FluidHandle pool = add_pool();
    run_until_asleep(pool);
    EXPECT_EQ(fastest(pool), 0);
    use({});
    run(1);
    // What sleeps does not notice another gravity before it is woken.
    ASSERT_TRUE(world_->wake(pool));
    run(30);
    EXPECT_LT(world_->conserved().linear_momentum.y, 0);
}

}  // namespace
}  // namespace embody::physics
