// SPDX-License-Identifier: MIT
// A floor brakes the liquid that slides over it, wherever it lies between the cells.
#include <gtest/gtest.h>

#include <cmath>

#include "validation/fluid_scenes.h"

namespace embody::physics {

namespace {

// The mean force on a floor in the first steps of 0.2 m of water that slide over it at 2 m/s, N. `offset`: of the
// floor from a face of cells, in cells.
double drag_on_floor(double offset) {
    const double cell = 0.04, top = offset * cell;
    const auto world = make_world({});
    const BodyHandle floor =
        add_box(*world, {3, 0.5, 3}, {.kind = BodyKind::kinematic_body, .position = {0, top - 0.5, 0}});
    FluidDefinition water;
    water.boxes = {{{-0.6, top, -0.4}, {0.6, top + 0.2, 0.4}}};
    water.velocity = {2, 0, 0};
    water.cell_size = cell;
    EXPECT_TRUE(world->create_fluid(water));
    double sum = 0;
    constexpr int steps = 3;
    for (int k = 0; k < steps; ++k) {
        world->step();
        sum += world->fluid_force(floor).force.x;
    }
    return sum / steps;
}

}  // namespace

// By von Karman's law for a plate from the speed half a cell away: 0.0225 ρ u² (ν/(u y))^¼ A.
TEST(FluidWallFriction, IsThatOfAPlateWhereverTheFloorLies) {
    const double right = 0.0225 * 1000 * 4 * std::pow(1e-6 / (2 * 0.02), 0.25) * 1.2 * 0.8;
    for (const double offset : {0.0, 0.2, 0.4, 0.45, 0.48, 0.5, 0.55, 0.6, 0.8})
        EXPECT_NEAR(drag_on_floor(offset), right, 0.3 * right) << offset;
}

}  // namespace embody::physics
