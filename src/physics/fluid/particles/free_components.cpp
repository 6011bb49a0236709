// SPDX-License-Identifier: MIT
#include "physics/fluid/particles/free_components.h"

#include <algorithm>

namespace embody::physics::fluid {

namespace {

// The row of the cell that a place lies in or, where that is air, of one beside it; −1: none.
std::int32_t row_near(const FluidGrid& grid, const float* place) {
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) c[axis] = static_cast<int>(grid.in_cells(place[axis], axis));
    const int cell = grid.index(c);
    std::int32_t row = grid.row[cell];
    for (int axis = 0; axis < 3 && row < 0; ++axis) {
        const int stride = grid.stride(axis);
        row = std::max(grid.row[cell - stride], grid.row[cell + stride]);
    }
    return row;
}

// Whether any of the liquid touches what does not move freely: this is checked first, since most liquid does.
bool touches_fixed(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles) {
    for (std::size_t row = 0; row < system.size(); ++row) {
        const auto cell = static_cast<int>(system.cell(row));
        const int owner = grid.obstacle_owner[cell];
        if (owner >= 0 && obstacles.moving()[static_cast<std::size_t>(owner)].obstacle->inverse_mass > 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
            if (grid.open[axis][cell] < 1 || grid.open[axis][cell + grid.stride(axis)] < 1) return true;
        }
    }
    return false;
}

}  // namespace

void FreeComponents::Component::add(Vec3 x, Vec3 v, double weight) {
    ++count;
    mass += weight;
    place += x * weight;
    velocity += v * weight;
    turn += cross(x, v) * weight;
    squares += outer(x, x) * weight;
}

// A thousandth more in all directions: components may be flat.
Mat3 FreeComponents::Component::inertia() const {
    const Mat3 central = squares - outer(place, place) * (1 / mass);
    return Mat3::identity() * (1.001 * trace(central)) - central;
}

std::int32_t FreeComponents::joined(std::int32_t component) const {
    while (joined_[static_cast<std::size_t>(component)] != component)
        component = joined_[static_cast<std::size_t>(component)];
    return component;
}

// A component that touches what does not move freely is not free; two that touch a common body are one.
void FreeComponents::touch(const FluidGrid& grid, const FluidObstacles& obstacles, int cell, std::int32_t component) {
    const int owner = grid.obstacle_owner[cell];
    if (owner < 0 || !(obstacles.moving()[static_cast<std::size_t>(owner)].obstacle->inverse_mass > 0)) {
        components_[static_cast<std::size_t>(component)].is_free = false;
        return;
    }
    Touched& body = bodies_[static_cast<std::size_t>(owner)];
    if (body.component < 0) body.component = component;
    const std::int32_t a = joined(body.component), b = joined(component);
    joined_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

// Component of the cell that a place lies in or is next to; a drop at a body belongs to the component that touches the
// body.
std::int32_t FreeComponents::component_at(const FluidGrid& grid, const float* place) const {
    const std::int32_t row = row_near(grid, place);
    if (row >= 0) return component_of_row_[static_cast<std::size_t>(row)];
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) c[axis] = static_cast<int>(grid.in_cells(place[axis], axis));
    const int cell = grid.index(c), owner = grid.obstacle_owner[cell];
    return owner >= 0 && grid.obstacle[cell] < settings_.body_distance
               ? bodies_[static_cast<std::size_t>(owner)].component
               : -1;
}

// Rows that are neighbours are of one component.
void FreeComponents::find(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles) {
    components_.clear();
    joined_.clear();
    bodies_.clear();
    for (const MovingObstacle& moving : obstacles.moving())
        bodies_.push_back({-1, moving.obstacle->impulse, moving.obstacle->angular_impulse});
    component_of_row_.assign(system.size(), -1);
    std::vector<std::size_t> to_visit;
    for (std::size_t first = 0; first < system.size(); ++first) {
        if (component_of_row_[first] >= 0) continue;
        const auto component = static_cast<std::int32_t>(components_.size());
        components_.push_back({.squares = Mat3::zero()});
        joined_.push_back(component);
        component_of_row_[first] = component;
        to_visit.push_back(first);
        while (!to_visit.empty()) {
            const auto cell = static_cast<int>(system.cell(to_visit.back()));
            to_visit.pop_back();
            for (int axis = 0; axis < 3; ++axis) {
                const int stride = grid.stride(axis);
                for (const int other : {cell - stride, cell + stride}) {
                    if (grid.open[axis][std::max(cell, other)] < 1) touch(grid, obstacles, cell, component);
                    if (grid.row[other] < 0) continue;
                    std::int32_t& its = component_of_row_[static_cast<std::size_t>(grid.row[other])];
                    if (its >= 0) continue;
                    its = component;
                    to_visit.push_back(static_cast<std::size_t>(grid.row[other]));
                }
            }
        }
    }
    for (std::int32_t component = 0; component < static_cast<std::int32_t>(components_.size()); ++component) {
        const bool is_free = components_[static_cast<std::size_t>(component)].is_free;
        if (!is_free) components_[static_cast<std::size_t>(joined(component))].is_free = false;
    }
    for (std::int32_t& component : component_of_row_) component = joined(component);
    for (Touched& body : bodies_) body.component = body.component < 0 ? -1 : joined(body.component);
}

void FreeComponents::begin(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles,
                           const ImmersedPoints& immersed, const std::vector<FluidParticle>& particles,
                           const Options& options) {
    settings_ = options.settings;
    components_.clear();
    component_of_particle_.clear();
    if (!options.all && touches_fixed(grid, system, obstacles)) return;
    find(grid, system, obstacles);
    component_of_particle_.assign(particles.size(), -1);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const std::int32_t component = component_at(grid, particles[i].position);
        if (component < 0) continue;
        Component& its = components_[static_cast<std::size_t>(component)];
        if (!its.is_free) continue;
        component_of_particle_[i] = component;
        its.add(to_vec(particles[i].position), to_vec(particles[i].velocity), options.liquids.relative_mass(i));
    }
    component_of_point_ = immersed.rows(grid);
    for (std::int32_t& row : component_of_point_) row = row < 0 ? -1 : component_of_row_[static_cast<std::size_t>(row)];
}

void FreeComponents::end(Vec3 change, const FluidObstacles& obstacles, const ImmersedPoints& immersed,
                         const Mixture& liquids, std::span<const std::uint8_t> stopped,
                         std::vector<FluidParticle>& particles) const {
    if (components_.empty()) return;
    const double particle_mass = liquids.first().density * liquids.first().particle_volume;
    const double min_turned = settings_.min_turned_particles;
    struct Correction {
        Vec3 linear, angular, center;
    };
    std::vector<Component> now(components_.size(), Component{.squares = Mat3::zero()});
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (component_of_particle_[i] < 0) continue;
        Component& its = now[static_cast<std::size_t>(component_of_particle_[i])];
        its.add(to_vec(particles[i].position), to_vec(particles[i].velocity), liquids.relative_mass(i));
        its.is_free = its.is_free && stopped[i] == 0;
    }
    std::vector<Correction> corrections(components_.size());  // so far as momenta over the particle mass
    for (std::size_t component = 0; component < components_.size(); ++component) {
        const Component &before = components_[component], &after = now[component];
        if (after.count == 0) continue;
        corrections[component] = {before.velocity - after.velocity + after.mass * change,
                                  before.angular_momentum() - after.angular_momentum(), after.center()};
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (bodies_[i].component < 0 || now[static_cast<std::size_t>(bodies_[i].component)].count == 0) continue;
        Correction& correction = corrections[static_cast<std::size_t>(bodies_[i].component)];
        const MovingObstacle& moving = obstacles.moving()[i];
        const Vec3 given = (moving.obstacle->impulse - bodies_[i].impulse) / particle_mass;
        const Vec3 turned = (moving.obstacle->angular_impulse - bodies_[i].angular_impulse) / particle_mass;
        correction.linear -= given;
        correction.angular -= turned + cross(moving.center - correction.center, given);
    }
    for (std::uint32_t point = 0; point < component_of_point_.size(); ++point) {
        const std::int32_t component = component_of_point_[point];
        if (component < 0 || now[static_cast<std::size_t>(component)].count == 0) continue;
        Correction& correction = corrections[static_cast<std::size_t>(component)];
        const Vec3 given = immersed.given(point) / particle_mass;
        correction.linear -= given;
        correction.angular -= cross(immersed.places()[point] - correction.center, given);
    }
    for (std::size_t component = 0; component < components_.size(); ++component) {
        const Component& after = now[component];
        if (after.count == 0) continue;
        if (!after.is_free) {
            corrections[component] = {};
            continue;
        }
        corrections[component].linear = corrections[component].linear / after.mass;
        corrections[component].angular = static_cast<double>(after.count) < min_turned
                                             ? Vec3{}
                                             : solve(after.inertia(), corrections[component].angular);
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if (component_of_particle_[i] < 0) continue;
        const Correction& by = corrections[static_cast<std::size_t>(component_of_particle_[i])];
        const Vec3 more = by.linear + cross(by.angular, to_vec(particles[i].position) - by.center);
        for (int axis = 0; axis < 3; ++axis) particles[i].velocity[axis] += static_cast<float>(more[axis]);
    }
}

}  // namespace embody::physics::fluid
