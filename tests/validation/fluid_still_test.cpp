// SPDX-License-Identifier: MIT
// Water that begins at rest in a tank stays at rest, wherever the walls lie in the cells that it is solved on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double cell = 0.025;

// A tank of five boxes at a random place in the grid, and water in it up to a random height.
struct StillTank {
    std::unique_ptr<World> world = make_world({});
    FluidHandle water;
    Vec3 place;
    Quat turn;
    double length = 0, width = 0;  // half of the inside

    // The water is dropped by `drop` cells.
    StillTank(unsigned seed, bool is_turned, double drop = 0) {
        std::mt19937 random(seed);
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        length = between(0.1, 0.3);
        width = between(0.1, 0.2);
        const double depth = between(0.04, 0.15), wall = 0.05, height = 0.15;
        place = {between(-0.1, 0.1), between(-0.1, 0.1), between(-0.1, 0.1)};
        turn = from_axis_angle({0, 1, 0}, is_turned ? between(0, 1.5) : 0);
        const auto add = [&](Vec3 half, Vec3 middle) {
            add_box(*world, half,
                    {.kind = BodyKind::static_body, .position = place + rotate(turn, middle), .rotation = turn});
        };
        add({length + 2 * wall, wall, width + 2 * wall}, {0, -wall, 0});
        for (const int side : {-1, 1}) {
            add({wall, height, width + 2 * wall}, {side * (length + wall), height, 0});
            add({length, height, wall}, {0, height, side * (width + wall)});
        }
        std::vector<Vec3> corners;
        for (const int x : {-1, 1}) {
            for (const int z : {-1, 1}) {
                for (const int y : {0, 1})
                    corners.push_back(place + rotate(turn, {x * length, drop * cell + y * depth, z * width}));
            }
        }
        water = world->create_fluid({.hulls = {corners}, .cell_size = cell}).value();
    }

    [[nodiscard]] double mean_speed() const {
        double sum = 0;
        const auto velocities = world->fluid_particles(water).velocities;
        for (const Vec3f v : velocities) sum += length_squared(Vec3(v));
        return std::sqrt(sum / static_cast<double>(velocities.size()));
    }

    // Kinetic and potential energy, mean over so many seconds that begin now, J.
    double mean_energy(double seconds) {
        const int steps = static_cast<int>(60 * seconds);
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            world->step();
            sum += energy(*world);
        }
        return sum / steps;
    }

    // How far particles are outside of the walls, at most, m.
    [[nodiscard]] double farthest_outside() const {
        double most = 0;
        const FluidParticles particles = world->fluid_particles(water);
        for (const Vec3f p : particles.positions) {
            const Vec3 at = rotate(conjugate(turn), particles.origin + Vec3(p) - place);
            most = std::max({most, std::fabs(at.x) - length, std::fabs(at.z) - width, -at.y});
        }
        return most;
    }
};

// A wall that leaves a narrow slice of its cells open had water in that slice standing a cell too high, which fell
// along the wall for ever.
TEST(FluidStill, BesideWallsThatCutAnyPartOffTheirCells) {
    for (const double open : {0.02, 0.06, 0.12, 0.2, 0.25, 0.3, 0.5, 0.7, 0.9}) {
        const auto world = make_world({});
        const Vec3 half{0.15 + open * cell, 0.15, 0.1 + open * cell};
        add_tank(*world, {{-half.x, 0, -half.z}, {half.x, 2 * half.y, half.z}});
        const FluidHandle water =
            world->create_fluid({.boxes = {{{-half.x, 0, -half.z}, {half.x, 0.1, half.z}}}, .cell_size = cell}).value();
        run(*world, 4);
        double fastest = 0;
        for (const Vec3f v : world->fluid_particles(water).velocities) fastest = std::max(fastest, length(Vec3(v)));
        EXPECT_LT(fastest, 0.04) << open;
    }
}

// The water has to spread into what the filling left out beside the walls, so it sloshes a little.
TEST(FluidStill, InTanksAnywhereInTheGrid) {
    double largest = 0;
    for (unsigned seed = 0; seed < 12; ++seed) {
        StillTank tank(seed, false);
        run(*tank.world, 5);
        EXPECT_LT(tank.mean_speed(), 0.04) << seed;
        EXPECT_LT(tank.farthest_outside(), cell / 4) << seed;
        largest = std::max(largest, tank.mean_speed());
    }
    RecordProperty("largest mean speed, m/s", std::to_string(largest));
}

// Where two boxes meet at the corner of a tank the end of one is no thin wall in the water. Walls near 45° still have
// streams along them (docs/physics/fluids.md, "Still water"), in some tanks.
TEST(FluidStill, InTanksTurnedByAnyAngle) {
    int still = 0;
    double farthest = 0;
    for (unsigned seed = 0; seed < 12; ++seed) {
        StillTank tank(seed, true);
        run(*tank.world, 5);
        still += tank.mean_speed() < 0.04 ? 1 : 0;
        EXPECT_LT(tank.mean_speed(), 0.2) << seed;
        EXPECT_LT(tank.farthest_outside(), cell / 2) << seed;
        farthest = std::max(farthest, tank.farthest_outside());
    }
    RecordProperty("farthest outside, m", std::to_string(farthest));
    RecordProperty("still, of 12", still);
    EXPECT_GE(still, 11);
}

// In the mean over its swinging back and forth water only loses energy. It gained so much that its surface stood up to
// half a cell rough: friction met the fall that the pressure takes off, and what slits behind walls lacked was filled
// for ever. ½ ρ g A d² is the energy of a surface A of the roughness d.
TEST(FluidStill, WaterThatWasDroppedGainsNoEnergy) {
    double roughest = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
        StillTank tank(seed, false, 1);
        run(*tank.world, 3);
        const double early = tank.mean_energy(1);
        run(*tank.world, 5);
        const double gain = tank.mean_energy(1) - early, area = 4 * tank.length * tank.width;
        const double roughness = std::sqrt(std::max(0.0, gain) * 2 / (998 * gravity * area));
        EXPECT_LT(roughness, 0.15 * cell) << seed;
        roughest = std::max(roughest, roughness);
    }
    RecordProperty("roughest, cells", std::to_string(roughest / cell));
}

}  // namespace
}  // namespace embody::physics
