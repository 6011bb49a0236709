// SPDX-License-Identifier: MIT
// Liquids at rest: pressure, force on the bottom, what floats, how deep and at which angle (reference-cases.json).
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

double draft_error_bound(const nlohmann::json& reference) { return reference.at("tolerance").at("rel").get<double>(); }

TEST(FluidBuoyancy, PressureAndForceOnTheBottomAreTheWeight) {
    const auto reference = reference_case("hydrostatic");
    const double depth = reference.at("setup").at("depth").get<double>();
    const double rho = reference.at("setup").at("rho").get<double>();
    auto world = make_world({});
    const BodyHandle bottom = add_tank(*world, {{-0.5, 0, -0.5}, {0.5, depth + 0.4, 0.5}});
    const FluidHandle water =
        world
            ->create_fluid(
                {.boxes = {{{-0.5, 0, -0.5}, {0.5, depth, 0.5}}}, .density = rho, .viscosity = 0, .cell_size = 0.05})
            .value();
    run(*world, 1.5);
    // Mean of half a second, while it still sways.
    double force = 0, pressure = 0;
    constexpr int steps = 30;
    for (int i = 0; i < steps; ++i) {
        world->step();
        force -= world->fluid_force(bottom).force.y / steps;
        pressure += world->fluid_pressure(water, {0.013, 0.025, -0.021}) / steps;
    }
    const double expected_force = reference.at("expected").at("F").get<double>();
    const double expected_pressure = reference.at("expected").at("p").get<double>() * (depth - 0.025) / depth;
    EXPECT_NEAR(force, expected_force, expected_force * reference.at("tolerance").at("F_rel").get<double>());
    EXPECT_NEAR(pressure, expected_pressure, expected_pressure * reference.at("tolerance").at("rel").get<double>());
    RecordProperty("force", std::to_string(force));
    RecordProperty("pressure", std::to_string(pressure));
}

/// A body in a tank of water, and the water's level when it floats: from the volumes, not from the particles.
struct Floating {
    std::unique_ptr<World> world;
    BodyHandle body;
    FluidHandle water;
};

Floating float_box(Vec3 half, double density, double cell, Vec3 tank, double depth, Quat rotation = {}) {
    Floating scene{make_world({}), {}, {}};
    add_tank(*scene.world, {{-tank.x / 2, 0, -tank.z / 2}, {tank.x / 2, tank.y, tank.z / 2}});
    scene.body = add_box(*scene.world, half,
                         {.position = {0.004, depth, 0.003}, .rotation = rotation, .mass = {.density = density}});
    scene.water = scene.world
                      ->create_fluid({.boxes = {{{-tank.x / 2, 0, -tank.z / 2}, {tank.x / 2, depth, tank.z / 2}}},
                                      .density = 1000,
                                      .cell_size = cell})
                      .value();
    return scene;
}

TEST(FluidBuoyancy, ASlabOfWoodFloatsAsDeepAsItsDensityTells) {
    const auto reference = reference_case("buoyancy_slab");
    const Vec3 size = {0.5, 0.1, 0.5};
    const Vec3 tank{1.0, 0.6, 1.0};
    Floating scene = float_box(size * 0.5, reference.at("setup").at("rho").get<double>(), 0.04, tank, 0.3);
    run(*scene.world, 5);
    // Mean of several swings.
    double height = 0;
    constexpr int steps = 300;
    for (int i = 0; i < steps; ++i) {
        scene.world->step();
        height += scene.world->pose(scene.body).position.y / steps;
    }
    // Level: the liquid's volume and what the slab displaces at rest over the tank's area.
    const double expected = reference.at("expected").at("draft").get<double>();
    const double level = (volume_of(*scene.world, scene.water) + expected * size.x * size.z) / (tank.x * tank.z);
    const double draft = level - (height - size.y / 2);
    EXPECT_NEAR(draft, expected, expected * draft_error_bound(reference));
    RecordProperty("draft", std::to_string(draft));
}

TEST(FluidBuoyancy, ACubeFloatsUprightOnlyIfItIsLightOrHeavy) {
    const auto reference = reference_case("cube_tilt");
    const double size = reference.at("setup").at("size").get<double>();
    for (std::size_t i = 0; i < 3; ++i) {
        const double density = reference.at("setup").at("rho").at(i).get<double>();
        const bool is_upright = reference.at("expected").at("upright").at(i).get<bool>();
        // At its depth, so that it does not swing up and down; it rocks about where it is stable, with little damping.
        const double depth = 0.5, level = depth + density / 1000 * size * size * size / (0.9 * 0.9);
        Floating scene = float_box(Vec3{size, size, size} * 0.5, density, 0.05, {0.9, 0.9, 0.9}, depth,
                                   from_axis_angle(normalized(Vec3{1, 0, 0.3}), 0.1));
        Transform start = scene.world->pose(scene.body);
        start.position.y = level + size * (0.5 - density / 1000);
        ASSERT_TRUE(scene.world->set_pose(scene.body, start));
        run(*scene.world, 4);
        Vec3 axis;
        for (int step = 0; step < 360; ++step) {
            scene.world->step();
            axis += rotate(scene.world->pose(scene.body).rotation, {0, 1, 0});
        }
        const double degrees = std::acos(std::min(1.0, axis.y / length(axis))) * 180 / pi;
        RecordProperty("tilt_" + std::to_string(static_cast<int>(density)), std::to_string(degrees));
        if (is_upright) {
            EXPECT_LT(degrees, 5) << density;
        } else {
            EXPECT_GT(degrees, 15) << density;
        }
    }
}

TEST(FluidBuoyancy, ASubmergedCubeWeighsLessByTheWaterItDisplaces) {
    const auto reference = reference_case("submerged_weight");
    const double size = reference.at("setup").at("size").get<double>();
    auto world = make_world({});
    add_tank(*world, {{-0.25, 0, -0.25}, {0.25, 0.6, 0.25}});
    // It stands on four feet so that water is below it, too.
    const BodyHandle cube = add_box(
        *world, Vec3{size, size, size} * 0.5,
        {.position = {0.007, 0.151, -0.004}, .mass = {.density = reference.at("setup").at("rho").get<double>()}});
    for (const double x : {-0.03, 0.03}) {
        for (const double z : {-0.03, 0.03})
            add_box(*world, {0.004, 0.05, 0.004}, {.kind = BodyKind::static_body, .position = {x, 0.05, z}});
    }
    ASSERT_TRUE(
        world->create_fluid({.boxes = {{{-0.25, 0, -0.25}, {0.25, 0.4, 0.25}}}, .density = 1000, .cell_size = 0.025}));
    run(*world, 2);
    double weight = 0;
    constexpr int steps = 60;
    for (int i = 0; i < steps; ++i) {
        world->step();
        weight += (world->mass(cube) * gravity - world->fluid_force(cube).force.y) / steps;
    }
    const double expected = reference.at("expected").at("W").get<double>();
    EXPECT_NEAR(weight, expected, expected * reference.at("tolerance").at("rel").get<double>());
    EXPECT_LT(length(world->linear_velocity(cube)), 1e-3);
    RecordProperty("weight", std::to_string(weight));
}

}  // namespace
}  // namespace embody::physics
