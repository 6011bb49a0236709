// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"
#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {

/// Lumps of liquid that touch nothing, or only bodies that move freely; those that share a body are one. What the cells
/// do to a component has a resultant and a moment that it must not have: the tension of its surface would push and turn
/// it, and what a body gives it would not arrive, since the faces' masses are not the particles'.
class FreeComponents {
public:
    struct Options {
        bool all = false;  ///< else only where the whole fluid is free
        FluidComponentSettings settings;
    };
    /// Finds them, and what momentum their particles and the bodies have. Rows are known, and nothing has been done to
    /// the bodies in this part of the step.
    void begin(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles,
               const std::vector<FluidParticle>& particles, const Options& options);
    /// The same particles after they moved: each component gets the momentum that it had, less what its bodies were
    /// given, and so it does with the angular momentum about its centre. `change`: of all velocities by gravity, m/s.
    void end(Vec3 change, const FluidObstacles& obstacles, double particle_mass,
             std::vector<FluidParticle>& particles) const;

private:
    /// Sums over its particles, m and m/s.
    struct Component {
        bool is_free = true;
        double count = 0;
        Vec3 place, velocity, turn;  // of x, v, x × v
        Mat3 squares;                // of x xᵀ
        void add(Vec3 x, Vec3 v);
        [[nodiscard]] Vec3 center() const { return place / count; }
        [[nodiscard]] Vec3 angular_momentum() const { return turn - cross(place, velocity) / count; }
        [[nodiscard]] Mat3 inertia() const;
    };
    /// A body that a component touches, with what it was given before.
    struct Touched {
        std::int32_t component = -1;
        Vec3 impulse, angular_impulse;
    };
    void find(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles);
    void touch(const FluidGrid& grid, const FluidObstacles& obstacles, int cell, std::int32_t component);
    [[nodiscard]] std::int32_t joined(std::int32_t component) const;
    [[nodiscard]] std::int32_t component_at(const FluidGrid& grid, const float* place) const;

    FluidComponentSettings settings_;                                     // of the last begin()
    std::vector<std::int32_t> component_of_row_, component_of_particle_;  // −1: a drop of its own
    std::vector<std::int32_t> joined_;  // by component: an earlier one that it is part of, or itself
    std::vector<Component> components_;
    std::vector<Touched> bodies_;  // as obstacles.moving()
};

}  // namespace embody::physics::fluid
