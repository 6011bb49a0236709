// SPDX-License-Identifier: MIT
#include "physics/fluid/solver.h"

#include <algorithm>
#include <cmath>

#include "foundation/zone.h"
#include "physics/fluid/obstacles/small_body.h"
#include "physics/fluid/obstacles/wall_friction.h"
#include "physics/fluid/particles/collide_particles.h"
#include "physics/fluid/particles/drops.h"
#include "physics/fluid/particles/settling.h"
#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

// A gradient, 1/s, made no steeper than that: a step of this length does not resolve steeper ones.
void set_gradient(const float* gradient, float steepest, float* affine) {
    const float squared = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
    const float scale = squared > steepest * steepest ? steepest / std::sqrt(squared) : 1;
    for (int axis = 0; axis < 3; ++axis) affine[axis] = gradient[axis] * scale;
}

}  // namespace

FluidSolver::FluidSolver(Vec3 origin, double cell_size, const FluidProperties& properties,
                         std::span<const Vec3f> positions, Vec3 velocity)
    : origin_(origin), liquids_(properties), grid_(cell_size), obstacles_(origin) {
    add_particles(positions);
    for (FluidParticle& particle : particles_) {
        for (int axis = 0; axis < 3; ++axis) particle.velocity[axis] = static_cast<float>(velocity[axis]);
    }
}

FluidIds FluidSolver::add_particles(std::span<const Vec3f> positions) {
    const std::uint32_t first = next_id_;
    particles_.reserve(particles_.size() + positions.size());
    for (const Vec3f p : positions) particles_.push_back({.position = {p.x, p.y, p.z}, .id = next_id_++});
    return {first, next_id_};
}

std::size_t FluidSolver::take_within(Vec3 center, double radius) {
    const Vec3 local = center - origin_;
    const std::size_t taken = std::erase_if(particles_, [&](const FluidParticle& particle) {
        const float* x = particle.position;
        return length_squared(Vec3{x[0], x[1], x[2]} - local) <= radius * radius;
    });
    if (taken > 0) liquids_.keep_liquids_of(particles_);
    return taken;
}

std::vector<FluidParticle> FluidSolver::take_particles(FluidIds ids) {
    std::vector<FluidParticle> taken;
    std::erase_if(particles_, [&](const FluidParticle& particle) {
        if (ids.contains(particle.id)) taken.push_back(particle);
        return ids.contains(particle.id);
    });
    std::ranges::sort(taken, {}, &FluidParticle::id);
    liquids_.keep_liquids_of(particles_);
    return taken;
}

FluidIds FluidSolver::add_particles(std::vector<FluidParticle> particles, Vec3 origin,
                                    std::optional<std::uint32_t> first) {
    std::uint32_t id = first.value_or(next_id_);
    const std::uint32_t begin = id;
    for (FluidParticle& particle : particles) {
        for (int axis = 0; axis < 3; ++axis)
            particle.position[axis] = static_cast<float>(particle.position[axis] + (origin - origin_)[axis]);
        particle.id = id++;
    }
    particles_.insert(particles_.end(), particles.begin(), particles.end());
    next_id_ = std::max(next_id_, id);
    return {begin, id};
}

void FluidSolver::set_matter(FluidIds ids, const FluidProperties& matter) {
    liquids_.assign(ids, matter);
    liquids_.keep_liquids_of(particles_);
}

void FluidSolver::change_particles(FluidIds ids, const FluidChange& change) {
    std::erase_if(particles_, [&](FluidParticle& particle) {
        if (!ids.contains(particle.id)) return false;
        float *x = particle.position, *v = particle.velocity;
        const Vec3 before{v[0], v[1], v[2]};
        Vec3 position = origin_ + Vec3{x[0], x[1], x[2]}, velocity = before;
        if (!change(particle.id, position, velocity)) return true;
        // A particle whose velocity is changed from outside loses its affine motion.
        if (velocity != before) {
            for (auto& row : particle.affine) std::fill_n(row, 3, 0.0f);
        }
        for (int axis = 0; axis < 3; ++axis) {
            x[axis] = static_cast<float>((position - origin_)[axis]);
            v[axis] = static_cast<float>(velocity[axis]);
        }
        return false;
    });
    liquids_.keep_liquids_of(particles_);
}

double FluidSolver::usual_speed(TaskPool& workers) const {
    return usual_speed_of(particles_, settings_.parts.particles_per_outlier, workers);
}

void FluidSolver::prepare(std::span<FluidObstacle> obstacles, TaskPool& workers) {
    // A copy: the caller still identifies the particles by their order.
    std::vector<FluidParticle> particles = particles_;
    grid_.cover(particles, settings_.cells, workers);
    if (particles.empty()) return;
    obstacles_.begin(obstacles, settings_.obstacles, grid_);
    grid_.sort(particles, particle_fraction(), obstacles_.in_reach(0, grid_.cell_size()), settings_.cells, workers);
    obstacles_.measure(0, grid_, workers);
}

FluidOutcome FluidSolver::advance(double dt, Vec3 gravity, std::span<FluidObstacle> obstacles, TaskPool& workers,
                                  std::span<ImmersedPoint> points, const PointResponse& respond) {
    FluidOutcome outcome;
    for (FluidObstacle& obstacle : obstacles) obstacle.impulse = obstacle.angular_impulse = {};
    immersed_.begin(points, origin_);
    if (particles_.empty()) return outcome;
    speed_ = usual_speed(workers);
    const int max_parts = settings_.parts.max_parts;
    const double h = grid_.cell_size();
    const double cells = (speed_ + length(gravity) * dt) * dt / (settings_.parts.max_displacement * h);
    double parts = cells;
    is_tense_ = false;
    for (const FluidProperties& liquid : liquids_.liquids()) {
        const double tension = liquid.surface_tension;
        if (!is_tense(settings_.tension, tension, liquid.density, length(gravity), h)) continue;
        is_tense_ = true;
        parts = std::max(parts, std::sqrt(tension / steady_tension(liquid.density, h, dt)));
    }
    outcome.parts = static_cast<int>(std::clamp(std::ceil(parts), 1.0, static_cast<double>(max_parts)));
    outcome.is_slowed = cells > max_parts;
    obstacles_.begin(obstacles, settings_.obstacles, grid_);
    const double part = dt / outcome.parts;
    for (int i = 0; i < outcome.parts && !particles_.empty(); ++i)
        advance_part({part, gravity, respond}, outcome, workers);
    obstacles_.end();

    // Non-finite numbers: they must not reach any obstacle.
    for (const FluidObstacle& obstacle : obstacles) {
        outcome.is_finite = outcome.is_finite && is_finite(obstacle.impulse) && is_finite(obstacle.angular_impulse);
    }
    for (const ImmersedPoint& point : points) outcome.is_finite = outcome.is_finite && is_finite(point.impulse);
    outcome.is_finite = outcome.is_finite && reach_of(particles_, workers).is_finite();
    if (outcome.is_finite) return outcome;
    for (FluidObstacle& obstacle : obstacles) obstacle.impulse = obstacle.angular_impulse = {};
    for (ImmersedPoint& point : points) point.impulse = {};
    return outcome;
}

void FluidSolver::stop() {
    for (FluidParticle& particle : particles_) {
        std::fill_n(particle.velocity, 3, 0.0f);
        for (auto& row : particle.affine) std::fill_n(row, 3, 0.0f);
    }
}

void FluidSolver::put_at_rest(std::span<const Vec3f> positions, std::span<const std::uint32_t> ids) {
    particles_.assign(positions.size(), {});
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3f p = positions[i];
        particles_[i] = {.position = {p.x, p.y, p.z}, .id = ids[i]};
    }
}

Conserved FluidSolver::conserved(Vec3 gravity) const {
    Conserved sum;
    for (const FluidParticle& particle : particles_) {
        const FluidProperties& liquid = liquids_.of(particle.id);
        const double mass = liquid.density * liquid.particle_volume;
        const float *x = particle.position, *v = particle.velocity;
        const Vec3 place = origin_ + Vec3{x[0], x[1], x[2]}, velocity{v[0], v[1], v[2]};
        sum.kinetic_energy += mass / 2 * length_squared(velocity);
        sum.potential_energy -= mass * dot(gravity, place);
        sum.linear_momentum += mass * velocity;
        sum.angular_momentum += mass * cross(place, velocity);
    }
    return sum;
}

float FluidSolver::particle_fraction() const {
    const double h = grid_.cell_size();
    return static_cast<float>(properties().particle_volume / (h * h * h));
}

void FluidSolver::advance_part(const Part& part, FluidOutcome& outcome, TaskPool& workers) {
    const double dt = part.dt;
    const Vec3 gravity = part.gravity;
    outcome.lost += grid_.cover(particles_, settings_.cells, workers);
    if (particles_.empty()) return;
    std::vector<Bounds> near = obstacles_.in_reach(dt, grid_.cell_size());
    immersed_.add_reach(dt, grid_.cell_size(), near);
    grid_.sort(particles_, particle_fraction(), near, settings_.cells, workers);
    liquids_.identify(particles_, workers);
    obstacles_.measure(dt, grid_, workers);
    immersed_.measure(dt, grid_);
    obstacles_.accelerate(dt);
    const bool has_liquid = grid_.on_grid() > 0;
    if (has_liquid) advance_grid(part, outcome, workers);
    move_particles(dt, gravity, workers);
    fly(dt, gravity * dt, workers);
    if (has_liquid) components_.end(gravity * dt, obstacles_, immersed_, liquids_, stopped_, particles_);
    obstacles_.advance(dt);
    immersed_.advance(dt);
}

void FluidSolver::advance_grid(const Part& part, FluidOutcome& outcome, TaskPool& workers) {
    EMBODY_ZONE("advance grid");
    const double dt = part.dt, h = grid_.cell_size();
    const Vec3 gravity = part.gravity;
    find_places(dt, workers);
    particles_to_grid(grid_, particles_, places_, {particle_fraction(), liquids_}, workers);
    immersed_.find_conductance(dt, liquids_, grid_);
    extrapolate(grid_, grid_.velocity, 2, workers);

    system_.build(grid_, settings_, workers);
    find_convection(grid_, dt, workers);
    find_surface_change(grid_, surface_change_, workers);
    // Before gravity: what the liquid falls by until the pressure stops it is no motion along walls.
    apply_wall_friction(grid_, obstacles_, liquids_, dt, workers);
    accelerate(gravity * dt, workers);
    components_.begin(grid_, system_, obstacles_, immersed_, particles_, {liquids_, is_tense_, settings_.components});
    const double density = properties().density;
    obstacles_.list_areas(grid_, gravity * density);
    impulse_.resize(system_.size());
    for (std::size_t row = 0; row < system_.size(); ++row) impulse_[row] = grid_.pressure[system_.cell(row)] * dt;
    const auto resists = [&](const FluidProperties& of) { return is_viscous(of, settings_.viscosity, h, dt); };
    if (std::ranges::any_of(liquids_.liquids(), resists)) shear(dt, outcome, workers);
    for (MovingObstacle& moving : obstacles_.moving()) bind_liquid(grid_, density, gravity, moving);
    immersed_.start(grid_);
    project(part, outcome, workers);
    for (MovingObstacle& moving : obstacles_.moving()) drag_small_body(grid_, liquids_, dt, moving);
    // Next to the liquid the air's faces move with it; farther away drops fall freely.
    extrapolate(grid_, grid_.velocity, 1, workers);
    admit_drops(grid_, workers);
    extrapolate(grid_, grid_.velocity, 2, workers);
    add_to_faces(grid_, surface_change_);
    follow_obstacles(grid_, obstacles_, sticking(), workers);
    spread_out(workers);
}

Sticking FluidSolver::sticking() const {
    const auto of = [this](const FluidProperties& liquid) {
        return sticking_of(liquid, settings_.viscosity, grid_.cell_size(), speed_);
    };
    if (liquids_.is_one()) return [one = of(liquids_.first())](int, int) { return one; };
    return [this, of](int axis, int cell) { return liquids_.mean_at_face(grid_, axis, cell, of); };
}

void FluidSolver::find_places(double dt, TaskPool& workers) {
    const std::size_t count = grid_.on_grid();
    places_.resize(count);
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        ParticleCollider collider(grid_, obstacles_, settings_.collision, dt);
        for (std::size_t i = range.first; i < range.last; ++i) places_[i] = collider.place_of(particles_[i]);
    });
}

void FluidSolver::accelerate(Vec3 change, TaskPool& workers) {
    grid_.for_tiles(workers, [&](const Cell& corner) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto by = static_cast<float>(change[axis]);
            grid_.for_cells(corner, [&](int cell, const Cell&) {
                if (grid_.known[axis][cell]) grid_.velocity[axis][cell] += by;
            });
        }
    });
}

// The last pressure acts meanwhile, on the liquid and on the bodies in it, and is taken back for project() to find the
// present one: without it viscosity met all that gravity does in the step, at walls most of all, and thick liquid that
// should rest flowed.
void FluidSolver::shear(double dt, FluidOutcome& outcome, TaskPool& workers) {
    EMBODY_ZONE("solve viscosity");
    const double scale = dt / (properties().density * grid_.cell_size());
    viscosity_.begin(liquids_, dt, settings_.viscosity, grid_, obstacles_);
    subtract_last_gradient(grid_, scale, workers);
    change_obstacles(impulse_, 1);
    change_by_films(dt);
    const int iterations = viscosity_.solve(liquids_, dt, grid_, obstacles_);
    outcome.viscosity_iterations += iterations;
    outcome.is_solved = outcome.is_solved && iterations <= settings_.viscosity.max_iterations;
    subtract_last_gradient(grid_, -scale, workers);
    change_obstacles(impulse_, -1);
    change_by_films(-dt);
}

// The impulse density P = p dt that makes the velocity free of divergence (docs/physics/fluids.md, "Pressure").
void FluidSolver::project(const Part& part, FluidOutcome& outcome, TaskPool& workers) {
    EMBODY_ZONE("solve pressure");
    const int max_iterations = settings_.pressure.max_iterations;
    const double dt = part.dt, h = grid_.cell_size(), rho = properties().density;
    change_by_films(dt);
    system_.set_bodies(obstacles_.moving(), rho / h);
    const double tolerance = settings_.pressure.tolerance * rho * h * h / dt;
    if (part.respond) part.respond(dt, immersed_);
    do {
        immersed_.predict(dt, grid_);
        outflow(grid_, obstacles_, system_, flow_, workers);
        immersed_.add_outflow(grid_, flow_);
        for (double& flow : flow_) flow *= -rho / h;
        surface_.clear();
        if (is_tense_) apply_surface_tension(dt, workers);
        const int iterations = system_.solve(flow_, impulse_, tolerance, max_iterations, workers);
        outcome.pressure_iterations += iterations;
        outcome.is_solved = outcome.is_solved && iterations <= max_iterations;
        immersed_.find_impulses(system_, impulse_, grid_);
    } while (part.respond && part.respond(dt, immersed_));

    subtract_gradient(grid_, {system_, impulse_, surface_, 1 / (rho * h)}, grid_.velocity, workers);
    immersed_.apply_pressure(grid_);
    push_obstacles(impulse_, dt);
    grid_.for_tiles(workers, [&](const Cell& corner) {
        grid_.for_cells(corner, [&](int cell, const Cell&) {
            const int row = grid_.row[cell];
            grid_.pressure[cell] = row < 0 ? 0.0f : static_cast<float>(impulse_[row] / dt);
        });
    });
}

// The pressure at the surface by its curvature. Where the parts of a step are too few, the tension is the largest that
// is stable.
void FluidSolver::apply_surface_tension(double dt, TaskPool& workers) {
    const double h = grid_.cell_size();
    const auto tension_of = [&](const FluidProperties& liquid) {
        return std::min(liquid.surface_tension, steady_tension(liquid.density, h, dt));
    };
    double most = 0;
    for (const FluidProperties& liquid : liquids_.liquids()) most = std::max(most, tension_of(liquid));
    surface_.measure(most * dt, settings_.tension, grid_, workers);
    if (!liquids_.is_one()) {
        std::vector<float> fractions(grid_.row.size(), 1);
        grid_.for_tiles(workers, [&](const Cell& corner) {
            grid_.for_cells(corner, [&](int cell, const Cell&) {
                fractions[cell] = static_cast<float>(liquids_.mean(grid_, cell, tension_of) / most);
            });
        });
        surface_.set_fractions(std::move(fractions));
    }
    add_surface_pressure(grid_, system_, surface_, flow_, workers);
}

FluidSolver::Push FluidSolver::push_on(const MovingObstacle& moving, std::span<const double> impulse) {
    Push push;
    for (const ObstacleArea& part : moving.areas) {
        push.linear += part.area * impulse[part.row];
        push.angular += part.moment * impulse[part.row];
    }
    return push;
}

void FluidSolver::change_obstacles(std::span<const double> impulse, double factor) {
    for (MovingObstacle& moving : obstacles_.moving()) {
        const Push push = push_on(moving, impulse);
        moving.linear_velocity += factor * moving.response.linear_change(push.linear, push.angular);
        moving.angular_velocity += factor * moving.response.angular_change(push.linear, push.angular);
    }
}

// What films press beyond the pressure of the cells at which they begin.
FluidSolver::Push FluidSolver::push_of_films(const MovingObstacle& moving, double dt) {
    Push push;
    for (const ObstacleArea& part : moving.areas) {
        push.linear += part.area * (part.head * dt);
        push.angular += part.moment * (part.head * dt);
    }
    return push;
}

void FluidSolver::change_by_films(double dt) {
    for (MovingObstacle& moving : obstacles_.moving()) {
        const Push push = push_of_films(moving, dt);
        moving.linear_velocity += moving.response.linear_change(push.linear, push.angular);
        moving.angular_velocity += moving.response.angular_change(push.linear, push.angular);
    }
}

void FluidSolver::push_obstacles(std::span<const double> impulse, double dt) {
    change_obstacles(impulse, 1);
    for (MovingObstacle& moving : obstacles_.moving()) {
        const Push push = push_on(moving, impulse), films = push_of_films(moving, dt);
        moving.obstacle->impulse += push.linear + films.linear;
        moving.obstacle->angular_impulse += push.angular + films.angular;
        release_liquid(moving);
    }
}

void FluidSolver::move_particles(double dt, Vec3 gravity, TaskPool& workers) {
    EMBODY_ZONE("move particles");
    const auto time = static_cast<float>(dt);
    const DropSurroundings around{grid_, obstacles_, settings_.drops, dt};
    const std::size_t count = grid_.on_grid();
    stopped_.assign(particles_.size(), 0);
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        ParticleCollider collider(grid_, obstacles_, settings_.collision, dt);
        for (std::size_t i = range.first; i < range.last; ++i) {
            FluidParticle& particle = particles_[i];
            FieldSample sample = sample_field(grid_, grid_.velocity, places_[i].data());
            float shift[3], end[3];
            sample_value(grid_, grid_.shift, places_[i].data(), shift);
            if (is_tense_) surface_.draw_in(grid_, places_[i].data(), shift);
            // A drop reads back what it wrote: a gradient that it carried would stay for ever.
            const bool is_single = is_drop(grid_, places_[i].data());
            const float steepest = is_single ? 0 : 1 / time;
            if (is_single) slow_at_wall(around, liquids_.at(i), places_[i].data(), sample.value);
            if (!liquids_.is_one() && !is_single) {
                const Vec3 change = to_vec(sample.value) - to_vec(particle.velocity);
                settle(grid_, liquids_, i, places_[i].data(), gravity - change / dt, dt, shift);
            }
            for (int a = 0; a < 3; ++a) {
                particle.velocity[a] = sample.value[a];
                set_gradient(sample.gradient[a], steepest, particle.affine[a]);
            }
            for (int a = 0; a < 3; ++a) end[a] = particle.position[a] + time * sample.value[a] + shift[a];
            stopped_[i] = collider.move(particle, end) ? 1 : 0;
        }
    });
}

// Drops away from all liquid: only walls that do not move are within reach.
void FluidSolver::fly(double dt, Vec3 change, TaskPool& workers) {
    const std::size_t first = grid_.on_grid(), count = particles_.size() - first;
    const DropSurroundings around{grid_, obstacles_, settings_.drops, dt};
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        ParticleCollider collider(grid_, obstacles_, settings_.collision, dt);
        for (std::size_t i = first + range.first; i < first + range.last; ++i) {
            FluidParticle& particle = particles_[i];
            float* velocity = particle.velocity;
            float end[3];
            for (int axis = 0; axis < 3; ++axis) velocity[axis] += static_cast<float>(change[axis]);
            slow_at_wall(around, liquids_.at(i), particle.position, velocity);
            for (int axis = 0; axis < 3; ++axis) {
                std::fill_n(particle.affine[axis], 3, 0.0f);
                end[axis] = particle.position[axis] + static_cast<float>(dt) * velocity[axis];
            }
            stopped_[i] = collider.move(particle, end) ? 1 : 0;
        }
    });
}

double FluidSolver::pressure_at(Vec3 p) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const double at = p[axis] / grid_.cell_size() - grid_.lower()[axis];
        if (!(at >= 1) || !(at < grid_.size()[axis] - 1)) return 0;
        cell[axis] = static_cast<int>(at);
    }
    if (!grid_.is_active(cell)) return 0;
    const float at[3] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    float gradient[3];
    return sample_center(grid_, grid_.pressure, at, gradient);
}

}  // namespace embody::physics::fluid
