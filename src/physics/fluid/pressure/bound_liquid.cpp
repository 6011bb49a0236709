// SPDX-License-Identifier: MIT
// docs/physics/fluids.md, "Thin walls".
#include "physics/fluid/pressure/bound_liquid.h"

#include <algorithm>

#include "physics/fluid/grid/grid.h"
#include "physics/fluid/obstacles/obstacles.h"

namespace embody::physics::fluid {

namespace {

Vec3 along(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }

// Pressure at a place next to a cell, as in liquid at rest under the cell's own; false if the cell is not liquid.
bool offer_pressure(const FluidGrid& grid, int cell, Vec3 to, Vec3 weight, double& pressure) {
    if (grid.row[cell] < 0) return false;
    pressure = std::max(pressure, grid.pressure[cell] + dot(weight, to));
    return true;
}

// Fraction of a face's control volume below the surface: from the pressure of the cells at the face, or of those beside
// them where both are shut. `weight`: density times gravity.
double liquid_fraction(const FluidGrid& grid, int axis, int cell, Vec3 weight) {
    const double h = grid.cell_size(), most = length(weight) * h;
    if (!(most > 0)) return 1;
    double pressure = -most;
    bool is_known = false;
    for (const int side : {0, 1}) {
        const int own = side == 0 ? cell - grid.stride(axis) : cell;
        const Vec3 to_face = along(axis) * (side == 0 ? h / 2 : -h / 2);
        if (offer_pressure(grid, own, to_face, weight, pressure)) {
            is_known = true;
            continue;
        }
        for (int other = 0; other < 3; ++other) {
            for (const int sign : {-1, 1}) {
                const Vec3 step = along(other) * (-sign * h);
                is_known =
                    offer_pressure(grid, own + sign * grid.stride(other), to_face + step, weight, pressure) || is_known;
            }
        }
    }
    return is_known ? std::clamp(pressure / most + 0.5, 0.0, 1.0) : 0.0;
}

// Inverse of the symmetric [A B; Bᵀ C] by its Schur complement.
ObstacleResponse inverse_of(const Mat3& a, const Mat3& b, const Mat3& c) {
    const Mat3 a_inverse = inverse_or_zero(a), ab = a_inverse * b;
    ObstacleResponse response;
    response.angular = inverse_or_zero(c - transpose(b) * ab);
    response.coupling = ab * response.angular * -1.0;
    response.linear = a_inverse - response.coupling * transpose(ab);
    return response;
}

}  // namespace

void bind_liquid(const FluidGrid& grid, double density, Vec3 gravity, MovingObstacle& moving) {
    const FluidObstacle& obstacle = *moving.obstacle;
    moving.response = {Mat3::identity() * obstacle.inverse_mass, Mat3::zero(), obstacle.inverse_inertia};
    if (!moving.is_in_reach || moving.bound.empty()) return;
    const double h = grid.cell_size(), volume = h * h * h;
    Mat3 masses = Mat3::zero(), couplings = Mat3::zero(), inertia = Mat3::zero();
    Vec3 momentum, angular_momentum;
    for (BoundFace& face : moving.bound) {
        face.mass = 0;
        if (!grid.known[face.axis][face.cell]) continue;
        const double rho = density * grid.relative_density(face.axis, face.cell);
        face.mass = rho * volume * face.fraction * liquid_fraction(grid, face.axis, face.cell, gravity * rho);
        face.speed = grid.velocity[face.axis][face.cell];
        const Vec3 n = along(face.axis);
        masses += outer(n, n) * face.mass;
        couplings += outer(n, face.turn) * face.mass;
        inertia += outer(face.turn, face.turn) * face.mass;
        momentum += n * (face.mass * face.speed);
        angular_momentum += face.turn * (face.mass * face.speed);
    }
    if (!(obstacle.inverse_mass > 0)) return;
    const double mass = 1 / obstacle.inverse_mass;
    const Mat3 own_inertia = inverse_or_zero(obstacle.inverse_inertia);
    moving.response = inverse_of(Mat3::identity() * mass + masses, couplings, own_inertia + inertia);
    const Vec3 linear = moving.linear_velocity * mass + momentum,
               angular = own_inertia * moving.angular_velocity + angular_momentum;
    moving.linear_velocity = moving.response.linear_change(linear, angular);
    moving.angular_velocity = moving.response.angular_change(linear, angular);
}

void release_liquid(MovingObstacle& moving) {
    if (!moving.is_in_reach) return;
    for (const BoundFace& face : moving.bound) {
        if (!(face.mass > 0)) continue;
        const double speed = moving.linear_velocity[face.axis] + dot(face.turn, moving.angular_velocity);
        const double impulse = face.mass * (face.speed - speed);
        moving.obstacle->impulse += along(face.axis) * impulse;
        moving.obstacle->angular_impulse += face.turn * impulse;
    }
}

}  // namespace embody::physics::fluid
