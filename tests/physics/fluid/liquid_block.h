// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "foundation/random.h"
#include "foundation/task_pool.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

/// Eight particles in each cell from `lower` to below `upper`, half a cell apart: the density of such a lattice is one.
inline std::vector<FluidParticle> fill_cells(double h, Cell lower, Cell upper) {
    std::vector<FluidParticle> particles;
    const auto half = static_cast<float>(h / 2);
    for (int z = 2 * lower[2]; z < 2 * upper[2]; ++z) {
        for (int y = 2 * lower[1]; y < 2 * upper[1]; ++y) {
            for (int x = 2 * lower[0]; x < 2 * upper[0]; ++x) {
                FluidParticle particle;
                const std::array<int, 3> at{x, y, z};
                for (std::size_t a = 0; a < 3; ++a) {
                    particle.position[a] = (static_cast<float>(at[a]) + 0.5f) * half;
                }
                particle.id = static_cast<std::uint32_t>(particles.size());
                particles.push_back(particle);
            }
        }
    }
    return particles;
}

/// Particles at random places of a box, with random velocities and gradients.
inline std::vector<FluidParticle> scatter(Random& random, std::size_t count, double edge) {
    std::vector<FluidParticle> particles(count);
    for (std::size_t i = 0; i < count; ++i) {
        FluidParticle& particle = particles[i];
        particle.id = static_cast<std::uint32_t>(i);
        for (int a = 0; a < 3; ++a) {
            particle.position[a] = static_cast<float>(random.between(0, edge));
            particle.velocity[a] = static_cast<float>(random.between(-1, 1));
            for (float& gradient : particle.affine[a]) gradient = static_cast<float>(random.between(-1, 1) / edge);
        }
    }
    return particles;
}

/// What a part of a step knows before pressure: particles sorted on a grid, obstacles measured, faces with velocities.
struct LiquidBlock {
    static constexpr float particle_fraction = 0.125f;  // of a cell

    LiquidBlock(double h, std::vector<FluidParticle> matter, std::span<FluidObstacle> met = {})
        : grid(h), obstacles(Vec3{}), particles(std::move(matter)) {
        grid.cover(particles, {}, workers);
        obstacles.begin(met, {}, grid);
        grid.sort(particles, particle_fraction, obstacles.in_reach(0, h), {}, workers);
        obstacles.measure(0, grid, workers);
        transfer();
    }
    void transfer() {
        places.clear();
        for (std::size_t i = 0; i < grid.on_grid(); ++i) {
            const float* p = particles[i].position;
            places.push_back({p[0], p[1], p[2]});
        }
        particles_to_grid(grid, particles, places, {particle_fraction, liquids}, workers);
    }
    /// Centre of a face, m.
    [[nodiscard]] Vec3 face_center(int axis, const Cell& c) const {
        Vec3 center = grid.center(c);
        center[axis] -= grid.cell_size() / 2;
        return center;
    }
    /// Sets every face of the active tiles to a component of a field.
    template <class Field>
    void set_velocity(Field field) {
        for (const Cell& corner : grid.tiles()) {
            grid.for_cells(corner, [&](int cell, const Cell& c) {
                for (int axis = 0; axis < 3; ++axis) {
                    grid.velocity[axis][cell] = static_cast<float>(field(face_center(axis, c))[axis]);
                }
            });
        }
    }
    /// The cell that holds a place.
    [[nodiscard]] Cell cell_at(Vec3 p) const {
        Cell c{};
        for (int a = 0; a < 3; ++a) {
            c[a] = static_cast<int>(std::floor(p[a] / grid.cell_size())) - grid.lower()[a];
        }
        return c;
    }
    [[nodiscard]] int index_at(Vec3 p) const { return grid.index(cell_at(p)); }
    /// Sum of what the faces carry, in particles times m/s, and its moment about the origin.
    struct Momenta {
        Vec3 linear, angular;
    };
    [[nodiscard]] Momenta face_momenta() const {
        Momenta sum;
        for (const Cell& corner : grid.tiles()) {
            grid.for_cells(corner, [&](int cell, const Cell& c) {
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 momentum;
                    momentum[axis] = static_cast<double>(grid.mass[axis][cell]) * grid.velocity[axis][cell];
                    sum.linear += momentum;
                    sum.angular += cross(face_center(axis, c), momentum);
                }
            });
        }
        return sum;
    }

    TaskPool workers{1};
    FluidGrid grid;
    FluidObstacles obstacles;
    std::vector<FluidParticle> particles;
    std::vector<std::array<float, 3>> places;
    Mixture liquids{FluidProperties{.density = 1000, .particle_volume = 1e-6}};
};

}  // namespace embody::physics::fluid
