// SPDX-License-Identifier: MIT
#include "benches/convergence/closed_tanks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "physics/inter/world.h"

namespace embody::convergence {

namespace {

using namespace physics;

constexpr double half = 0.2, wall = 0.04, inner = half - wall / 2, cell = 0.034;  // m, `half` to the walls' middle

struct Tank {
    std::unique_ptr<World> world;
    BodyHandle body;
    FluidHandle water;
    double least = 0;  ///< potential energy that it can have at the least, J
};

/// How it begins.
struct Start {
    bool stands = false;              ///< the tank cannot move
    bool is_free = false;             ///< without gravity and ground
    double height = 0, filled = 0.6;  ///< of its middle, m; part of the inside
    bool is_heaped = false;           ///< the water to one side
    Vec3 spin;                        ///< rad/s
};

Result<Tank> build(const Start& start) {
    WorldSettings settings{.sleeping = false};
    if (start.is_free) settings.gravity = {};
    auto world = World::create(settings);
    if (!world) return world.error();
    Tank tank{std::move(*world), {}, {}};
    if (!start.is_free && !start.stands) {
        const auto plane = tank.world->create_shape(PlaneShape{});
        if (!plane) return plane.error();
        const auto ground = tank.world->create_body({.kind = BodyKind::static_body, .shape = *plane});
        if (!ground) return ground.error();
    }
    CompoundShape form;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {-1, 1}) {
            Vec3 size{half + wall / 2, half + wall / 2, half + wall / 2}, place;
            size[axis] = wall / 2;
            place[axis] = side * half;
            form.children.push_back({BoxShape{size}, {place, {}}});
        }
    }
    const auto shape = tank.world->create_shape(form);
    if (!shape) return shape.error();
    BodyDefinition definition{.kind = start.stands ? BodyKind::static_body : BodyKind::dynamic_body,
                              .shape = *shape,
                              .position = {0, start.height, 0}};
    definition.angular_velocity = start.spin;
    const auto body = tank.world->create_body(definition);
    if (!body) return body.error();
    tank.body = *body;
    const Vec3 low{-inner, start.height - inner, -inner};
    const Vec3 size = start.is_heaped ? Vec3{2 * inner * start.filled, 2 * inner, 2 * inner}
                                      : Vec3{2 * inner, 2 * inner * start.filled, 2 * inner};
    const auto water =
        tank.world->create_fluid({.boxes = {{low, low + size}}, .cell_size = cell, .allow_sleep = false});
    if (!water) return water.error();
    tank.water = *water;
    // At rest: the water level in the tank, and a tank that can fall upright on the ground.
    const double g = length(settings.gravity), floor = start.stands ? start.height : half + wall / 2;
    const FluidParticles particles = tank.world->fluid_particles(*water);
    const double mass = tank.world->fluid(*water)->density * particles.particle_volume *
                        static_cast<double>(particles.positions.size());
    tank.least = g * mass * (floor - inner + inner * start.filled);
    if (!start.stands && !start.is_free) tank.least += g * tank.world->mass(tank.body) * floor;
    return tank;
}

TankMoment moment_of(const Tank& tank, Vec3 first_momentum) {
    const World& world = *tank.world;
    const Conserved sum = world.conserved();
    TankMoment moment{.time = world.last_report().time, .energy = sum.energy() - tank.least};
    if (length(world.settings().gravity) > 0) return moment;
    const FluidParticles particles = world.fluid_particles(tank.water);
    const double drop = world.fluid(tank.water)->density * particles.particle_volume;
    double mass = world.mass(tank.body);
    Vec3 center = world.center_of_mass(tank.body) * mass;
    for (const Vec3f p : particles.positions) {
        mass += drop;
        center += (particles.origin + Vec3(p)) * drop;
    }
    moment.momentum = length(sum.linear_momentum - first_momentum);
    moment.spin = length(sum.angular_momentum - cross(center / mass, sum.linear_momentum));
    return moment;
}

Result<TankRun> follow(const Start& start, double seconds, double pause) {
    auto tank = build(start);
    if (!tank) return tank.error();
    World& world = *tank->world;
    const std::size_t count = world.fluid_particles(tank->water).positions.size();
    const Vec3 momentum = world.conserved().linear_momentum;
    TankRun run{.moments = {moment_of(*tank, momentum)}, .particles = count};
    const double dt = world.settings().time_step;
    const int steps = static_cast<int>(std::lround(seconds / dt)),
              apart = std::max(1, static_cast<int>(std::lround(pause / dt)));
    double least = run.moments[0].energy;
    run.highest = least;
    for (int i = 1; i <= steps; ++i) {
        world.step();
        const double energy = world.conserved().energy() - tank->least;
        run.highest = std::max(run.highest, energy);
        run.highest_gain = std::max(run.highest_gain, energy - least);
        least = std::min(least, energy);
        if (i % apart == 0) run.moments.push_back(moment_of(*tank, momentum));
    }
    run.lost = count - world.fluid_particles(tank->water).positions.size();
    return run;
}

Result<TankRun> slosh(double seconds, double pause) {
    return follow({.stands = true, .height = half, .is_heaped = true, .spin = {}}, seconds, pause);
}

Result<TankRun> float_free(double seconds, double pause) {
    return follow({.is_free = true, .spin = {3, 2, 7}}, seconds, pause);
}

Result<TankRun> land(double seconds, double pause) {
    return follow({.height = 0.5 + half + wall / 2, .spin = {2, 1, 3}}, seconds, pause);
}

constexpr std::array tanks{
    ClosedTank{"slosh", "water heaped up to one side of a tank that stands", slosh},
    ClosedTank{"free", "a tank in space that tumbles with its water", float_free},
    ClosedTank{"land", "a tank that falls by half a metre, tumbling, and comes to rest", land},
};

}  // namespace

std::span<const ClosedTank> closed_tanks() { return tanks; }

}  // namespace embody::convergence
