// SPDX-License-Identifier: MIT
#include "physics/fluid/obstacles/wall_friction.h"

#include <algorithm>
#include <cmath>

#include "physics/fluid/grid/faces.h"
#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

// Distances from a wall, in cells, between which faces are the first layer: exactly one layer wherever the wall lies
// between the cells. Faces closer than this count as in the wall.
constexpr float min_distance = 0.05f, max_distance = 1 + min_distance;

/// A face that a wall slows.
struct SlowedFace {
    int axis, cell, owner;
    Vec3 center;
    double change;  // of its velocity, m/s
};

}  // namespace

// T. von Kármán 1921, by Blasius's friction of pipes: τ/ρ = 0.0225 u² (ν/(u y))^¼, u the speed at the distance y.
double turbulent_stress(double speed, double y, double kinematic_viscosity) {
    const double reynolds = speed * y / std::max(kinematic_viscosity, 1e-12);
    const double all = 0.0225 * speed * speed / std::sqrt(std::sqrt(std::max(reynolds, 1e-12)));
    return std::max(0.0, all - kinematic_viscosity * speed / y);
}

void apply_wall_friction(FluidGrid& grid, FluidObstacles& obstacles, const Mixture& liquids, double dt,
                         TaskPool& workers) {
    const double particle_mass = liquids.first().density * liquids.first().particle_volume;
    const auto tiles = grid.tiles();
    const double h = grid.cell_size();
    std::vector<std::vector<SlowedFace>> found(static_cast<std::size_t>(workers.workers()));
    const auto look_at = [&](int axis, int cell, const Cell& c, std::vector<SlowedFace>& slowed) {
        const int below = cell - grid.stride(axis);
        const float distance = 0.5f * (grid.obstacle[cell] + grid.obstacle[below]);
        if (!(distance > min_distance && distance <= max_distance) || !(grid.open[axis][cell] > 0.25f)) return;
        if (!(grid.mass[axis][cell] > 0) || (grid.row[cell] < 0 && grid.row[below] < 0)) return;
        Vec3 center = grid.center(c);
        center[axis] -= h / 2;
        const int owner = grid.obstacle_owner[grid.obstacle[cell] < grid.obstacle[below] ? cell : below];
        if (owner >= 0 && obstacles.moving()[static_cast<std::size_t>(owner)].obstacle->inverse_mass > 0) return;
        const float at[3] = {static_cast<float>(center.x), static_cast<float>(center.y), static_cast<float>(center.z)};
        float gradient[3];
        (void)sample_center(grid, grid.obstacle, at, gradient);
        const Vec3 normal = normalized(Vec3{gradient[0], gradient[1], gradient[2]});
        const Vec3 slip = velocity_around(grid, axis, cell) - obstacles.velocity_at(owner, center);
        const Vec3 along = slip - normal * dot(slip, normal);
        const double speed = length(along);
        // The speed is taken at half a cell from the wall even where the face is closer: a cell does not resolve
        // layers.
        const auto diffusion = [](const FluidProperties& liquid) { return liquid.viscosity / liquid.density; };
        const double stress =
            turbulent_stress(speed, std::max(distance, 0.5f) * h, liquids.mean_at_face(grid, axis, cell, diffusion));
        if (!(stress > 0)) return;
        const double rate = dt * stress / (speed * h * static_cast<double>(grid.open[axis][cell]));
        slowed.push_back({axis, cell, owner, center, -along[axis] * rate / (1 + rate)});
    };
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int worker, IndexRange range) {
        auto& slowed = found[static_cast<std::size_t>(worker)];
        for (std::size_t i = range.first; i < range.last; ++i) {
            grid.for_cells(tiles[i], [&](int cell, const Cell& c) {
                if (!(grid.obstacle[cell] < max_distance + 0.5f)) return;
                for (int axis = 0; axis < 3; ++axis) look_at(axis, cell, c, slowed);
            });
        }
    });

    for (const auto& slowed : found) {
        for (const SlowedFace& face : slowed) {
            grid.velocity[face.axis][face.cell] += static_cast<float>(face.change);
            if (face.owner < 0) continue;
            MovingObstacle& moving = obstacles.moving()[static_cast<std::size_t>(face.owner)];
            Vec3 impulse;
            impulse[face.axis] = -face.change * grid.mass[face.axis][face.cell] * particle_mass;
            const Vec3 moment = cross(face.center - moving.center, impulse);
            moving.obstacle->impulse += impulse;
            moving.obstacle->angular_impulse += moment;
        }
    }
}

}  // namespace embody::physics::fluid
