// SPDX-License-Identifier: MIT
// docs/physics/fluids.md, "Bodies smaller than a cell".
#include "physics/fluid/obstacles/small_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

using std::numbers::pi;

// A force F on the faces around a place moves a viscous liquid there by F/(g μ h), h the cell's length: g of trilinear
// weights by P. Ahlrichs, B. Dünweg, "Simulation of a single polymer chain in solution", J. Chem. Phys. 111 (1999).
constexpr double grid_mobility = 25;  // g, a number

// Drag against the liquid's velocity at the body, of which a part is the body's own doing: in creeping flow 1/D less
// 1/(g μ h). Where the liquid is swept on within a cell, Re of the cell's length above one, it does not see that.
double without_own_flow(double drag, double speed, double density, double viscosity, double h) {
    if (!(viscosity > 0)) return drag;
    constexpr double most = 0.5;  // of a body as large as a cell, 6 π r/(g h) is 0.38
    const double own = drag / (grid_mobility * viscosity * h) / (1 + density * speed * h / viscosity);
    return drag / (1 - std::min(own, most));
}

}  // namespace

double drag_of_sphere(double radius, double speed, double density, double viscosity) {
    // C_d |u| = (0.63 √|u| + 4.8 √(μ / (ρ d)))², without a division by the speed.
    const double root = 0.63 * std::sqrt(speed) + 4.8 * std::sqrt(viscosity / (density * 2 * radius));
    return density / 2 * pi * radius * radius * root * root;
}

void drag_small_body(FluidGrid& grid, const Mixture& liquids, double dt, MovingObstacle& moving) {
    FluidObstacle& obstacle = *moving.obstacle;
    if (!moving.is_small || !moving.is_in_reach || !(obstacle.inverse_mass > 0)) return;
    const float place[3] = {static_cast<float>(moving.center.x), static_cast<float>(moving.center.y),
                            static_cast<float>(moving.center.z)};
    const auto [density, viscosity] = liquids.around(grid, place);
    const double particle_mass = liquids.first().density * liquids.first().particle_volume;
    float gradient[3];
    const double wet = std::clamp<double>(sample_center(grid, grid.density, place, gradient), 0, 1);
    const double volume = obstacle.shape->mass_properties().volume, radius = std::cbrt(volume * 0.75 / pi);
    Vec3 liquid;  // the liquid's velocity around the body
    // Change of that by a unit impulse; the weighted mass at the faces; that over what full faces have.
    std::array<double, 3> answer{}, mass{}, fullness{};
    const double h = grid.cell_size();
    std::array<FaceWeights, 3> around;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        around[axis] = face_weights(grid, place, static_cast<int>(axis));
        double weights = 0, squares = 0;
        for (FaceWeight& face : around[axis]) {
            if (!grid.known[axis][face.cell] || !(grid.mass[axis][face.cell] > 0)) face.weight = 0;
            weights += face.weight;
            squares += static_cast<double>(face.weight) * face.weight;
            mass[axis] += face.weight * (grid.mass[axis][face.cell] * particle_mass);
            liquid[static_cast<int>(axis)] += static_cast<double>(face.weight) * grid.velocity[axis][face.cell];
        }
        if (!(weights > 0)) return;
        liquid[static_cast<int>(axis)] /= weights;
        answer[axis] = squares / (weights * mass[axis]);
        fullness[axis] = std::min(1.0, mass[axis] / (weights * density * h * h * h));
    }
    const Vec3 slip = liquid - moving.linear_velocity;
    const double speed = length(slip), free = drag_of_sphere(radius, speed, density, viscosity);
    const double drag = wet * dt * without_own_flow(free, speed, density, viscosity, h);
    if (!(drag > 0)) return;
    // What holds the liquid around to the rest within this time: the viscosity spreads the impulse, as far as there is
    // liquid. Without that drops and the rim of a film got the impulse of what is not there.
    const double spread = grid_mobility * viscosity * h * dt;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        const double held = fullness[axis] * spread;
        const double impulse = slip[a] / (1 / drag + obstacle.inverse_mass + 1 / (1 / answer[axis] + held));
        obstacle.impulse[a] += impulse;
        moving.linear_velocity[a] += impulse * obstacle.inverse_mass;
        for (const FaceWeight& face : around[axis]) {
            grid.velocity[axis][face.cell] -= static_cast<float>(impulse * face.weight / mass[axis]);
        }
    }
}

}  // namespace embody::physics::fluid
