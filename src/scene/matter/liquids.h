// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
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
        std::vector<std::uint32_t> places;  ///< see particles_of
        Vec3 force;                         ///< constant, N, shared among its particles; push() applies it
    };
    /// Cells that a body of this matter within these bounds has to be filled for: those of the fluid that it would
    /// join, else its own.
    [[nodiscard]] double cell_size(const physics::FluidDefinition& matter, const Bounds& bounds);
    /// Particles of that cell size at these places (m, world), at rest; those in solids are left out. `matter` says
    /// neither volume nor velocity. The share is there until it is removed.
    Result<Share*> add(const physics::FluidDefinition& matter, std::span<const Vec3> places);
    /// Takes its particles out of the world.
    void remove(Share* share);
    /// Where its particles are in the world's fluid_particles(share.fluid), in the order of their ids. Valid until the
    /// world or a share changes.
    const std::vector<std::uint32_t>& particles_of(const Share& share);
    /// Other matter of cells as large.
    Result<void> set_matter(Share& share, const physics::FluidDefinition& matter);
    /// After its particles were put elsewhere: it leaves a fluid that it is too far away from, or joins another one.
    Result<void> regroup(Share& share);
    /// Before a step of `dt` seconds: the shares' own forces.
    void push(double dt);
    /// After a step: shares that have run far apart no longer share a fluid, whose grid would have to span them all.
    void part_far_ones();

private:
    struct Shared {
        physics::FluidHandle fluid;
        std::vector<std::unique_ptr<Share>> shares;  // by ids
        std::uint64_t version = 0;                   // of the particles that `places` are of
    };
    [[nodiscard]] Shared* to_join(const physics::FluidDefinition& matter, const Bounds& bounds, double most_ratio,
                                  physics::FluidHandle except = {});
    [[nodiscard]] std::vector<Shared>::iterator find(physics::FluidHandle fluid);
    void locate(Shared& shared);
    [[nodiscard]] Bounds bounds_of(const Share& share);
    Result<void> hand_over(Share& share, physics::FluidHandle to);
    std::unique_ptr<Share> take(Share& share);
    void put(std::unique_ptr<Share> share);

    physics::World& world_;
    std::vector<Shared> fluids_;
};

}  // namespace embody::scene
