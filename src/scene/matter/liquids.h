// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/inter/world.h"

namespace embody::scene {

/// Bodies of liquid in the world's fluids: bodies of the same matter close to each other are in one fluid of the
/// physics, so that they mix. Liquids of different matter do not interact (docs/physics/fluids.md, "Entities").
class Liquids {
public:
    /// A solver has one cell size: bodies of liquid use one fluid if their own cell sizes differ by no more than this
    /// factor.
    static constexpr double most_ratio = 1.6;
    /// Maximum factor on the number of particles of a body with the other's cells: the ratio cubed, rounded up.
    static constexpr std::size_t most_particles_ratio = 5;

    /// `world` outlives this.
    explicit Liquids(physics::World& world) : world_(world) {}

    /// The particles of one body of liquid in a fluid.
    struct Share {
        physics::FluidHandle fluid;
        physics::FluidIds ids;
        std::vector<std::uint32_t> places;  ///< indices, see particles_of
        Vec3 force;                         ///< constant, N, distributed over its particles; push() applies it
    };
    /// Cell size for filling a body of this matter within these bounds: that of the fluid that it would join, else its
    /// own.
    [[nodiscard]] double cell_size(const physics::FluidDefinition& matter, const Bounds& bounds);
    /// Adds particles of that cell size at these places (m, world), at rest; places in solids are left out. `matter`
    /// has neither volume nor velocity. The share is valid until remove().
    Result<Share*> add(const physics::FluidDefinition& matter, std::span<const Vec3> places);
    /// Removes its particles from the world.
    void remove(Share* share);
    /// Indices of its particles in the world's fluid_particles(share.fluid), in the order of their ids. Valid until the
    /// world or a share changes.
    const std::vector<std::uint32_t>& particles_of(const Share& share);
    /// Changes the matter; the cell size must be the same.
    Result<void> set_matter(Share& share, const physics::FluidDefinition& matter);
    /// Call after its particles were moved: it leaves a fluid that is too far away, or joins another one.
    Result<void> regroup(Share& share);
    /// Before a step of `dt` seconds: applies the shares' own forces.
    void push(double dt);
    /// After a step: separates shares that have moved far apart, since the grid of one fluid would have to span them
    /// all.
    void part_far_ones();

private:
    struct Shared {
        physics::FluidHandle fluid;
        std::vector<std::unique_ptr<Share>> shares;  // by ids
        std::uint64_t version = 0;                   // of the particles at the time of `places`
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
