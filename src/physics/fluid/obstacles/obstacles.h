// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "math/transform.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/films.h"
#include "physics/fluid/obstacles/obstacle_probe.h"
#include "physics/fluid/obstacles/obstacle_region.h"
#include "physics/fluid/pressure/bound_liquid.h"

namespace embody::physics::fluid {

/// A rigid body as an obstacle of a fluid in a step.
struct FluidObstacle {
    std::uint32_t body = 0;  ///< caller's number; obstacles come in its order
    const CollisionShape* shape = nullptr;
    std::uint32_t version = 0;  ///< a new value after each change from outside
    bool is_static = false;     ///< never moves: measured once
    Transform pose;             ///< when the step begins, world
    Vec3 center;                ///< of mass, world, m
    Vec3 linear_velocity, angular_velocity;
    double inverse_mass = 0;  ///< 0: no fluid moves it
    Mat3 inverse_inertia = Mat3::zero();
    Vec3 acceleration, angular_acceleration;  ///< by everything but the fluid, as far as known

    Vec3 impulse, angular_impulse;  ///< result: of the fluid on it in this step, about its centre of mass, N s, N m s
};

/// Coupling of an obstacle's surface in a cell to the cell's pressure: its area vector, m², into the obstacle, and the
/// moment of it about the obstacle's centre of mass, m³.
struct ObstacleArea {
    int row = 0;
    Vec3 area, moment;
    double head = 0;  ///< Pa, beyond the cell's pressure, where the area is at a film that begins there
};

/// An obstacle that is or may be in motion, through the parts of a step.
struct MovingObstacle {
    FluidObstacle* obstacle = nullptr;
    Vec3 center;  ///< in the fluid's frame, in the middle of the part
    Quat rotation;
    Vec3 linear_velocity, angular_velocity;
    Vec3 kept_center;  ///< pose when particles were last kept out of it: at the part's start
    Quat kept_rotation;
    ObstacleProbe probe;
    ObstacleRegion region;
    std::array<std::vector<float>, 3> fraction;  ///< of faces, by the region's index: what other obstacles leave open
    std::vector<ObstacleArea> areas;
    std::vector<BoundFace> bound;
    ObstacleResponse response;
    bool is_in_reach = false;
    bool is_small = false;  ///< smaller than a cell: what it fills is spread around its centre

    [[nodiscard]] Vec3 velocity_at(Vec3 p) const { return linear_velocity + cross(angular_velocity, p - center); }
    /// Rotation at the end of the part.
    [[nodiscard]] Quat end_rotation(double dt) const;
};

/// Measures the obstacles on the grid: static ones once for each tile, the others in each part of a step.
class FluidObstacles {
public:
    explicit FluidObstacles(Vec3 origin) : origin_(origin) {}

    /// Before the parts of a step.
    void begin(std::span<FluidObstacle> obstacles, const FluidObstacleSettings& settings, FluidGrid& grid);
    /// Distance of the obstacles from where the last step left them, m: contacts and other forces moved them there.
    [[nodiscard]] double unexpected_displacement() const;
    /// Puts the obstacles where the last step left them, with velocities that bring them to their present places in a
    /// second; then restores their places and velocities.
    void begin_catching_up();
    void end_catching_up();
    /// Boxes that hold what the moving obstacles may meet in a part of that length, in the fluid's frame.
    [[nodiscard]] std::vector<Bounds> in_reach(double dt, double cell_size) const;
    /// Updates the probes of the moving obstacles to their present poses.
    void place();
    /// Measures with the poses in the middle of the part.
    void measure(double dt, FluidGrid& grid, TaskPool& workers);
    /// Forces but the fluid's change velocities.
    void accelerate(double dt);
    /// Once rows are known. `weight`: of the first liquid, N/m³.
    void list_areas(const FluidGrid& grid, Vec3 weight);
    /// Moves on to the end of the part.
    void advance(double dt);
    /// After the parts of a step.
    void end();

    [[nodiscard]] std::vector<MovingObstacle>& moving() { return moving_; }
    [[nodiscard]] const std::vector<MovingObstacle>& moving() const { return moving_; }
    /// An obstacle's velocity at a point by its number in the grid's obstacle_owner.
    [[nodiscard]] Vec3 velocity_at(int owner, Vec3 p) const {
        return owner < 0 ? Vec3{} : moving_[static_cast<std::size_t>(owner)].velocity_at(p);
    }
    /// Static obstacles as they stand in the fluid's frame.
    [[nodiscard]] const std::vector<ObstacleProbe>& fixed() const { return fixed_; }

private:
    void measure_static(FluidGrid& grid, TaskPool& workers);
    void measure_static_tile(FluidGrid& grid, const Cell& corner, std::vector<ObstacleProbe>& probes,
                             ObstacleRegion& region);
    static void measure_moving(MovingObstacle& moving, const FluidGrid& grid);
    void place_moving(MovingObstacle& moving, int owner, FluidGrid& grid);

    /// Where a step left a body.
    struct LeftBody {
        std::uint32_t body, version;
        Vec3 center;
        Quat rotation;
    };
    [[nodiscard]] const LeftBody* left(const FluidObstacle& obstacle) const;
    void put_where_it_is(MovingObstacle& moving) const;

    Vec3 origin_;
    FluidObstacleSettings settings_;  // of the last begin()
    std::vector<MovingObstacle> moving_;
    Films films_;
    std::vector<LeftBody> left_;
    std::vector<ObstacleProbe> fixed_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fixed_versions_;
};

}  // namespace embody::physics::fluid
