// SPDX-License-Identifier: MIT
// Liquids with sheets (docs/physics/coupling.md, "Liquids and what bends").
#include <algorithm>

#include "foundation/random.h"
#include "physics/definitions/deformable_primitives.h"
#include "validation/fluid_scenes.h"

namespace embody::physics {
namespace {

constexpr double water_density = 998;  // kg/m³, the fluids' default

double fastest_particle(const World& world, FluidHandle fluid) {
    double fastest = 0;
    for (const Vec3f v : world.fluid_particles(fluid).velocities) fastest = std::max(fastest, length(Vec3(v)));
    return fastest;
}

double mean_speed(const World& world, FluidHandle fluid) {
    double sum = 0;
    const FluidParticles particles = world.fluid_particles(fluid);
    for (const Vec3f v : particles.velocities) sum += length(Vec3(v));
    return sum / static_cast<double>(particles.velocities.size());
}

// Fraction of the particles that are more than a centimetre below the nearest node.
double fraction_below(const World& world, FluidHandle fluid, DeformableHandle sheet) {
    const FluidParticles particles = world.fluid_particles(fluid);
    const auto nodes = world.node_positions(sheet);
    int below = 0;
    for (const Vec3f p : particles.positions) {
        const Vec3 place = particles.origin + Vec3(p);
        const auto distance = [&](Vec3 node) { return length_squared(Vec3{node.x - place.x, 0, node.z - place.z}); };
        const Vec3 nearest = *std::ranges::min_element(nodes, {}, distance);
        below += place.y < nearest.y - 0.01 ? 1 : 0;
    }
    return below / static_cast<double>(particles.positions.size());
}

// Pins the nodes of a rectangle for which `is_pinned` (distance to the nearer pair of edges, to the other pair) holds.
template <class IsPinned>
void pin(DeformableDefinition& sheet, IsPinned is_pinned) {
    double half = 0;
    for (const Vec3 p : sheet.nodes) half = std::max(half, std::fabs(p.x));
    for (std::uint32_t i = 0; i < sheet.nodes.size(); ++i) {
        const double x = half - std::fabs(sheet.nodes[i].x), z = half - std::fabs(sheet.nodes[i].z);
        if (is_pinned(std::min(x, z) < 1e-6, std::max(x, z) < 1e-6)) sheet.pinned.push_back(i);
    }
}

DeformableDefinition random_sheet(Random& random) {
    DeformableDefinition sheet = cloth_rectangle(
        random.between(0.2, 0.35), random.between(0.2, 0.35), random.between(0.03, 0.05),
        {.area_density = std::pow(10, random.between(-1, 0)), .stretch_stiffness = random.between(500, 10000)});
    sheet.contact_radius = 0.005;
    return sheet;
}

// Energy of both together, with what stretches the sheet: nothing but gravity brings any in. Momentum of a free sheet
// and the water that is thrown at it is theirs together. Nothing is much faster than it began and has fallen: what is
// squeezed through the weave may be a little. Drops that a ground throws up are not the sheets' doing, so there is
// none.
TEST(FluidCloth, SheetsThatWaterFallsOnGiveItNoEnergy) {
    Random random(9);
    for (int trial = 0; trial < 16; ++trial) {
        SCOPED_TRACE(trial);
        auto world = make_world({.air_density = 0});
        DeformableDefinition sheet = random_sheet(random);
        const bool is_free = trial % 4 == 3;
        if (!is_free) pin(sheet, [&](bool is_edge, bool is_corner) { return trial % 4 == 2 ? is_edge : is_corner; });
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        const double above = random.between(0.02, 0.3), half = random.between(0.06, 0.12),
                     top = above + random.between(0.06, 0.15), cell = random.between(0.015, 0.04),
                     thrown = is_free ? random.between(1, 4) : 0;
        const FluidHandle water = world
                                      ->create_fluid({.boxes = {{{-half, above, -half}, {half, top, half}}},
                                                      .velocity = {0, -thrown, 0},
                                                      .cell_size = cell})
                                      .value();
        const double liquid = volume_of(*world, water) * water_density, mass = liquid + world->mass(cloth);
        const std::size_t count = world->fluid_particles(water).positions.size();
        const double first = energy(*world), all = mass * (gravity * (top + 1) + thrown * thrown / 2);
        double gained = 0, most_momentum = 0;
        // Of a sheet in free fall it is told half a step ahead, as its place is (docs/physics/cloth.md).
        Vec3 momentum;
        for (int i = 1; i <= 40; ++i) {
            world->step();
            const double time = i * world->settings().time_step;
            gained = std::max(gained, energy(*world) - first);
            EXPECT_LT(fastest_particle(*world, water), thrown + 1.3 * gravity * time + 0.2) << "step " << i;
            const Vec3 change = world->conserved().linear_momentum + Vec3{0, mass * gravity * time, 0};
            if (i == 1) momentum = change;
            if (is_free) most_momentum = std::max(most_momentum, length(change - momentum));
        }
        RecordProperty("gained_" + std::to_string(trial), std::to_string(gained / all));
        EXPECT_LT(gained, 1e-3 * all);
        EXPECT_EQ(world->fluid_particles(water).positions.size(), count);
        if (!is_free) continue;
        RecordProperty("momentum_" + std::to_string(trial), std::to_string(most_momentum / (liquid * thrown)));
        EXPECT_LT(most_momentum, 0.003 * liquid * thrown);
    }
}

// Liquids of different cells, one at each half of a sheet: what the second one finds leaves what the first one did.
TEST(FluidCloth, TwoLiquidsOnOneSheetKeepTheCommonMomentum) {
    Random random(11);
    for (int trial = 0; trial < 4; ++trial) {
        SCOPED_TRACE(trial);
        auto world = make_world({.gravity = {}, .air_density = 0, .deformable_substeps = 1});
        DeformableDefinition sheet = cloth_rectangle(0.5, 0.2, 0.04, {.area_density = random.between(0.1, 1)});
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        double thrown = 0;
        for (const double side : {-1, 1}) {
            const double speed = random.between(1, 3), x = side * 0.16;
            const FluidHandle water = world
                                          ->create_fluid({.boxes = {{{x - 0.06, 0.02, -0.06}, {x + 0.06, 0.1, 0.06}}},
                                                          .velocity = {0, -speed, 0},
                                                          .cell_size = side < 0 ? 0.02 : 0.03})
                                          .value();
            thrown += volume_of(*world, water) * water_density * speed;
        }
        const Vec3 first = world->conserved().linear_momentum;
        for (int i = 0; i < 15; ++i) world->step();
        EXPECT_LT(length(world->conserved().linear_momentum - first), 3e-3 * thrown);
        EXPECT_LT(world->center_of_mass(cloth).y, -0.05);
    }
}

// In and above a pool, or over a box that stands in it: no energy comes in, and all comes to rest.
TEST(FluidCloth, SheetsInAPoolGiveItNoEnergyAndSettle) {
    Random random(10);
    for (int trial = 0; trial < 8; ++trial) {
        SCOPED_TRACE(trial);
        auto world = make_world({});
        // Whole cells: what the first filling leaves open beside walls would stir the pool.
        const double cell = random.between(0.025, 0.04), half = 7 * cell, depth = 4 * cell;
        add_tank(*world, {{-half, 0, -half}, {half, 1, half}});
        DeformableDefinition sheet = random_sheet(random);
        sheet.pose.position = {0.01, depth + random.between(0.02, 0.2), 0};
        if (trial % 2 == 0)
            add_box(*world, Vec3{2, 2, 2} * cell, {.kind = BodyKind::static_body, .position = {0, 2 * cell, 0}});
        else
            sheet.pose.position.y = random.between(0.3, 1.5) * depth;
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        const FluidHandle water =
            world->create_fluid({.boxes = {{{-half, 0, -half}, {half, depth, half}}}, .cell_size = cell}).value();
        const double first = energy(*world);
        double gained = 0;
        for (int i = 0; i < 150; ++i) {
            world->step();
            gained = std::max(gained, energy(*world) - first);
        }
        RecordProperty("gained_" + std::to_string(trial), std::to_string(gained / first));
        EXPECT_LT(gained, 1e-3 * first);
        EXPECT_LT(mean_speed(*world, water), 0.01);
        EXPECT_LT(world->center_of_mass(cloth).y, sheet.pose.position.y);
    }
}

// A sheet held all around over a shaft, water let fall on it: it holds that for a moment, and lets it through little by
// little (Darcy's law: 0.17 of it a second at first).
TEST(FluidCloth, HoldsWaterForAMomentAndDrips) {
    Random random(12);
    for (int trial = 0; trial < 3; ++trial) {
        SCOPED_TRACE(trial);
        auto world = make_world({});
        constexpr double half = 0.15, depth = 0.1;
        add_tank(*world, {{-half, 0, -half}, {half, 1.2, half}});
        DeformableDefinition sheet =
            cloth_rectangle(2 * half, 2 * half, 0.03, {.area_density = random.between(0.1, 1)});
        pin(sheet, [](bool is_edge, bool) { return is_edge; });
        sheet.pose.position = {0, 0.5, 0};
        sheet.contact_radius = 0.002;
        const DeformableHandle cloth = world->create_deformable(sheet).value();
        const double bottom = 0.5 + (trial == 0 ? 0.0 : random.between(0.01, 0.08));
        const FluidHandle water =
            world->create_fluid({.boxes = {{{-half, bottom, -half}, {half, bottom + depth, half}}}, .cell_size = 0.03})
                .value();
        run(*world, 0.3);
        const double soon = fraction_below(*world, water, cloth);
        run(*world, 1.7);
        const double later = fraction_below(*world, water, cloth);
        RecordProperty("through_" + std::to_string(trial), std::to_string(soon) + ", " + std::to_string(later));
        EXPECT_LT(soon, 0.25);
        EXPECT_GT(later, soon + 0.1);
        EXPECT_LT(later, 0.9);
    }
}

}  // namespace
}  // namespace embody::physics
