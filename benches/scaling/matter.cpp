// SPDX-License-Identifier: MIT
#include "benches/scaling/matter.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "physics/definitions/grain_material.h"
#include "physics/inter/world.h"

namespace embody::scaling {

namespace {

using namespace physics;

/// A world and what moves in it.
struct Moving {
    std::unique_ptr<World> world;
    std::vector<DeformableHandle> deformables;
    FluidHandle fluid;
    std::vector<BodyHandle> grains;
    std::size_t elements = 0;
    double energy = 0;  ///< at the start, J
};

Result<void> add_static(World& world, const ShapeDefinition& form, Vec3 position, const Material& material = {}) {
    const auto shape = world.create_shape(form);
    if (!shape) return shape.error();
    const auto body =
        world.create_body({.kind = BodyKind::static_body, .shape = *shape, .position = position, .material = material});
    return body ? Result<void>() : body.error();
}

Result<void> add_cloth(int edges, Moving& scene) {
    constexpr double side = 1.4, box_side = 0.9, box_height = 0.7;
    const Vec3 half{box_side / 2, box_height / 2, box_side / 2};
    if (auto box = add_static(*scene.world, BoxShape{half}, {0, half.y, 0}); !box) return box;
    // Three edges a node, each node's share of area √¾ edge².
    const double edge = side / std::sqrt(std::sqrt(0.75) * edges / 3.0);
    auto sheet = cloth_rectangle(side, side, edge, {.area_density = 0.2, .rayleigh_damping = 0.005});
    sheet.pose = {{0, box_height + 0.05, 0}, {}};
    scene.elements = 3 * sheet.nodes.size();
    const auto made = scene.world->create_deformable(sheet);
    if (!made) return made.error();
    scene.deformables.push_back(*made);
    return {};
}

Result<void> add_solids(int tetrahedra, Moving& scene) {
    constexpr int bricks = 8;
    const int cells = std::max(1, static_cast<int>(std::lround(std::cbrt(tetrahedra / (6.0 * bricks)))));
    Random random(3);
    for (int i = 0; i < bricks; ++i) {
        auto brick = tetrahedral_brick({0.3, 0.3, 0.3}, {cells, cells, cells},
                                       {.density = 1000, .youngs_modulus = 2e5, .poisson_ratio = 0.4});
        const Vec3 axis{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        brick.pose = {{0.5 * (i % 2), 0.4 + 0.5 * (i / 4), 0.5 * (i / 2 % 2)},
                      from_axis_angle(normalized(axis, {0, 1, 0}), random.between(0, 0.5))};
        const auto made = scene.world->create_deformable(brick);
        if (!made) return made.error();
        scene.deformables.push_back(*made);
        scene.elements += static_cast<std::size_t>(6 * cells * cells * cells);
    }
    return {};
}

Result<void> add_dam(int particles, Moving& scene) {
    constexpr double length = 2, width = 0.5, column = 0.6, height = 0.8, wall = 0.1, high = 0.6;
    const auto side = [&](Vec3 half, Vec3 place) { return add_static(*scene.world, BoxShape{half}, place); };
    for (const double x : {-wall, length + wall})
        if (auto made = side({wall, high, width / 2 + 2 * wall}, {x, high, 0}); !made) return made;
    for (const double z : {-width / 2 - wall, width / 2 + wall})
        if (auto made = side({length / 2, high, wall}, {length / 2, high, z}); !made) return made;
    const double cell = 2 * std::cbrt(column * height * width / particles);
    const auto made = scene.world->create_fluid(
        {.boxes = {{{0, 0, -width / 2}, {column, height, width / 2}}}, .cell_size = cell, .allow_sleep = false});
    if (!made) return made.error();
    scene.fluid = *made;
    scene.elements = scene.world->fluid_particles(*made).positions.size();
    return {};
}

constexpr double grain_diameter = 0.01, friction_angle = 30;

Result<void> add_grains(int grains, Moving& scene) {
    const auto ball = scene.world->create_shape(SphereShape{grain_diameter / 2});
    if (!ball) return ball.error();
    BodyDefinition grain{.shape = *ball};
    grain.material = grain_material(friction_angle, grain_diameter);
    grain.mass.density = 2650;
    // A column twice as high as it is wide, with a little room between them.
    const double pitch = 1.06 * grain_diameter;
    const int across = std::max(1, static_cast<int>(std::lround(std::cbrt(grains / 2.0))));
    Random random(7);
    const auto shaken = [&] { return random.between(-0.02, 0.02) * grain_diameter; };
    for (int i = 0; i < grains; ++i) {
        const int x = i % across, z = i / across % across, y = i / (across * across);
        grain.position = {x * pitch + shaken(), (y + 0.5) * pitch + shaken(), z * pitch + shaken()};
        const auto made = scene.world->create_body(grain);
        if (!made) return made.error();
        scene.grains.push_back(*made);
    }
    scene.elements = scene.grains.size();
    return {};
}

Result<Moving> build(Matter matter, int size, int workers) {
    WorldSettings settings{.sleeping = false, .workers = workers};
    if (matter == Matter::grains) settings.substeps = substeps_for_grains(grain_diameter, settings);
    auto world = World::create(settings);
    if (!world) return world.error();
    Moving scene{.world = std::move(*world), .deformables = {}, .fluid = {}, .grains = {}};
    const Material ground = matter == Matter::grains ? grain_material(friction_angle, grain_diameter) : Material{};
    if (auto plane = add_static(*scene.world, PlaneShape{}, {}, ground); !plane) return plane.error();
    Result<void> added;
    switch (matter) {
        case Matter::cloth:
            added = add_cloth(size, scene);
            break;
        case Matter::solids:
            added = add_solids(size, scene);
            break;
        case Matter::dam:
            added = add_dam(size, scene);
            break;
        case Matter::grains:
            added = add_grains(size, scene);
            break;
    }
    if (!added) return added.error();
    const Conserved sum = scene.world->conserved();
    scene.energy = sum.kinetic_energy + sum.potential_energy;
    return scene;
}

std::string judge(const Moving& scene) {
    const Conserved sum = scene.world->conserved();
    const double energy = sum.kinetic_energy + sum.potential_energy;
    if (!std::isfinite(energy)) return "not finite";
    // Falling gives energy away: what little the start's overlaps add is within a thousandth.
    if (energy > scene.energy + 1e-3 * std::fabs(scene.energy)) return "energy has come from nothing";
    constexpr double most_overlap = 5e-3;  // m
    for (const DeformableHandle deformable : scene.deformables)
        for (const Vec3 node : scene.world->node_positions(deformable))
            if (node.y < -most_overlap) return "something went through the ground";
    for (const BodyHandle grain : scene.grains)
        if (scene.world->center_of_mass(grain).y < 0) return "a grain went through the ground";
    if (scene.world->last_report().limits != 0) return "limits were reached";
    return {};
}

struct Told {
    std::string_view name, what, element;
    std::array<int, 3> sizes;
};

// In the order of Matter.
constexpr std::array all_told{
    Told{"cloth", "a sheet falls over a box and drapes", "edges", {10'000, 20'000, 40'000}},
    Told{
        "solids", "eight bricks of rubber fall on the ground and on each other", "tetrahedra", {5'000, 10'000, 20'000}},
    Told{"dam", "a column of water collapses between walls", "particles", {40'000, 80'000, 150'000}},
    Told{"grains", "a column of sand runs out over a plate", "grains", {2'500, 5'000, 10'000}},
};

const Told& told_of(Matter matter) { return all_told[static_cast<std::size_t>(matter)]; }

}  // namespace

std::string_view name_of(Matter matter) { return told_of(matter).name; }
std::string_view what_of(Matter matter) { return told_of(matter).what; }
std::string_view element_of(Matter matter) { return told_of(matter).element; }
std::array<int, 3> sizes_of(Matter matter) { return told_of(matter).sizes; }

Result<MatterCost> measure(Matter matter, int size, int workers) {
    auto scene = build(matter, size, workers);
    if (!scene) return scene.error();
    constexpr double seconds = 1.5;  // of fall, collapse and what follows
    World& world = *scene->world;
    const int steps = static_cast<int>(std::lround(seconds / world.settings().time_step));
    MatterCost cost{.elements = scene->elements, .wrong = {}};
    for (int i = 0; i < steps; ++i) {
        const double ms = world.step().milliseconds;
        cost.mean_ms += ms / steps;
        cost.worst_ms = std::max(cost.worst_ms, ms);
    }
    cost.hash = world.state_hash();
    cost.wrong = judge(*scene);
    return cost;
}

double growth(const MatterCost& smaller, const MatterCost& larger) {
    return std::log(larger.mean_ms / smaller.mean_ms) /
           std::log(static_cast<double>(larger.elements) / static_cast<double>(smaller.elements));
}

}  // namespace embody::scaling
