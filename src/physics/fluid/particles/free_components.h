// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/mat3.h"
#include "math/vec3.h"
#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/immersed_points.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/pressure/pressure_system.h"

namespace embody::physics::fluid {

/// Connected components of liquid that touch nothing, or only bodies that move freely; those that touch a common body
/// are one. The forces of the cells on a component have a spurious resultant and moment: surface tension would push and
/// turn it, and a body's impulses on it would be wrong, since the faces' masses are not the particles'.
class FreeComponents {
public:
    struct Options {
        const Mixture& liquids;
        bool all = false;  ///< else the components are found only where the whole fluid is free
        FluidComponentSettings settings;
    };
    /// Finds the components and the momenta of their particles and of the bodies. Rows are known, and the bodies have
    /// not been changed in this part of the step.
    void begin(const FluidGrid& grid, const PressureSystem& system, const FluidObstacles& obstacles,
               const ImmersedPoints& immersed, const std::vector<FluidParticle>& particles, const Options& options);
    /// For the same particles after they moved: restores the momentum of each component, less what its bodies and the
    /// points in it were given, and likewise the angular momentum about its centre. One of which what does not move
    /// freely has stopped a particle on its path is free no more. `change`: of all velocities by gravity, m/s;
    /// `stopped`: by particle.
    void end(Vec3 change, const FluidObstacles& obstacles, const ImmersedPoints& immersed, const Mixture& liquids,
             std::span<const std::uint8_t> stopped, std::vector<FluidParticle>& particles) const;

private:
    /// Sums over a component's particles, m and m/s.
    struct Component {
        bool is_free = true;
        std::size_t count = 0;
        double mass = 0;             // in particles of the first liquid
        Vec3 place, velocity, turn;  // of x, v, x × v, by mass
        Mat3 squares;                // of x xᵀ, by mass
        void add(Vec3 x, Vec3 v, double weight);
        [[nodiscard]] Vec3 center() const { return place / mass; }
        [[nodiscard]] Vec3 angular_momentum() const { return turn - cross(place, velocity) / mass; }
        [[nodiscard]] Mat3 inertia() const;
    };
    /// A body that a component touches, with the impulse that it had got before.
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
    std::vector<Touched> bodies_;                   // as obstacles.moving()
    std::vector<std::int32_t> component_of_point_;  // of immersed ones; −1: none
};

}  // namespace embody::physics::fluid
