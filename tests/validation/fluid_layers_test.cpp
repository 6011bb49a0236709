// SPDX-License-Identifier: MIT
// Liquids of different density and viscosity in one tank: they lie in layers, turn over, and carry what floats between
// them (docs/physics/fluids.md, "Several liquids").
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "validation/fluid_scenes.h"
#include "validation/random_bodies.h"

namespace embody::physics {
namespace {

constexpr double layer_cell = 0.04;          // m
constexpr Vec3 layer_tank{0.36, 0.8, 0.32};  // inside, m

/// Liquids in a tank, from the lowest to the highest at the start.
struct Layers {
    struct Layer {
        LiquidMatter matter;
        double height = 0;  // m
        FluidIds ids;
    };
    std::unique_ptr<World> world;
    FluidHandle fluid;
    std::vector<Layer> layers;

    explicit Layers(std::vector<Layer> given, int workers = 1)
        : world(make_world({.workers = workers})), layers(std::move(given)) {
        add_tank(*world,
                 {{-layer_tank.x / 2, 0, -layer_tank.z / 2}, {layer_tank.x / 2, layer_tank.y, layer_tank.z / 2}});
    }
    // Fills the tank. All particles have the volume of the first layer's.
    void fill() {
        double floor = 0;
        for (Layer& layer : layers) {
            const Bounds box{{-layer_tank.x / 2, floor, -layer_tank.z / 2},
                             {layer_tank.x / 2, floor + layer.height, layer_tank.z / 2}};
            floor = box.upper.y;
            if (&layer == &layers.front()) {
                const LiquidMatter& matter = layer.matter;
                fluid = world
                            ->create_fluid({.boxes = {box},
                                            .density = matter.density,
                                            .viscosity = matter.viscosity,
                                            .cell_size = layer_cell})
                            .value();
                layer.ids = {0, static_cast<std::uint32_t>(world->fluid_particles(fluid).ids.size())};
                continue;
            }
            layer.ids = world->add_to_fluid(fluid, places_in(box)).value();
            ASSERT_TRUE(world->set_liquid(fluid, layer.ids, layer.matter));
        }
    }
    static std::vector<Vec3> places_in(const Bounds& box) {
        std::array<int, 3> counts{};
        for (std::size_t a = 0; a < 3; ++a)
            counts[a] = static_cast<int>(std::lround(box.size()[static_cast<int>(a)] / (layer_cell / 2)));
        std::vector<Vec3> places;
        for (int z = 0; z < counts[2]; ++z) {
            for (int y = 0; y < counts[1]; ++y) {
                for (int x = 0; x < counts[0]; ++x) {
                    const Vec3 at{(x + 0.5) / counts[0], (y + 0.5) / counts[1], (z + 0.5) / counts[2]};
                    places.push_back(box.lower + Vec3{at.x * box.size().x, at.y * box.size().y, at.z * box.size().z});
                }
            }
        }
        return places;
    }
    // Heights of a layer's particles, m.
    [[nodiscard]] std::vector<double> heights(const Layer& layer) const {
        const FluidParticles particles = world->fluid_particles(fluid);
        std::vector<double> heights;
        for (std::size_t i = 0; i < particles.ids.size(); ++i) {
            if (layer.ids.contains(particles.ids[i]))
                heights.push_back(particles.origin.y + static_cast<double>(particles.positions[i].y));
        }
        return heights;
    }
    // Of a layer's particles, m³.
    [[nodiscard]] double volume(const Layer& layer) const {
        return static_cast<double>(heights(layer).size()) * world->fluid_particles(fluid).particle_volume;
    }
    // Thickness of a layer at rest, m.
    [[nodiscard]] double thickness(const Layer& layer) const { return volume(layer) / (layer_tank.x * layer_tank.z); }
    // The layers by density, the heaviest first.
    [[nodiscard]] std::vector<Layer> settled() const {
        std::vector<Layer> sorted = layers;
        std::ranges::stable_sort(sorted, std::greater{}, [](const Layer& layer) { return layer.matter.density; });
        return sorted;
    }
    // Runs, and expects that the energy never exceeds that of the start.
    void run(double seconds) {
        const double start = energy(*world), rounding = 1e-6 * std::fabs(start);
        double highest = start;
        for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
            world->step();
            highest = std::max(highest, energy(*world));
        }
        EXPECT_LE(highest, start + rounding);
        EXPECT_EQ(world->last_report().limits, 0u);
    }
    // Expects layers by density, each as high as its volume says: mean heights, and all but some particles in them.
    void expect_layers(double tolerance, double strays) const {
        double floor = 0;
        for (const Layer& layer : settled()) {
            const double ceiling = floor + thickness(layer);
            double sum = 0, outside = 0;
            const std::vector<double> all = heights(layer);
            for (const double y : all) {
                sum += y;
                outside += y < floor - layer_cell || y > ceiling + layer_cell;
            }
            const double count = static_cast<double>(all.size());
            EXPECT_NEAR(sum / count, (floor + ceiling) / 2, tolerance) << layer.matter.density << " kg/m³";
            EXPECT_LE(outside / count, strays) << layer.matter.density << " kg/m³";
            floor = ceiling;
        }
    }
};

LiquidMatter any_liquid(Random& random, double density) {
    return {.density = density, .viscosity = std::exp(random.between(std::log(0.0005), std::log(0.5)))};
}

double any_height(Random& random) { return layer_cell * (3 + static_cast<double>(random.below(3))); }

// Ratios of density from 1.05 to 3, and that of mercury and water.
std::pair<double, double> any_densities(Random& random, int trial) {
    const double light = random.between(700, 1100);
    return {light, trial == 0 ? 13.6 * light : light * random.between(1.05, 3)};
}

TEST(FluidLayers, LighterLiquidLiesStillOnHeavierOne) {
    Random random(71);
    for (int trial = 0; trial < 6; ++trial) {
        const auto [light, heavy] = any_densities(random, trial);
        Layers scene(
            {{any_liquid(random, heavy), any_height(random), {}}, {any_liquid(random, light), any_height(random), {}}});
        scene.fill();
        const double volume = volume_of(*scene.world, scene.fluid);
        scene.run(6);
        EXPECT_EQ(volume_of(*scene.world, scene.fluid), volume);
        EXPECT_TRUE(scene.world->fluid_particles(scene.fluid).is_asleep);
        // No particle has come into the other liquid.
        const auto below = scene.heights(scene.layers[0]), above = scene.heights(scene.layers[1]);
        EXPECT_LT(*std::ranges::max_element(below), *std::ranges::min_element(above));
        scene.expect_layers(0.006, 0);
        // The weight of what lies between two places, within each liquid and across the surface between both.
        const double interface = scene.layers[0].height;
        const auto fall = [&](double from, double to) {
            return scene.world->fluid_pressure(scene.fluid, {0.02, from, 0.02}) -
                   scene.world->fluid_pressure(scene.fluid, {0.02, to, 0.02});
        };
        const double h = layer_cell, weight = gravity * h;
        // What sleeps may have swung at up to 1 cm/s until then, with the tank's slowest period.
        const double swing = 0.01 * std::sqrt(pi / (layer_tank.x * gravity));
        EXPECT_NEAR(fall(h / 2, 3 * h / 2), heavy * weight, swing * heavy * weight);
        EXPECT_NEAR(fall(interface + h / 2, interface + 3 * h / 2), light * weight, swing * light * weight);
        EXPECT_NEAR(fall(interface - 3 * h / 2, interface + 3 * h / 2), 1.5 * (heavy + light) * weight,
                    0.12 * (heavy - light) * weight)
            << light << " on " << heavy;
    }
}

TEST(FluidLayers, HeavierLiquidOnLighterOneTurnsOver) {
    Random random(72);
    for (int trial = 0; trial < 6; ++trial) {
        const auto [light, heavy] = any_densities(random, trial);
        Layers scene(
            {{any_liquid(random, light), any_height(random), {}}, {any_liquid(random, heavy), any_height(random), {}}});
        scene.fill();
        const std::string what = std::to_string(heavy) + " kg/m³, " + std::to_string(scene.layers[1].matter.viscosity) +
                                 " Pa s on " + std::to_string(light) + ", " +
                                 std::to_string(scene.layers[0].matter.viscosity);
        SCOPED_TRACE(what);
        scene.run(25);
        scene.expect_layers(0.006, 0.02);
    }
}

TEST(FluidLayers, ThreeLiquidsInAnyOrderLieByDensity) {
    Random random(73);
    for (int trial = 0; trial < 3; ++trial) {
        std::vector<Layers::Layer> layers;
        for (const double density : {800.0, 1000.0, 1300.0})
            layers.push_back({any_liquid(random, density), any_height(random), {}});
        std::rotate(layers.begin(), layers.begin() + trial, layers.end());
        std::swap(layers[0], layers[1]);
        Layers scene(std::move(layers));
        scene.fill();
        scene.run(25);
        scene.expect_layers(0.008, 0.03);
    }
}

TEST(FluidLayers, ABoxFloatsBetweenThemAsArchimedesSays) {
    Random random(74);
    for (int trial = 0; trial < 4; ++trial) {
        const double light = random.between(750, 900), heavy = random.between(1000, 1300);
        const double sunk = random.between(0.3, 0.7);  // fraction of the box in the heavier liquid
        Layers scene(
            {{any_liquid(random, heavy), 5 * layer_cell, {}}, {any_liquid(random, light), 5 * layer_cell, {}}});
        const Vec3 half{random.between(0.06, 0.09), random.between(0.04, 0.05), random.between(0.06, 0.09)};
        const double density = sunk * heavy + (1 - sunk) * light;
        const BodyHandle box =
            add_box(*scene.world, half, {.position = {0, 5 * layer_cell, 0}, .mass = {.density = density}});
        scene.fill();
        scene.run(8);
        double height = 0;
        for (int i = 0; i < 120; ++i) {
            scene.world->step();
            height += scene.world->pose(box).position.y / 120;
        }
        const double below = scene.volume(scene.layers[0]) + sunk * 8 * half.x * half.y * half.z;
        const double interface = below / (layer_tank.x * layer_tank.z);
        EXPECT_NEAR(height, interface + (1 - 2 * sunk) * half.y, 0.008)
            << density << " kg/m³ between " << light << " and " << heavy;
    }
}

TEST(FluidLayers, AreTheSameForAnyNumberOfWorkers) {
    const auto hashes = [](int workers) {
        Random random(75);
        Layers scene({{any_liquid(random, 800), 0.12, {}}, {any_liquid(random, 1300), 0.12, {}}}, workers);
        scene.fill();
        std::vector<std::uint64_t> found;
        for (int i = 0; i < 120; ++i) {
            scene.world->step();
            if (i % 20 == 0) found.push_back(scene.world->state_hash());
        }
        return found;
    };
    const auto one = hashes(1);
    EXPECT_EQ(hashes(2), one);
    EXPECT_EQ(hashes(5), one);
}

}  // namespace
}  // namespace embody::physics
