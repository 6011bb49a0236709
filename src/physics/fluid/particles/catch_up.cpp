// SPDX-License-Identifier: MIT
// Bodies that are not where the last step left them (docs/physics/fluids.md, "With rigid bodies").
#include <algorithm>
#include <cmath>

#include "physics/fluid/grid/faces.h"
#include "physics/fluid/particles/collide_particles.h"
#include "physics/fluid/particles/transfer.h"
#include "physics/fluid/solver.h"

namespace embody::physics::fluid {

FluidSolver::Followed FluidSolver::follow(std::span<FluidObstacle> obstacles, TaskPool& workers) {
    Followed followed;
    if (particles_.empty()) return followed;
    obstacles_.begin(obstacles, settings_.obstacles, grid_);
    const double travel = obstacles_.unexpected_displacement() / grid_.cell_size();
    if (travel > settings_.collision.max_single_catch_up) {
        const double wanted = std::ceil(travel / settings_.parts.max_displacement);
        const double parts = std::clamp(wanted, 1.0, static_cast<double>(settings_.parts.max_parts));
        obstacles_.begin_catching_up();
        for (int i = 0; i < static_cast<int>(parts) && !particles_.empty(); ++i) displace(1 / parts, followed, workers);
        obstacles_.end_catching_up();
    }
    if (travel > settings_.collision.min_catch_up) keep_out(workers);
    obstacles_.end();
    return followed;
}

// Moves particles out of thin obstacles by the true shapes; the particles keep their velocities, which the next
// pressure solve stops.
void FluidSolver::keep_out(TaskPool& workers) {
    obstacles_.place();
    parallel_for(workers, particles_.size(), particles_.size() > few_particles, [&](int, IndexRange part) {
        ParticleCollider collider(grid_, obstacles_, settings_.collision, 0);
        for (std::size_t i = part.first; i < part.last; ++i) {
            if (!collider.is_near_thin(particles_[i].position)) continue;
            FluidParticle moved = particles_[i];
            collider.move(moved, particles_[i].position);
            std::copy_n(moved.position, 3, particles_[i].position);
        }
    });
    obstacles_.advance(0);
}

// The displacement of least Σ ρ |d|² that makes room for the obstacles and keeps the liquid's volume: d = −∇q/ρ, ∇·d =
// 0, as the pressure moves liquid at rest.
void FluidSolver::displace(double fraction, Followed& followed, TaskPool& workers) {
    const int max_iterations = settings_.pressure.max_iterations;
    const double h = grid_.cell_size();
    followed.lost += grid_.cover(particles_, settings_.cells, workers);
    if (particles_.empty()) return;
    grid_.sort(particles_, particle_fraction(), obstacles_.in_reach(fraction, h), settings_.cells, workers);
    obstacles_.measure(fraction, grid_, workers);
    if (grid_.on_grid() == 0) return obstacles_.advance(fraction);
    find_places(fraction, workers);
    liquids_.identify(particles_, workers);
    particles_to_grid(grid_, particles_, places_, {particle_fraction(), liquids_}, workers);
    grid_.for_tiles(workers, [&](const Cell& corner) {
        grid_.for_rows(corner, [&](int first, const Cell&) {
            for (auto* fields : {&grid_.velocity, &grid_.convection})
                for (auto& field : *fields) std::fill_n(field.begin() + first, FluidGrid::tile[0], 0.0f);
        });
    });
    ImmersedPoints::leave(grid_);
    system_.build(grid_, settings_, workers);
    obstacles_.list_areas(grid_, {});
    outflow(grid_, obstacles_, system_, flow_, workers);
    for (double& flow : flow_) flow *= -1 / h;
    potential_.assign(system_.size(), 0);
    system_.set_bodies({}, 0);
    const double tolerance = settings_.pressure.catch_up_tolerance * h * h / fraction;
    const int iterations = system_.solve(flow_, potential_, tolerance, max_iterations, workers);
    subtract_gradient(grid_, {system_, potential_, {}, 1 / h}, grid_.velocity, workers);
    extrapolate(grid_, grid_.velocity, 1, workers);
    admit_drops(grid_, workers);
    extrapolate(grid_, grid_.velocity, 2, workers);
    follow_obstacles(
        grid_, obstacles_, [](int, int) { return 0; }, workers);

    const std::size_t count = grid_.on_grid();
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange part) {
        ParticleCollider collider(grid_, obstacles_, settings_.collision, fraction);
        for (std::size_t i = part.first; i < part.last; ++i) {
            FluidParticle moved = particles_[i];
            float travel[3], end[3];
            sample_value(grid_, grid_.velocity, places_[i].data(), travel);
            for (int axis = 0; axis < 3; ++axis)
                end[axis] = moved.position[axis] + static_cast<float>(fraction) * travel[axis];
            collider.move(moved, end);
            std::copy_n(moved.position, 3, particles_[i].position);
        }
    });
    obstacles_.advance(fraction);
    followed.is_solved = followed.is_solved && iterations <= max_iterations;
}

}  // namespace embody::physics::fluid
