// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "physics/definitions/fluid_definition.h"
#include "physics/definitions/settings/fluid_settings.h"
#include "physics/definitions/step_report.h"
#include "physics/fluid/grid/faces.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/immersed_points.h"
#include "physics/fluid/obstacles/obstacles.h"
#include "physics/fluid/particles/free_components.h"
#include "physics/fluid/particles/mixture.h"
#include "physics/fluid/particles/point_bonds.h"
#include "physics/fluid/pressure/pressure_system.h"
#include "physics/fluid/pressure/surface_tension.h"
#include "physics/fluid/pressure/viscosity.h"

namespace embody::physics::fluid {

/// Result of a step of a fluid.
struct FluidOutcome {
    int parts = 0;                                          ///< the step was solved in
    int pressure_iterations = 0, viscosity_iterations = 0;  ///< over all parts
    std::size_t lost = 0;                                   ///< particles that flew out of reach
    bool is_finite = true;   ///< false: the particles are of no use; no obstacle was pushed
    bool is_solved = true;   ///< false: a solve ended early
    bool is_slowed = false;  ///< particles were faster than the parts allow
};

/// What immersed points are held by answers to what a solve of the pressure found for them, in a part of a step of dt
/// seconds: the liquid's impulses on them (N s) and what these change by if a point ends the part with another
/// velocity, by axis, kg. Returns whether it has changed accelerations of the points: then the part is solved again
/// with these.
using PointResponse = std::function<bool(double dt, const ImmersedPoints& points)>;

/// A liquid, or several: particles that carry it and a grid on which its pressure and viscosity are solved, with the
/// rigid bodies in the same equations. docs/physics/fluids.md.
class FluidSolver {
public:
    /// Positions in the frame of world axes at `origin`.
    FluidSolver(Vec3 origin, double cell_size, const FluidProperties& properties, std::span<const Vec3f> positions,
                Vec3 velocity);

    /// The numbers that steer the next calls; the caller sets them in each step.
    void set_settings(const FluidSettings& settings) { settings_ = settings; }
    /// Prepares the grid and the static obstacles on it for the first step.
    void prepare(std::span<FluidObstacle> obstacles, TaskPool& workers);
    /// Advances by dt; the impulses of obstacles and immersed points are set.
    FluidOutcome advance(double dt, Vec3 gravity, std::span<FluidObstacle> obstacles, TaskPool& workers,
                         std::span<ImmersedPoint> points = {}, const PointResponse& respond = {});

    /// After advance(): the liquid that immersed points hold, and impulses on it (point_bonds.h).
    void find_bonds(std::span<PointBond> bonds) const {
        fluid::find_bonds(grid_.cell_size(), liquids_, particles_, bonds);
    }
    void push_bonds(std::span<const PointBond> bonds, std::span<const Vec3> impulses) {
        fluid::push_bonds(grid_.cell_size(), liquids_, bonds, impulses, particles_);
    }

    /// After a step: moves the obstacles to their places after contacts and keeps the particles out of them there.
    struct Followed {
        bool is_solved = true;
        std::size_t lost = 0;  ///< particles out of reach
    };
    Followed follow(std::span<FluidObstacle> obstacles, TaskPool& workers);

    [[nodiscard]] Vec3 origin() const { return origin_; }
    /// Of the first liquid; all have particles of its volume.
    [[nodiscard]] const FluidProperties& properties() const { return liquids_.first(); }
    [[nodiscard]] const Mixture& liquids() const { return liquids_; }
    [[nodiscard]] const FluidGrid& grid() const { return grid_; }
    [[nodiscard]] const std::vector<FluidParticle>& particles() const { return particles_; }
    /// All particles are of this liquid from now on; their volume stays.
    void set_matter(FluidProperties matter) {
        matter.particle_volume = properties().particle_volume;
        liquids_ = matter;
    }
    /// The particles with these ids are of this liquid from now on; their volume stays.
    void set_matter(FluidIds ids, const FluidProperties& matter);
    /// Energies and momenta, of the particles as points.
    [[nodiscard]] Conserved conserved(Vec3 gravity) const;
    /// The speed that all but a few drops stay below, m/s; there is liquid.
    [[nodiscard]] double usual_speed(TaskPool& workers) const;
    /// Whether heavier liquid lies above lighter one.
    [[nodiscard]] bool is_top_heavy(Vec3 gravity) const { return liquids_.is_top_heavy(grid_, gravity); }
    /// Adds particles at rest; their ids follow all earlier ones.
    FluidIds add_particles(std::span<const Vec3f> positions);
    /// Removes the particles in a ball of the world; returns their number.
    std::size_t take_within(Vec3 center, double radius);
    /// Removes the particles with these ids; returns them in the order of the ids.
    std::vector<FluidParticle> take_particles(FluidIds ids);
    /// Adds particles as they are, from a frame of world axes at `origin`; their ids follow all earlier ones, or begin
    /// with `first`, which was kept.
    FluidIds add_particles(std::vector<FluidParticle> particles, Vec3 origin, std::optional<std::uint32_t> first = {});
    [[nodiscard]] std::uint32_t next_id() const { return next_id_; }
    /// Keeps so many ids free, which follow all earlier ones.
    FluidIds keep_ids(std::uint32_t count) {
        next_id_ += count;
        return {next_id_ - count, next_id_};
    }
    /// Changes the particles with these ids by `change`, in world coordinates.
    void change_particles(FluidIds ids, const FluidChange& change);
    /// Stops all motion.
    void stop();
    /// Puts the particles at these places, at rest.
    void put_at_rest(std::span<const Vec3f> positions, std::span<const std::uint32_t> ids);
    /// Pressure at a place of the fluid's frame, Pa; 0 outside the liquid.
    [[nodiscard]] double pressure_at(Vec3 p) const;

private:
    void keep_out(TaskPool& workers);
    void displace(double fraction, Followed& followed, TaskPool& workers);
    struct Part {
        double dt = 0;  // s
        Vec3 gravity;   // m/s²
        const PointResponse& respond;
    };
    void advance_part(const Part& part, FluidOutcome& outcome, TaskPool& workers);
    void advance_grid(const Part& part, FluidOutcome& outcome, TaskPool& workers);
    void fly(double dt, Vec3 change, TaskPool& workers);
    [[nodiscard]] float particle_fraction() const;  // of a cell's volume
    void find_places(double dt, TaskPool& workers);
    void accelerate(Vec3 change, TaskPool& workers);
    void project(const Part& part, FluidOutcome& outcome, TaskPool& workers);
    void shear(double dt, FluidOutcome& outcome, TaskPool& workers);
    [[nodiscard]] Sticking sticking() const;
    void apply_surface_tension(double dt, TaskPool& workers);
    void spread_out(TaskPool& workers);
    void move_particles(double dt, Vec3 gravity, TaskPool& workers);
    struct Push {
        Vec3 linear, angular;  // N s, N m s
    };
    static Push push_on(const MovingObstacle& moving, std::span<const double> impulse);
    void change_obstacles(std::span<const double> impulse, double factor);
    static Push push_of_films(const MovingObstacle& moving, double dt);
    void change_by_films(double dt);
    void push_obstacles(std::span<const double> impulse, double dt);

    Vec3 origin_;
    FluidSettings settings_;  // of this step
    Mixture liquids_;
    FluidGrid grid_;
    FluidObstacles obstacles_;
    ImmersedPoints immersed_;
    PressureSystem system_;
    ViscositySystem viscosity_;
    SurfacePressure surface_;
    FreeComponents components_;
    std::vector<FluidParticle> particles_;
    std::uint32_t next_id_ = 0;
    std::vector<std::array<float, 3>> places_;  // places at which they meet the grid
    std::vector<std::uint8_t> stopped_;         // 1: what does not move freely has stopped it in this part
    std::vector<double> flow_, impulse_, potential_;
    std::vector<FaceValue> surface_change_;
    double speed_ = 0;       // usual one when the step began, m/s
    bool is_tense_ = false;  // its surface has tension in this step
};

}  // namespace embody::physics::fluid
