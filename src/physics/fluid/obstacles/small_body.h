// SPDX-License-Identifier: MIT
#pragma once

#include "math/vec3.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

struct MovingObstacle;

/// Drag of a sphere, N s/m: force over speed relative to the liquid, m/s. `radius` of the sphere of equal volume, m;
/// density, kg/m³, and dynamic viscosity, Pa s, of the liquid. J. M. Dallavalle, "Micromeritics", 2nd edition 1948: C_d
/// = (0.63 + 4.8 / √Re)², Re the Reynolds number of the diameter.
double drag_of_sphere(double radius, double speed, double density, double viscosity);

/// Drag between a body smaller than a cell and the liquid around it over dt, by equal and opposite impulses: the
/// body's goes to its velocity and its obstacle's impulse, the liquid's to the faces around.
void drag_small_body(FluidGrid& grid, const Mixture& liquids, double dt, MovingObstacle& moving);

}  // namespace embody::physics::fluid
