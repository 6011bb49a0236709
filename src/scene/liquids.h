// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "physics/inter/world.h"

namespace embody::scene {

/// The world's fluids, shared: what is made of the same matter and lies near is one fluid of the physics, so that it
/// mixes. Liquids of different matter do not see each other (docs/physics/fluids.md, "Entities").
class Liquids {
public:
    /// Cells of one solver have one size: bodies of liquid whose own differ by no more than this factor share a fluid.
    static constexpr double most_ratio = 1.6;
    /// How many times as many particles one may need with the other's cells: that cubed, rounded up.
    static constexpr std::size_t most_particles_ratio = 5;

    /// `world` outlives this.
    explicit Liquids(physics::World& world) : world_(world) {}

    /// What one body of liquid is of a fluid.
    struct Share {
        physics::FluidHandle fluid;
        physics::FluidIds ids;
    };
    /// Cells that a body of this matter within these bounds has to be filled for: those of the fluid that it would
    /// join, else its own.
    [[nodiscard]] double cell_size(const physics::FluidDefinition& matter, const Bounds& bounds) const;
    /// Particles of that cell size at these places (m, world), at rest; those in solids are left out. `matter` says
    /// neither volume nor velocity.
    Result<Share> add(const physics::FluidDefinition& matter, std::span<const Vec3> places);
    /// Takes its particles out of the world.
    void remove(const Share& share);
    /// Whether no other body of liquid has a share in its fluid.
    [[nodiscard]] bool is_alone(const Share& share) const;

private:
    struct Shared {
        physics::FluidHandle fluid;
        int users = 0;
    };
    [[nodiscard]] const Shared* to_join(const physics::FluidDefinition& matter, const Bounds& bounds) const;
    [[nodiscard]] std::vector<Shared>::iterator find(physics::FluidHandle fluid);

    physics::World& world_;
    std::vector<Shared> fluids_;
};

}  // namespace embody::scene
