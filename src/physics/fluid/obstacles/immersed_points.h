// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "math/bounds.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/immersed_drag.h"
#include "physics/fluid/particles/mixture.h"

namespace embody::physics::fluid {

class PressureSystem;

/// A part of something that bends, small beside a cell.
struct ImmersedPoint {
    Vec3 position;            ///< when the step begins, world, m
    Vec3 velocity;            ///< then, m/s
    Vec3 acceleration;        ///< by what acts on its mass, m/s²
    Vec3 support;             ///< by what holds it and the liquid that its drag binds to it, as far as known, N
    double volume = 0;        ///< m³
    double inverse_mass = 0;  ///< 1/kg; 0: nothing moves it
    ImmersedForm form;

    Vec3 impulse;  ///< result: of the fluid on it in this step, N s
    Vec3 drag;     ///< result: its drag in this step, by axis, kg
    Vec3 dragged;  ///< result: what of the impulse is by that drag, N s
    Vec3 end;      ///< result: its place when the step ends, world, m
};

/// The second matter on the faces of a grid: what bends, by points of which the faces around them have parts by mass,
/// volume and drag. Each part is eliminated from the pressure's equation at its face. docs/physics/coupling.md,
/// "Liquids and what bends".
class ImmersedPoints {
public:
    /// Before the parts of a step. `origin` of the fluid's frame.
    void begin(std::span<ImmersedPoint> points, Vec3 origin);
    [[nodiscard]] bool is_empty() const { return points_.empty(); }
    /// Boxes that hold what the points may meet in a part of that length, in the fluid's frame.
    void add_reach(double dt, double cell_size, std::vector<Bounds>& boxes) const;
    /// Shares the points among the faces around their places in the middle of the part; takes their volume from the
    /// grid's room. The obstacles are measured.
    void measure(double dt, FluidGrid& grid);
    /// Drag by the slip that the part begins with, and what faces let through: the grid's conductances. The grid has
    /// the particles' velocities, not yet accelerated.
    void find_conductance(double dt, const Mixture& liquids, FluidGrid& grid);
    /// Before predict(): rows are known; forces have changed the grid's velocities. Sets bound().
    void start(const FluidGrid& grid);
    /// Velocities that the points' accelerations and drag alone lead to; again where accelerations have changed.
    void predict(double dt, FluidGrid& grid);
    /// Adds what the faces' second matter carries out of the liquid's cells, m³/s.
    void add_outflow(const FluidGrid& grid, std::span<double> flow) const;
    /// What the pressure leads to: `impulse` by row, N s/m². Sets given().
    void find_impulses(const PressureSystem& system, std::span<const double> impulse, const FluidGrid& grid);
    /// After find_impulses(): lets the pressure act on both matters.
    void apply_pressure(FluidGrid& grid);
    /// What the grid knows of the points is forgotten, as where the liquid moves without them.
    static void leave(FluidGrid& grid);
    /// Moves on to the end of the part.
    void advance(double dt);

    /// Places in the middle of the part, in the fluid's frame, and what the liquid gave to the points in it, N s.
    [[nodiscard]] const std::vector<Vec3>& places() const { return places_; }
    [[nodiscard]] Vec3 given(std::uint32_t point) const { return impulses_[point]; }
    /// What given() changes by if the point ends the part with another velocity, by axis, kg: by its drag and the
    /// liquid at its faces, which all drag there holds together.
    [[nodiscard]] Vec3 bound(std::uint32_t point) const { return bound_[point]; }
    /// After find_impulses(): mean velocity of the point's parts at faces at the part's end, with that liquid, m/s.
    [[nodiscard]] Vec3 velocity_after(std::uint32_t point) const { return after_[point]; }
    /// By point: a row of the pressure's equation at its faces; −1: none. Rows are known.
    [[nodiscard]] std::vector<std::int32_t> rows(const FluidGrid& grid) const;

private:
    /// The two matters at a face; h is the cell's length.
    struct Face {
        int axis = 0, cell = 0;
        double open = 0;        // fraction that rigid obstacles leave
        double liquid = 0;      // of the control volume
        double through = 0;     // liquid + Σ r φ: flow by the liquid's velocity
        double mass = 0;        // of the liquid, kg
        double filled = 1;      // fraction of that mass that particles have
        double held = 0;        // Σ c q, kg
        double drag = 0;        // Σ c, kg
        double start = 0;       // u when the points begin to act, m/s
        double solid_flow = 0;  // Σ φ q v, m/s
        double momentum = 0;    // Σ c q v − Σ lag, kg m/s
        double dragged = 0;     // Σ r φ
        double yields = 0;      // Σ φ²/(m + c), 1/kg
        double speed = 0;       // u, m/s
        double step = 0;        // of the pressure's impulse density, N s/m²
    };
    /// What a face has of a point. The point's part moves with v = q v* + r u − φ h² a ΔP.
    struct FacePart {
        std::uint32_t point = 0, face = 0;
        double weight = 0;
        double drag = 0;   // c, kg
        double lag = 0;    // impulse of the explicit part of the drag on the point, N s
        double bound = 0;  // liquid that it holds, kg
    };
    struct Response {
        double a = 0, q = 1, r = 0;  // 1/(m + s c), m a, s c a
    };
    [[nodiscard]] Response response_of(const FacePart& part) const;
    [[nodiscard]] double speed_before(const FacePart& part) const;  // m/s
    [[nodiscard]] Vec3 end_velocity(std::uint32_t point) const {
        return velocities_[point] + dt_ * points_[point].acceleration +
               points_[point].inverse_mass * (dt_ * points_[point].support + impulses_[point]);
    }
    [[nodiscard]] double speed_after(const FacePart& part) const;
    [[nodiscard]] double push_on(const FacePart& part) const;
    [[nodiscard]] double fraction_of(const FacePart& part) const {
        return part.weight * points_[part.point].volume / (cell_ * cell_ * cell_);
    }
    bool add_parts(std::uint32_t point, FluidGrid& grid);
    void spread_volume(std::uint32_t point, FluidGrid& grid);
    void leave_out_dry(const FluidGrid& grid);

    Vec3 origin_;
    double cell_ = 0;
    double particle_mass_ = 0;  // of the first liquid, kg
    std::span<ImmersedPoint> points_;
    double dt_ = 0;  // of the part, s
    std::vector<Vec3> places_, velocities_, impulses_, bound_, after_;
    std::vector<std::uint32_t> on_grid_;  // points with shares
    std::vector<Face> faces_;
    std::vector<FacePart> parts_;
    std::array<std::vector<std::int32_t>, 3> face_at_;  // by cell: index of the face; −1: none
};

}  // namespace embody::physics::fluid
