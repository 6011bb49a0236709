// SPDX-License-Identifier: MIT
#include "scenes/structures/fluid_tank.h"

#include <algorithm>
#include <cmath>
#include <memory>
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

// The mean height of the water's particles tells its volume; drafts are measured from the level that this gives.
void check(const Tank& tank, const TankToFill& definition, TankCost& cost) {
    const physics::FluidParticles particles = tank.world->fluid_particles(tank.water);
    cost.particles = particles.positions.size();
    double height = 0;
    for (const Vec3f p : particles.positions) height += particles.origin.y + Vec3(p).y;
    height /= static_cast<double>(cost.particles);
    const double volume = particles.particle_volume * static_cast<double>(cost.particles);
    const double displaced = 8 * float_half.x * float_half.y * float_half.z * float_density / density;
    const double area = tank_side * tank_side, level = (volume + definition.floats * displaced) / area;

    // Moment of a column less those of the holes at its top.
    const double draft = 2 * float_half.y * float_density / density;
    const double expected = (area * level * level / 2 - definition.floats * displaced * (level - draft / 2)) / volume;
    cost.volume_error = height / expected - 1;
    double error = 0;
    for (const BodyHandle body : tank.floats) {
        error += level - (tank.world->center_of_mass(body).y - float_half.y) - draft;
    }
    cost.draft_error = tank.floats.empty() ? 0 : error / static_cast<double>(tank.floats.size()) / (2 * float_half.y);
    constexpr double most_volume_error = 0.05, most_draft_error = 0.25;
    if (tank.world->last_report().limits != 0) cost.wrong = "limits were reached";
    if (!std::isfinite(tank.world->conserved().kinetic_energy)) cost.wrong = "not finite";
    if (std::fabs(cost.volume_error) > most_volume_error) cost.wrong = "volume has changed";
    if (std::fabs(cost.draft_error) > most_draft_error) cost.wrong = "things float at wrong depths";
}

}  // namespace

Result<TankCost> time_tank(const TankToFill& definition) {
    auto tank = fill_tank(definition);
    if (!tank) return tank.error();
    TankCost cost;
    const int steps = std::max(1, static_cast<int>(std::lround(definition.seconds * 60)));
    for (int i = 0; i < steps; ++i) {
        const physics::StepReport& report = tank->world->step();
        cost.step_ms += report.milliseconds / steps;
        cost.fluid_ms += report.stage_milliseconds[static_cast<std::size_t>(physics::StepStage::fluids)] / steps;
        cost.worst_step_ms = std::max(cost.worst_step_ms, report.milliseconds);
    }
    check(*tank, definition, cost);
    return cost;
}

}  // namespace embody::scenes
