// SPDX-License-Identifier: MIT
// A closed tank with water in it that falls, lands and tumbles: nothing comes out, and in flight both together have
// the momentum that gravity gives. One that lands upright, open or closed, has its water's volume again.
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double half = 0.2;  // of the tank, to the middle of its walls, m

CompoundShape tank_of(double wall, bool is_open) {
    CompoundShape tank;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
            if (is_open && axis == 1 && side == 1) continue;
            Vec3 size{half + wall / 2, half + wall / 2, half + wall / 2}, place;
            size[axis] = wall / 2;
            place[axis] = side * half;
            tank.children.push_back({BoxShape{size}, {place, {}}});
        }
    }
    return tank;
}

struct Flight {
    std::unique_ptr<World> world;
    BodyHandle tank;
    FluidHandle water;
    double wall, cell;

    /// Particles that are deeper in the tank's walls than a seventh of a cell, which they may be in corners.
    [[nodiscard]] int outside() const {
        const FluidParticles particles = world->fluid_particles(water);
        int count = 0;
        for (const Vec3f p : particles.positions) {
            const Vec3 local = abs(inverse_transform_point(world->pose(tank), particles.origin + Vec3(p)));
            count += std::max({local.x, local.y, local.z}) > half - wall / 2 + cell / 7;
        }
        return count;
    }
};

Flight in_the_air(double wall, double cell, double height, Vec3 spin, double filled = 0.8, bool is_open = false) {
    Flight flight{make_world({}), {}, {}, wall, cell};
    add_box(*flight.world, {10, 0.5, 10}, {.kind = BodyKind::static_body, .position = {0, -0.5, 0}});
    const auto shape = flight.world->create_shape(tank_of(wall, is_open)).value();
    flight.tank =
        flight.world->create_body({.shape = shape, .position = {0, height, 0}, .angular_velocity = spin}).value();
    const double inner = half - wall / 2;
    const Vec3 low{-inner, height - inner, -inner};
    flight.water =
        flight.world
            ->create_fluid({.boxes = {{low, low + Vec3{2 * inner, 2 * inner * filled, 2 * inner}}}, .cell_size = cell})
            .value();
    return flight;
}

struct Fall {
    double wall, cell, height;
    Vec3 spin;
};

void PrintTo(const Fall& fall, std::ostream* out) {
    *out << "walls of " << fall.wall << " m, cells of " << fall.cell << " m, from " << fall.height << " m";
}

class FluidClosedTank : public testing::TestWithParam<Fall> {};

TEST_P(FluidClosedTank, NothingComesOutWhenItFallsAndLands) {
    const Fall& fall = GetParam();
    Flight flight = in_the_air(fall.wall, fall.cell, fall.height, fall.spin);
    const std::size_t count = flight.world->fluid_particles(flight.water).positions.size();
    int worst = 0, at = 0;
    for (int i = 0; i < 180; ++i) {
        flight.world->step();
        if (flight.outside() > worst) at = i;
        worst = std::max(worst, flight.outside());
    }
    RecordProperty("outside", worst);
    RecordProperty("outside_at", at);
    EXPECT_EQ(flight.world->fluid_particles(flight.water).positions.size(), count);
    EXPECT_EQ(worst, 0);
}

INSTANTIATE_TEST_SUITE_P(Falls, FluidClosedTank,
                         testing::Values(Fall{0.04, 0.034, 0.5, {}}, Fall{0.04, 0.034, 0.5, {5, 0, 0}},
                                         Fall{0.04, 0.047, 0.5, {5, 0, 0}}, Fall{0.04, 0.034, 4, {3, 2, 7}},
                                         Fall{0.1, 0.034, 3, {1, 5, 0}}, Fall{0.1, 0.034, 1, {10, 5, 0}},
                                         Fall{0.01, 0.034, 4, {3, 2, 7}}));

struct Landing {
    double wall, cell;
    bool is_open;
};

void PrintTo(const Landing& landing, std::ostream* out) {
    *out << (landing.is_open ? "open" : "closed") << ", walls of " << landing.wall << " m, cells of " << landing.cell
         << " m";
}

class FluidTankThatLands : public testing::TestWithParam<Landing> {};

TEST_P(FluidTankThatLands, HasItsLevelAgain) {
    const auto& [wall, cell, is_open] = GetParam();
    constexpr double fall = 1, filled = 0.6, seconds = 3, slack = 0.05;
    const double inner = half - wall / 2, start = fall + half + wall / 2;
    // At its place from the start: the tank's origin is its middle, open or not.
    Flight flight = in_the_air(wall, cell, start, {}, filled, is_open);
    const double depth = volume_of(*flight.world, flight.water) / (4 * inner * inner);
    run(*flight.world, seconds);
    const FluidParticles particles = flight.world->fluid_particles(flight.water);
    const Transform pose = flight.world->pose(flight.tank);
    double height = 0;
    int beside = 0;
    for (const Vec3f p : particles.positions) {
        const Vec3 local = inverse_transform_point(pose, particles.origin + Vec3(p));
        beside += std::max(std::fabs(local.x), std::fabs(local.z)) > half + wall;
        height += local.y + inner;
    }
    height /= static_cast<double>(particles.positions.size());
    RecordProperty("level", std::to_string(2 * height / depth));
    EXPECT_EQ(beside, 0);
    EXPECT_NEAR(pose.position.y, half + wall / 2, 0.005);
    EXPECT_NEAR(2 * height, depth, slack * depth);
}

INSTANTIATE_TEST_SUITE_P(FromAMetre, FluidTankThatLands,
                         testing::Values(Landing{0.04, 0.034, false}, Landing{0.04, 0.034, true},
                                         Landing{0.1, 0.034, false}, Landing{0.01, 0.034, true},
                                         Landing{0.01, 0.02, true}, Landing{0.02, 0.024, true}));

/// Mass, momentum and angular momentum about the common centre.
struct Whole {
    double mass;
    Vec3 momentum, spin;
};

Whole whole_of(const Flight& flight) {
    const World& world = *flight.world;
    const FluidParticles particles = world.fluid_particles(flight.water);
    const double tank = world.mass(flight.tank), drop = world.fluid(flight.water)->density * particles.particle_volume;
    double mass = tank;
    Vec3 center = world.center_of_mass(flight.tank) * tank;
    for (const Vec3f p : particles.positions) {
        mass += drop;
        center += (particles.origin + Vec3(p)) * drop;
    }
    const Conserved sum = world.conserved();
    return {mass, sum.linear_momentum, sum.angular_momentum - cross(center / mass, sum.linear_momentum)};
}

TEST(FluidClosedTankInFlight, BothTogetherKeepTheirMomentum) {
    const Flight flight = in_the_air(0.04, 0.034, 20, {3, 2, 7});
    const Whole before = whole_of(flight);
    constexpr int steps = 90;
    for (int i = 0; i < steps; ++i) flight.world->step();
    const Whole after = whole_of(flight);
    const Vec3 gained = after.momentum - before.momentum - Vec3{0, -9.81 * before.mass * steps / 60.0, 0};
    const double turned = length(after.spin - before.spin) / length(before.spin);
    RecordProperty("gained", std::to_string(length(gained) / before.mass));
    RecordProperty("turned", std::to_string(turned));
    EXPECT_LT(length(gained), 0.001 * before.mass);  // m/s, of 14.7
    EXPECT_LT(turned, 0.01);
}

}  // namespace
}  // namespace embody::physics
