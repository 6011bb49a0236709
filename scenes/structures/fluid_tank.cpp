// SPDX-License-Identifier: MIT
#include "scenes/structures/fluid_tank.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "foundation/random.h"
#include "physics/inter/world.h"

namespace embody::scenes {

namespace {

using physics::BodyHandle;
using physics::BodyKind;
using physics::FluidHandle;
using physics::World;

constexpr double tank_side = 1, water_depth = 0.5, density = 998, float_density = 600;
constexpr Vec3 float_half{0.08, 0.04, 0.08};

/// The scene while it runs.
struct Tank {
    std::unique_ptr<World> world;
    FluidHandle water;
    std::vector<BodyHandle> floats;
};

Result<BodyHandle> add_box(World& world, Vec3 half, physics::BodyDefinition definition) {
    const auto shape = world.create_shape(physics::BoxShape{half});
    if (!shape) return shape.error();
    definition.shape = *shape;
    return world.create_body(definition);
}

Result<void> add_walls(World& world) {
    const double t = 0.1, half = tank_side / 2, height = 0.5;
    const auto ground = world.create_shape(physics::PlaneShape{});
    if (!ground) return ground.error();
    const auto floor = world.create_body({.kind = BodyKind::static_body, .shape = *ground});
    if (!floor) return floor.error();
    for (const int side : {-1, 1}) {
        const auto x = add_box(world, {t, height, half + 2 * t},
                               {.kind = BodyKind::static_body, .position = {side * (half + t), height, 0}});
        if (!x) return x.error();
        const auto z = add_box(world, {half, height, t},
                               {.kind = BodyKind::static_body, .position = {0, height, side * (half + t)}});
        if (!z) return z.error();
    }
    return {};
}

Result<Tank> fill_tank(const TankToFill& definition) {
    auto world = World::create({.workers = definition.workers});
    if (!world) return world.error();
    Tank tank{std::move(*world), {}, {}};
    if (auto walls = add_walls(*tank.world); !walls) return walls.error();

    // Boxes afloat on a lattice, the others in stacks beside the tank.
    Random random(5);
    for (int i = 0; i < definition.bodies; ++i) {
        physics::BodyDefinition body{.mass = {.density = float_density}};
        const bool floats = i < definition.floats;
        if (floats) {
            body.position = {-0.36 + 0.18 * (i % 5), water_depth + 0.1 + 0.1 * random.between(0, 1),
                             -0.36 + 0.24 * (i / 5 % 4)};
        } else {
            const int k = i - definition.floats;
            body.position = {2 + 0.4 * (k % 6), 0.1 + 0.2 * (k / 36), -1.2 + 0.4 * (k / 6 % 6)};
        }
        const auto added = add_box(*tank.world, floats ? float_half : Vec3{0.1, 0.1, 0.1}, body);
        if (!added) return added.error();
        if (floats) tank.floats.push_back(*added);
    }

    // It begins heaped up to one side.
    const double volume = tank_side * tank_side * water_depth, half = tank_side / 2;
    const double step = std::cbrt(volume / definition.particles);
    const auto water =
        tank.world->create_fluid({.boxes = {{{-half, 0, -half}, {half, water_depth * 0.9, half}},
                                            {{-half, water_depth * 0.9, -half}, {0, water_depth * 1.1, half}}},
                                  .density = density,
                                  .cell_size = 2 * step});
    if (!water) return water.error();
    tank.water = *water;
    return tank;
}

/// What the water's volume and the floats' weight make of the tank at rest.
struct Expected {
    double level, mean_height, draft;  ///< m
};

Expected expected_of(const TankToFill& definition, double volume) {
    const double displaced = 8 * float_half.x * float_half.y * float_half.z * float_density / density;
    const double area = tank_side * tank_side, level = (volume + definition.floats * displaced) / area;
    // Moment of a column less those of the holes at its top.
    const double draft = 2 * float_half.y * float_density / density;
    const double moment = area * level * level / 2 - definition.floats * displaced * (level - draft / 2);
    return {level, moment / volume, draft};
}

double volume_of(const physics::FluidParticles& water) {
    return water.particle_volume * static_cast<double>(water.positions.size());
}

// How much deeper than expected things float now, of their height, in the mean.
double draft_error(const Tank& tank, const TankToFill& definition) {
    const Expected expected = expected_of(definition, volume_of(tank.world->fluid_particles(tank.water)));
    double error = 0;
    for (const BodyHandle body : tank.floats) {
        error += expected.level - (tank.world->center_of_mass(body).y - float_half.y) - expected.draft;
    }
    return tank.floats.empty() ? 0 : error / static_cast<double>(tank.floats.size()) / (2 * float_half.y);
}

// The mean height of the water's particles tells its volume; drafts are measured from the level that this gives.
void check(const Tank& tank, const TankToFill& definition, TankCost& cost) {
    const physics::FluidParticles particles = tank.world->fluid_particles(tank.water);
    cost.particles = particles.positions.size();
    double height = 0;
    for (const Vec3f p : particles.positions) height += particles.origin.y + Vec3(p).y;
    height /= static_cast<double>(cost.particles);
    cost.volume_error = height / expected_of(definition, volume_of(particles)).mean_height - 1;
    constexpr double most_volume_error = 0.02, most_draft_error = 0.08;
    if (tank.world->last_report().limits != 0) cost.wrong = "limits were reached";
    if (!std::isfinite(tank.world->conserved().kinetic_energy)) cost.wrong = "not finite";
    if (std::fabs(cost.volume_error) > most_volume_error) cost.wrong = "volume has changed";
    if (std::fabs(cost.draft_error) > most_draft_error) cost.wrong = "things float at wrong depths";
}

}  // namespace

void TankCost::take_faster(const TankCost& other) {
    const auto faster = [](std::vector<double>& own, const std::vector<double>& others) {
        for (std::size_t i = 0; i < own.size(); ++i) own[i] = std::min(own[i], others[i]);
    };
    faster(fluid_ms, other.fluid_ms);
    faster(step_ms, other.step_ms);
}

double TankCost::mean(const std::vector<double>& steps) {
    return std::accumulate(steps.begin(), steps.end(), 0.0) / static_cast<double>(steps.size());
}

Result<TankCost> time_tank(const TankToFill& definition) {
    auto tank = fill_tank(definition);
    if (!tank) return tank.error();
    TankCost cost;
    const int steps = std::max(1, static_cast<int>(std::lround(definition.seconds * 60))), last = std::min(steps, 60);
    for (int i = 0; i < steps; ++i) {
        const physics::StepReport& report = tank->world->step();
        cost.step_ms.push_back(report.milliseconds);
        cost.fluid_ms.push_back(report.stage_milliseconds[static_cast<std::size_t>(physics::StepStage::fluids)]);
        if (i >= steps - last) cost.draft_error += draft_error(*tank, definition) / last;
    }
    check(*tank, definition, cost);
    return cost;
}

}  // namespace embody::scenes
