// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "physics/definitions/settings/fluid_obstacle_settings.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/obstacles/obstacles.h"

namespace embody::physics::fluid {

/// Keeps particles out of obstacles: by the grid's distances, and beside walls thinner than a cell by the true shapes.
/// One a worker.
class ParticleCollider {
public:
    ParticleCollider(const FluidGrid& grid, const FluidObstacles& obstacles, const FluidCollisionSettings& settings,
                     double dt);
    /// Place at which a particle meets the grid: its own, restricted to its side of thin walls.
    std::array<float, 3> place_of(const FluidParticle& particle);
    /// Moves the particle towards `end`, a place of the fluid's frame, as far as obstacles allow. Returns whether what
    /// does not move freely has taken any of its velocity.
    bool move(FluidParticle& particle, const float* end);
    /// Whether the true shapes are queried there.
    [[nodiscard]] bool is_near_thin(const float* position) const;

private:
    /// A piece of the part, as fractions of it.
    struct Span {
        double first = 0, last = 1;
    };
    /// A wall that was met.
    struct Wall {
        Vec3 normal, velocity;
        bool is_free = false;  ///< moves by forces
    };
    void stride(FluidParticle& particle, const float* to, const Span& when);
    void push_out(FluidParticle& particle, Vec3 before, const Span& when);
    [[nodiscard]] bool sees(Vec3 from, Vec3 to);
    void sweep(FluidParticle& particle, Vec3 from, Vec3 to, const Span& when);
    [[nodiscard]] bool bar(const ObstacleProbe& probe, Vec3 from, Vec3& to, Vec3& normal) const;
    void stop_at(FluidParticle& particle, const Wall& wall);
    void look_around(const Bounds& swept);

    /// Place of a moving obstacle at a time of the part, and places beside it transformed to the middle of the part.
    struct Pose {
        Vec3 center;
        Quat rotation;
        Vec3 middle;  ///< its centre there
        Mat3 turn = Mat3::identity();
        [[nodiscard]] Vec3 seen(Vec3 p) const { return middle + turn * (p - center); }
        [[nodiscard]] Vec3 back(Vec3 p) const { return center + transpose(turn) * (p - middle); }
    };
    struct Mover {
        ObstacleProbe probe;
        const MovingObstacle* obstacle;
        Pose before, end;
        double shift = 0;  ///< maximum distance of its centre from that in the middle of the part, m
        double turn = 0;   ///< the same of a point of it by rotation alone, over its distance from the centre
        [[nodiscard]] Pose at(double fraction) const;
        [[nodiscard]] Pose posed(Vec3 center, Quat rotation) const;
        [[nodiscard]] bool is_free() const { return obstacle->obstacle->inverse_mass > 0; }
        [[nodiscard]] bool is_met() const { return obstacle->is_in_reach && !obstacle->is_small; }
    };

    const FluidGrid& grid_;
    const FluidObstacles& obstacles_;
    const FluidCollisionSettings settings_;
    std::vector<ObstacleProbe> fixed_;
    std::vector<Mover> moving_;  // as obstacles.moving()
    Bounds seen_;                // the probes are prepared for this box, and those of these indices meet it
    std::vector<std::size_t> near_fixed_, near_moving_;
    bool is_stopped_ = false;  // what move() returns
};

}  // namespace embody::physics::fluid
