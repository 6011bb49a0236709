// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "physics/definitions/settings/fluid_pressure_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/mixture.h"
#include "physics/linear/conjugate_gradient.h"

namespace embody::physics::fluid {

/// Whether viscosity is more than rounding in a step of dt on cells of h.
bool is_viscous(const FluidProperties& liquid, const FluidViscositySettings& settings, double h, double dt);

/// Degree to which a liquid sticks to walls on cells of h, 0 … 1: by the Reynolds number of a cell at `speed`, m/s.
/// Layers at walls that are thinner than a cell are not resolved: there the liquid slides.
double sticking_of(const FluidProperties& liquid, const FluidViscositySettings& settings, double h, double speed);

/// Implicit viscous step of the face velocities, with no slip at obstacles, no stress at the surface, and the bodies
/// that it moves as unknowns (docs/physics/fluids.md, "Viscosity").
class ViscositySystem {
public:
    /// Measures how fast the liquid is sheared, which a yield stress asks for.
    void begin(const Mixture& liquids, double dt, const FluidViscositySettings& settings, const FluidGrid& grid,
               const FluidObstacles& obstacles);
    /// Changes the velocities of faces and of moving obstacles, and adds to the obstacles' impulses. Returns the
    /// iterations; one more than the settings' where they did not suffice.
    int solve(const Mixture& liquids, double dt, FluidGrid& grid, FluidObstacles& obstacles);

private:
    /// A rate of strain: signed sum of up to four velocities, and its weight.
    struct Strain {
        std::int32_t face[4];  // −1: none
        double weight;
    };
    struct FixedFace {
        int axis, owner;
        Vec3 arm;  // from the owner's centre, m
    };
    void number_faces(const FluidGrid& grid, const FluidObstacles& obstacles);
    std::int32_t fixed_face(const FluidGrid& grid, const FluidObstacles& obstacles, int axis, int cell, const Cell& c);
    void measure_rates(const Mixture& liquids, double dt, const FluidGrid& grid);
    void list_strains(const FluidGrid& grid, const FluidObstacles& obstacles, double scale);
    void add_edge(const FluidGrid& grid, const FluidObstacles& obstacles, int a, int b, int cell, const Cell& c,
                  double scale);
    void list_bodies(double density, const FluidGrid& grid, const FluidObstacles& obstacles);
    void multiply(std::vector<double>& x, std::vector<double>& y);
    void set_fixed(std::vector<double>& x) const;
    void start_from(const FluidGrid& grid, const FluidObstacles& obstacles);
    void fill_diagonal();
    void fill_residual();
    GradientResidual precondition();
    int iterate();
    void write_back(double density, FluidGrid& grid, FluidObstacles& obstacles);

    /// A body that the liquid moves: its six unknowns come after the faces'.
    struct Body {
        int owner;
        double mass;
        Mat3 inertia;
        Vec3 linear_before, angular_before;
    };
    FluidViscositySettings settings_;                  // of this solve
    std::array<std::vector<std::int32_t>, 3> number_;  // of faces by cell; −1: none
    std::vector<float> viscosity_;                     // by cell, Pa s; 0: no liquid
    std::vector<std::pair<int, int>> faces_;           // axis, cell
    std::vector<FixedFace> fixed_;
    std::vector<Strain> strains_;
    std::vector<Body> bodies_;
    std::vector<std::int32_t> body_of_;  // by owner; −1: none
    std::vector<double> inertia_;        // of free faces, in volumes of a cell of the first liquid
    std::vector<double> x_, r_, z_, p_, q_, diagonal_;
};

}  // namespace embody::physics::fluid
