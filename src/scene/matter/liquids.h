// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "physics/inter/world.h"

namespace embody::scene {

/// Bodies of liquid in the world's fluids: bodies close to each other are in one fluid of the physics, so that those of
/// the same matter mix and others lie in layers (docs/physics/fluids.md, "Entities").
class Liquids {
public:
    /// A solver has one cell size: bodies of liquid use one fluid if their own cell sizes differ by no more than this
    /// factor, or are of different matter and lie above each other.
    static constexpr double max_ratio = 1.6;

    /// `world` outlives this.
    explicit Liquids(physics::World& world) : world_(world) {}

    /// The particles of one body of liquid in a fluid.
    struct Part {
        physics::FluidHandle fluid;
        physics::FluidIds ids;
        Bounds start;                       ///< where it began, m, world; it is taken to be there while it is empty
        physics::FluidIds room;             ///< the last of its ids: kept for what taps will add
        std::uint32_t used_room = 0;        ///< so many of these are used
        std::uint64_t poured = 0;           ///< particles that have been added while it ran
        std::vector<std::uint32_t> places;  ///< indices, see particles_of
        physics::LiquidMatter matter;
        double set_cell_size = 0;  ///< m, told by hand; 0: none. The fluid's may be larger
        Vec3 force;                ///< constant, N, distributed over its particles; push() applies it
    };
    /// Cell size for filling a body of this matter within these bounds: that of the fluid that it would join, else its
    /// own. It joins one of about its own cells, or one of whose bodies was told about the same by hand.
    [[nodiscard]] double cell_size(const physics::FluidDefinition& matter, double set_cell_size, const Bounds& bounds);
    /// Adds particles of that cell size at these places (m, world), at rest; places in solids are left out. `matter`
    /// has neither volume nor velocity. The part is valid until remove().
    Result<Part*> add(const physics::FluidDefinition& matter, std::span<const Vec3> places);
    /// A part without particles, which are to come within these bounds (m, world).
    Result<Part*> add_empty(const physics::FluidDefinition& matter, const Bounds& bounds);
    /// Adds particles that have run exactly there, also where solids are by now: these push them out.
    Result<Part*> add_drops(const physics::FluidDefinition& matter, std::span<const physics::FluidDrop> drops);
    /// Removes its particles from the world.
    void remove(Part* part);
    /// Indices of its particles in the world's fluid_particles(part.fluid), in the order of their ids. Valid until the
    /// world or a part changes.
    const std::vector<std::uint32_t>& particles_of(const Part& part);
    /// Keeps ids for so many particles that taps add in the next step: see part.room.
    Result<void> make_room(Part& part, std::uint32_t count);
    /// Taps have added so many.
    static void count_poured(Part& part, std::uint64_t count);
    /// Removes its particles and adds these, exactly there.
    Result<void> set_drops(Part& part, std::span<const physics::FluidDrop> drops);
    /// Adds particles behind the part's own, exactly there. The error says why they cannot be one fluid with it.
    Result<void> append(Part& part, std::span<const physics::FluidDrop> drops);
    /// Changes the matter; the cell size must be the same.
    Result<void> set_matter(Part& part, const physics::FluidDefinition& matter);
    /// Call after its particles were moved: it leaves a fluid that is too far away, or joins another one.
    Result<void> regroup(Part& part);
    /// Before a step of `dt` seconds: applies the parts' own forces.
    void push(double dt);
    /// After a step: separates parts that have moved far apart, since the grid of one fluid would have to span them
    /// all.
    void separate_distant();

private:
    struct SharedFluid {
        physics::FluidHandle fluid;
        std::vector<std::unique_ptr<Part>> parts;  // by ids
        std::uint64_t version = 0;                 // of the particles at the time of `places`
    };
    /// What a body of liquid asks of a fluid to be a part of it.
    struct Wish {
        const physics::FluidDefinition& matter;
        const Bounds& bounds;
        double ratio_limit = 1;    // of cell sizes
        double set_cell_size = 0;  // m, told by hand; 0: none
        physics::FluidHandle except;
    };
    [[nodiscard]] SharedFluid* to_join(const Wish& wish);
    /// Of its particles, and of where its empty parts are to be.
    [[nodiscard]] Bounds bounds_of(SharedFluid& shared);
    [[nodiscard]] std::vector<SharedFluid>::iterator find(physics::FluidHandle fluid);
    void locate(SharedFluid& shared);
    [[nodiscard]] Bounds bounds_of(const Part& part);
    Result<void> hand_over(Part& part, physics::FluidHandle to);
    std::unique_ptr<Part> take(Part& part);
    void put(std::unique_ptr<Part> part);
    void set_newest_ids(Part& part, physics::FluidIds ids);

    physics::World& world_;
    std::vector<SharedFluid> fluids_;
};

}  // namespace embody::scene
