// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/pressure/pressure_system.h"
#include "physics/fluid/pressure/surface_tension.h"

namespace embody::physics::fluid {

/// Sets faces without a velocity to the mean of their neighbours', in `layers` layers around the known faces.
void extrapolate(FluidGrid& grid, std::array<std::vector<float>, 3>& field, int layers, TaskPool& workers);

/// Unknown faces that particles reach take the particles' velocity.
void admit_drops(FluidGrid& grid, TaskPool& workers);

/// Velocity at a face; the components across are means of the four nearest faces, m/s.
Vec3 velocity_around(const FluidGrid& grid, int axis, int cell);

/// Of faces between liquid cells, (dt/2) (u·∇)u: particles go straight for dt, so that their velocity is the one
/// halfway along a curved path (docs/physics/fluids.md, "Paths").
void find_convection(FluidGrid& grid, double dt, TaskPool& workers);

/// A value at a face.
struct FaceValue {
    int axis, cell;
    float value;
};

/// Of the air's faces beside the liquid's, by what the velocity changes along the surface from the middle of those to
/// the face, m/s (docs/physics/fluids.md, "Surface").
void find_surface_change(const FluidGrid& grid, std::vector<FaceValue>& change, TaskPool& workers);

/// To what degree the liquid at a face sticks to a wall: axis, cell.
using Sticking = std::function<double(int, int)>;

/// Shut faces move as the obstacle does: along its normal, or wholly where the obstacle is thin. To the degree that the
/// liquid sticks (1: its layer at the wall is thicker than a cell, 0: much thinner) they are set such that the velocity
/// at the surface is the obstacle's.
void follow_obstacles(FluidGrid& grid, const FluidObstacles& obstacles, const Sticking& sticking, TaskPool& workers);

void add_to_faces(FluidGrid& grid, std::span<const FaceValue> change);

/// Volume that flows out of each liquid cell by faces, less their convection, and by surfaces of obstacles, m³/s.
void outflow(const FluidGrid& grid, const FluidObstacles& obstacles, const PressureSystem& system,
             std::vector<double>& flow, TaskPool& workers);

/// Adds the effect of the pressure at the surface to the right hand side of the pressure's equation.
void add_surface_pressure(const FluidGrid& grid, const PressureSystem& system, const SurfacePressure& surface,
                          std::vector<double>& b, TaskPool& workers);

/// The gradient of a solution of the pressure's equation, times a number.
struct PressureGradient {
    const PressureSystem& system;
    std::span<const double> x;       ///< by row
    const SurfacePressure& surface;  ///< x at the surface
    double scale = 1;
};

/// Adds −`scale` β ∂x to the open faces of liquid cells (∂x: difference over the distance to the neighbour or the
/// surface, in cells; β: the face's mobility). Other faces become unknown.
void subtract_gradient(FluidGrid& grid, const PressureGradient& gradient, std::array<std::vector<float>, 3>& field,
                       TaskPool& workers);
/// Adds −`scale` β ∂p of the last step's pressure to the known faces beside liquid. Where there was no liquid in the
/// last step the gradient is that of the next face inwards, and of one cell alone none.
void subtract_last_gradient(FluidGrid& grid, double scale, TaskPool& workers);

}  // namespace embody::physics::fluid
