// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/drops.h"

#include <algorithm>

#include "physics/fluid/obstacles/wall_friction.h"
#include "physics/fluid/particles/transfer.h"
#include "physics/fluid/solver.h"

namespace embody::physics::fluid {

bool is_drop(const FluidGrid& grid, const float* place) {
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) c[axis] = static_cast<int>(grid.in_cells(place[axis], axis));
    const int cell = grid.index(c);
    bool is_liquid = grid.row[cell] >= 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(axis);
        is_liquid = is_liquid || grid.row[cell - stride] >= 0 || grid.row[cell + stride] >= 0;
    }
    return !is_liquid;
}

// A film of the particle's volume spread over a cell's area, of thickness δ: the stress at the ground is 3 μ u/δ
// (Nusselt) plus that of turbulence. Its rim holds it by σ (cos θr − cos θa) a width, that of the particle's edge d (C.
// Furmidge, "Studies at phase interfaces", 1962).
void slow_at_wall(const DropSurroundings& around, const FluidProperties& liquid, const float* place, float* velocity) {
    const FluidGrid& grid = around.grid;
    const double dt = around.dt, hysteresis = around.settings.angle_hysteresis;
    float gradient[3];
    if (!(sample_center(grid, grid.obstacle, place, gradient) < around.settings.wall_distance)) return;
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) c[axis] = static_cast<int>(grid.in_cells(place[axis], axis));
    const Vec3 wall = around.obstacles.velocity_at(grid.obstacle_owner[grid.index(c)], {place[0], place[1], place[2]});
    const Vec3 normal = normalized(Vec3{gradient[0], gradient[1], gradient[2]});
    const Vec3 slip = Vec3{velocity[0], velocity[1], velocity[2]} - wall, along = slip - normal * dot(slip, normal);
    const double speed = length(along);
    if (!(speed > 0)) return;
    const double h = grid.cell_size(), thickness = liquid.particle_volume / (h * h), d = h / 2;
    const double nu = liquid.viscosity / liquid.density;
    const double by_rim = hysteresis * liquid.surface_tension / (liquid.density * d * d);
    const double by_ground = liquid.yield_stress / liquid.density + turbulent_stress(speed, thickness / 2, nu);
    const double lost = dt * (by_rim + by_ground / thickness);
    const double left = std::max(0.0, speed - lost) / (1 + 3 * nu * dt / (thickness * thickness));
    for (int axis = 0; axis < 3; ++axis) velocity[axis] += static_cast<float>(along[axis] * (left / speed - 1));
}

}  // namespace embody::physics::fluid
