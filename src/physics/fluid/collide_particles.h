// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "physics/fluid/grid.h"
#include "physics/fluid/solids.h"

namespace embody::physics {

/// Keeps particles out of solids: by the grid's distances, and near walls thinner than a cell by the true shapes. One a
/// worker.
class ParticleCollider {
public:
    ParticleCollider(const FluidGrid& grid, const FluidSolids& solids, double dt);
    /// Where a particle meets the grid: its place, but on its own side of thin walls only.
    std::array<float, 3> place_of(const FluidParticle& particle);
    /// Moves the particle towards `end`, a place of the fluid's frame, as far as solids let it.
    void move(FluidParticle& particle, const float* end);

private:
    /// A wall that was met: its normal and velocity.
    struct Wall {
        Vec3 normal, velocity;
    };
    void stride(FluidParticle& particle, const float* to);
    void push_out(FluidParticle& particle, Vec3 before) const;
    [[nodiscard]] bool sees(Vec3 from, Vec3 to);
    void sweep(FluidParticle& particle, Vec3 from, Vec3 to);
    bool bar(SolidProbe& probe, Vec3 from, Vec3& to, Vec3& normal) const;
    void stop_at(FluidParticle& particle, const Wall& wall) const;
    [[nodiscard]] bool is_near_thin(const float* position) const;

    const FluidGrid& grid_;
    const FluidSolids& solids_;
    double dt_;
    std::vector<SolidProbe> fixed_, moving_;
};

}  // namespace embody::physics
