// SPDX-License-Identifier: MIT
// Drops without gravity: what holds them together, and how they swing.
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double drop_radius = 0.01, drop_density = 998, tension = 0.072;

// A spheroid of the ball's volume, 1 + `longer` times as long along x, beside the lattice of the grid.
std::vector<Vec3> drop(double cell, double longer) {
    const double step = cell / 2, a = drop_radius * (1 + longer), b = drop_radius / std::sqrt(1 + longer);
    const int most = static_cast<int>(a / step) + 2;
    std::vector<Vec3> places;
    for (int x = -most; x <= most; ++x) {
        for (int y = -most; y <= most; ++y) {
            for (int z = -most; z <= most; ++z) {
                const Vec3 p{(x + 0.8) * step, (y + 0.6) * step, (z + 0.95) * step};
                if (p.x * p.x / (a * a) + (p.y * p.y + p.z * p.z) / (b * b) < 1) places.push_back(p);
            }
        }
    }
    return places;
}

/// The drop's mean place and velocity, and how much longer than wide it is.
struct DropState {
    Vec3 center, velocity;
    double speed = 0;  // root mean square, m/s
    double longer = 0;
};

DropState state_of(const World& world, FluidHandle fluid) {
    const FluidParticles particles = world.fluid_particles(fluid);
    const auto count = static_cast<double>(particles.positions.size());
    DropState state;
    for (std::size_t i = 0; i < particles.positions.size(); ++i) {
        state.center += (particles.origin + Vec3(particles.positions[i])) / count;
        state.velocity += Vec3(particles.velocities[i]) / count;
        state.speed += length_squared(Vec3(particles.velocities[i])) / count;
    }
    double along = 0, across = 0;
    for (const Vec3f p : particles.positions) {
        const Vec3 d = particles.origin + Vec3(p) - state.center;
        along += d.x * d.x;
        across += (d.y * d.y + d.z * d.z) / 2;
    }
    state.speed = std::sqrt(state.speed);
    state.longer = along / across - 1;
    return state;
}

double radius_of(const World& world, FluidHandle fluid) { return std::cbrt(3 * volume_of(world, fluid) / (4 * pi)); }

// Rayleigh 1879: ω² = n (n − 1) (n + 2) σ/(ρ R³), n = 2.
double period_of(double radius) { return 2 * pi / std::sqrt(8 * tension / (drop_density * std::pow(radius, 3))); }

struct Drop {
    std::unique_ptr<World> world;
    FluidHandle fluid;
};

Drop make_drop(double cell, double longer) {
    Drop made{make_world({.gravity = {0, 0, 0}}), {}};
    made.fluid = made.world
                     ->create_fluid({.points = drop(cell, longer),
                                     .density = drop_density,
                                     .surface_tension = tension,
                                     .cell_size = cell,
                                     .allow_sleep = false})
                     .value();
    return made;
}

TEST(FluidTension, ADropAtRestHasLaplacesPressureAndStays) {
    const Drop drop = make_drop(drop_radius / 5, 0);
    const double radius = radius_of(*drop.world, drop.fluid), laplace = 2 * tension / radius;
    const Vec3 center = state_of(*drop.world, drop.fluid).center;
    const std::size_t count = drop.world->fluid_particles(drop.fluid).positions.size();
    const int steps = static_cast<int>(3 * period_of(radius) * 60);
    double mean = 0, fastest = 0;
    for (int i = 0; i < steps; ++i) {
        drop.world->step();
        mean += drop.world->fluid_pressure(drop.fluid, center) / steps;
        fastest = std::max(fastest, state_of(*drop.world, drop.fluid).speed);
    }
    RecordProperty("pressure_ratio", std::to_string(mean / laplace));
    EXPECT_NEAR(mean, laplace, 0.1 * laplace);
    // Noise of the cells, beside the speed of capillary waves as long as the radius.
    const double capillary = std::sqrt(tension / (drop_density * radius));
    RecordProperty("noise_ratio", std::to_string(fastest / capillary));
    EXPECT_LT(fastest, 0.15 * capillary);
    const DropState end = state_of(*drop.world, drop.fluid);
    EXPECT_LT(length(end.velocity), 1e-3 * capillary);
    EXPECT_LT(length(end.center - center), 0.01 * radius);
    EXPECT_NEAR(end.longer, 0, 0.05);
    EXPECT_EQ(drop.world->fluid_particles(drop.fluid).positions.size(), count);
}

TEST(FluidTension, ADropSwingsInRayleighsPeriod) {
    const Drop drop = make_drop(drop_radius / 5, 0.1);
    const double expected = period_of(radius_of(*drop.world, drop.fluid));
    // From the first time that it is as long as wide on: whole periods are every other such time.
    std::vector<double> times;
    double last = state_of(*drop.world, drop.fluid).longer, last_time = 0;
    while (last_time < 2.5 * expected) {
        drop.world->step();
        const double now = state_of(*drop.world, drop.fluid).longer, time = drop.world->last_report().time;
        if (last * now < 0) times.push_back(time - (time - last_time) * now / (now - last));
        last = now;
        last_time = time;
    }
    ASSERT_GE(times.size(), 5u);
    const double period = (times[4] - times[0]) / 2;
    RecordProperty("period_ratio", std::to_string(period / expected));
    EXPECT_NEAR(period, expected, 0.15 * expected);
}

TEST(FluidTension, PlaysNoPartOnCellsLargerThanTwiceTheCapillaryLength) {
    // On fine cells in a tank; on coarse ones in the air, since what clings to walls feels it on any.
    const auto hash = [](double sigma, double cell, int workers) {
        auto world = make_world({.workers = workers});
        if (cell < 0.0054) add_tank(*world, {{0, 0, 0}, {12 * cell, 12 * cell, 12 * cell}});
        EXPECT_TRUE(world->create_fluid(
            {.boxes = {{{0, 0, 0}, {6 * cell, 8 * cell, 12 * cell}}}, .surface_tension = sigma, .cell_size = cell}));
        for (int i = 0; i < 20; ++i) world->step();
        return world->state_hash();
    };
    EXPECT_EQ(hash(0, 0.0055, 1), hash(0.072, 0.0055, 1));
    const std::uint64_t fine = hash(0.072, 0.005, 1);
    EXPECT_NE(fine, hash(0, 0.005, 1));
    EXPECT_EQ(fine, hash(0.072, 0.005, 2));
    EXPECT_EQ(fine, hash(0.072, 0.005, 3));
}

}  // namespace
}  // namespace embody::physics
