// SPDX-License-Identifier: MIT
#include "benches/convergence/liquid_studies.h"

#include <array>

#include "benches/convergence/measurements.h"

namespace embody::convergence {

namespace {

using namespace physics;

Result<BodyHandle> add_box(World& world, Vec3 half_extents, BodyDefinition definition) {
    const auto shape = world.create_shape(BoxShape{half_extents});
    if (!shape) return shape.error();
    definition.shape = *shape;
    return world.create_body(definition);
}

/// A tank of five walls around the box from 0 to `inside`.
Result<std::unique_ptr<World>> tank(Vec3 inside, double rate) {
    auto world = World::create({.time_step = 1 / rate});
    if (!world) return world.error();
    constexpr double t = 0.25;
    const Vec3 half = 0.5 * inside;
    struct Wall {
        Vec3 half_extents, position;
    };
    const std::array walls{Wall{{half.x + 2 * t, t, half.z + 2 * t}, {half.x, -t, half.z}},
                           Wall{{t, half.y, half.z + 2 * t}, {-t, half.y, half.z}},
                           Wall{{t, half.y, half.z + 2 * t}, {inside.x + t, half.y, half.z}},
                           Wall{{half.x, half.y, t}, {half.x, half.y, -t}},
                           Wall{{half.x, half.y, t}, {half.x, half.y, inside.z + t}}};
    for (const Wall& wall : walls) {
        const auto body =
            add_box(**world, wall.half_extents, {.kind = BodyKind::static_body, .position = wall.position});
        if (!body) return body.error();
    }
    return world;
}

}  // namespace

Result<double> period_of_sloshing(int cells) {
    constexpr double rate = 120, tilt = 0.05;
    const double cell = tank_length / cells, across = 4 * cell;
    auto world = tank({tank_length, 2 * tank_depth, across}, rate);
    if (!world) return world.error();
    std::vector<Vec3> wedge;
    for (const double z : {0.0, across}) {
        wedge.insert(wedge.end(), {{0, 0, z},
                                   {tank_length, 0, z},
                                   {0, tank_depth - tilt * tank_length / 2, z},
                                   {tank_length, tank_depth + tilt * tank_length / 2, z}});
    }
    const auto water = (*world)->create_fluid(
        {.hulls = {wedge}, .density = water_density, .viscosity = 0, .cell_size = cell, .allow_sleep = false});
    if (!water) return water.error();
    const auto middle = [&] {
        const FluidParticles particles = (*world)->fluid_particles(*water);
        double sum = 0;
        for (const Vec3f p : particles.positions) sum += Vec3(p).x;
        return particles.origin.x + sum / static_cast<double>(particles.positions.size());
    };
    return period_of(record(**world, 6, middle), 1 / rate);
}

Result<double> draft_of_slab(int cells) {
    const double cell = tank_length / cells;
    auto world = tank({tank_length, 2 * tank_depth, tank_length}, 60);
    if (!world) return world.error();
    const auto water = (*world)->create_fluid({.boxes = {{{0, 0, 0}, {tank_length, tank_depth, tank_length}}},
                                               .density = water_density,
                                               .cell_size = cell,
                                               .allow_sleep = false});
    if (!water) return water.error();
    constexpr Vec3 half{0.2, slab_height / 2, 0.2};
    // The slab starts a little above its equilibrium and sinks into the water.
    const double begin = tank_depth + slab_height / 2 - 0.9 * slab_height * slab_density / water_density;
    const auto slab = add_box(**world, half,
                              {.position = {tank_length / 2, begin, tank_length / 2},
                               .mass = {.density = slab_density},
                               .allow_sleep = false});
    if (!slab) return slab.error();
    run(**world, 6);
    // The mean over one second, in case the slab still oscillates. The displaced water raises the surface around it.
    const double bottom_area = 4 * half.x * half.z;
    double sum = 0;
    const auto heights = record(**world, 1, [&] { return (*world)->pose(*slab).position.y; });
    for (const double height : heights) sum += height / static_cast<double>(heights.size());
    const FluidParticles particles = (*world)->fluid_particles(*water);
    const double volume = particles.particle_volume * static_cast<double>(particles.positions.size());
    // V = (1 - a) surface + a (surface - draft) with the tank's area 1, a the slab's: surface = V + a draft.
    const double bottom = sum - half.y;
    return (volume - bottom) / (1 - bottom_area);
}

}  // namespace embody::convergence
