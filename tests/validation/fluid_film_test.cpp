// SPDX-License-Identifier: MIT
// Boxes that lie on the floor of a pool: liquid gets under them (docs/physics/fluids.md, "Films").
#include <algorithm>
#include <string>
#include <vector>

#include "validation/fluid_scenes.h"
#include "validation/random_bodies.h"

namespace embody::physics {
namespace {

constexpr double cell = 0.04, depth = 0.34, water = 1000;  // m, m, kg/m³
constexpr Vec3 pool{0.56, 0.7, 0.52};                      // inside, m

/// A box in a pool, flat enough to float upright.
struct BoxInPool {
    std::unique_ptr<World> world;
    BodyHandle box;
    FluidHandle liquid;
    Vec3 half;
    double density = 0;

    // Of the surface with the box afloat or below it, from the volumes.
    [[nodiscard]] double level() const {
        const double displaced = std::min(density / water, 1.0) * 8 * half.x * half.y * half.z;
        return (volume_of(*world, liquid) + displaced) / (pool.x * pool.z);
    }
};

enum class Start { floor, wall, dropped };

BoxInPool random_box(Random& random, Start start, double low_density, double high_density, int workers = 1) {
    BoxInPool scene{make_world({.workers = workers}), {}, {}, {}, random.between(low_density, high_density)};
    add_tank(*scene.world, {{-pool.x / 2, 0, -pool.z / 2}, {pool.x / 2, pool.y, pool.z / 2}});
    scene.half = {random.between(0.07, 0.12), 0, random.between(0.07, 0.12)};
    scene.half.y = random.between(0.04, 0.055);
    Vec3 place{random.between(-0.1, 0.1), scene.half.y, random.between(-0.1, 0.1)};
    const double gap = random.below(2) == 0 ? 0 : random.between(0, 0.05);
    if (start == Start::wall) place.x = pool.x / 2 - scene.half.x - gap;
    if (start == Start::dropped) place.y = depth + random.between(0.05, 0.3);
    scene.box = add_box(*scene.world, scene.half, {.position = place, .mass = {.density = scene.density}});
    scene.liquid = scene.world
                       ->create_fluid({.boxes = {{{-pool.x / 2, 0, -pool.z / 2}, {pool.x / 2, depth, pool.z / 2}}},
                                       .density = water,
                                       .cell_size = cell})
                       .value();
    return scene;
}

double mean_height(BoxInPool& scene, double seconds) {
    double height = 0;
    const int steps = static_cast<int>(seconds * 60);
    for (int i = 0; i < steps; ++i) {
        scene.world->step();
        height += scene.world->pose(scene.box).position.y / steps;
    }
    return height;
}

std::string told(const BoxInPool& scene, int number) {
    return "box " + std::to_string(number) + " of " + std::to_string(scene.density) + " kg/m³, " +
           std::to_string(2 * scene.half.x) + " × " + std::to_string(2 * scene.half.y) + " × " +
           std::to_string(2 * scene.half.z) + " m";
}

TEST(FluidFilm, LightBoxesOnTheFloorOfAPoolComeUpAndFloatAsDeepAsTheyWeigh) {
    Random random(41);
    const int cases = wanted_cases("EMBODY_FILM_CASES", 6);
    double worst = 0;
    for (int i = 0; i < cases; ++i) {
        BoxInPool scene = random_box(random, static_cast<Start>(i % 3), 200, 980);
        run(*scene.world, 8);
        const double height = mean_height(scene, 2);
        const double draft = scene.level() - (height - scene.half.y), right = scene.density / water * 2 * scene.half.y;
        worst = std::max(worst, std::fabs(draft - right));
        // A fifth of a cell: drafts of boxes of about a cell are a few per cent off.
        EXPECT_NEAR(draft, right, 0.2 * cell) << told(scene, i) << ", start " << i % 3;
    }
    RecordProperty("worst_draft_error_in_mm", std::to_string(1000 * worst));
}

TEST(FluidFilm, HeavyBoxesInAPoolLieStillOnItsFloorAndWeighLessByTheWaterTheyDisplace) {
    Random random(42);
    const int cases = wanted_cases("EMBODY_FILM_CASES", 6);
    double worst = 0;
    for (int i = 0; i < cases; ++i) {
        const auto start = static_cast<Start>(i % 3);
        BoxInPool scene = random_box(random, start, 1020, 2000);
        run(*scene.world, 10);
        const Vec3 place = scene.world->pose(scene.box).position;
        run(*scene.world, 2);
        EXPECT_NEAR(scene.world->pose(scene.box).position.y, scene.half.y, 0.002) << told(scene, i);
        EXPECT_LT(length(scene.world->pose(scene.box).position - place), 1e-4) << told(scene, i);
        // Water that a box has fallen into still sloshes, and sleeps later.
        if (start != Start::dropped)
            EXPECT_EQ(scene.world->sleep_state(scene.box), SleepState::asleep) << told(scene, i);
        const double volume = 8 * scene.half.x * scene.half.y * scene.half.z;
        const double lift = scene.world->fluid_force(scene.box).force.y / (volume * water * gravity);
        worst = std::max(worst, std::fabs(lift - 1));
        EXPECT_NEAR(lift, 1, 0.02) << told(scene, i);
    }
    RecordProperty("worst_error_of_lift", std::to_string(worst));
}

TEST(FluidFilm, SameBitsForAnyNumberOfWorkers) {
    std::vector<Vec3> places;
    for (const int workers : {1, 2}) {
        Random random(43);
        BoxInPool scene = random_box(random, Start::floor, 600, 700, workers);
        run(*scene.world, 1);
        places.push_back(scene.world->pose(scene.box).position);
    }
    EXPECT_EQ(places[0], places[1]);
    EXPECT_GT(places[0].y, 0.08) << "it rises";
}

}  // namespace
}  // namespace embody::physics
