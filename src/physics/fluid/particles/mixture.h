// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "physics/definitions/fluid_definition.h"
#include "physics/fluid/grid/grid.h"
#include "physics/fluid/namespace.h"

namespace embody::physics::fluid {

struct FluidProperties {
    double density = 998;        ///< kg/m³
    double viscosity = 0.001;    ///< Pa s
    double yield_stress = 0;     ///< Pa
    double particle_volume = 0;  ///< m³
    double surface_tension = 0;  ///< N/m

    bool operator==(const FluidProperties&) const = default;
};

/// The liquids of a fluid, and which particles are of which. The density of the first one is the unit of the grid's
/// masses. docs/physics/fluids.md, "Several liquids".
class Mixture {
public:
    Mixture(const FluidProperties& first) : liquids_{first} {}

    [[nodiscard]] const FluidProperties& first() const { return liquids_[0]; }
    [[nodiscard]] const std::vector<FluidProperties>& liquids() const { return liquids_; }
    [[nodiscard]] bool is_one() const { return liquids_.size() == 1; }
    [[nodiscard]] const FluidProperties& of(std::uint32_t id) const { return liquids_[liquid_of(id)]; }

    /// The particles with these ids are of this liquid from now on; their volume stays.
    void assign(FluidIds ids, FluidProperties liquid);
    /// Forgets liquids that have none of the particles.
    void keep_liquids_of(const std::vector<FluidParticle>& particles);
    /// The runs of these ids that are of one liquid each, ascending.
    struct Run {
        FluidIds ids;
        std::size_t liquid = 0;
    };
    [[nodiscard]] std::vector<Run> runs(FluidIds ids) const;

    /// Finds the liquid of each particle, in their present order. Where there is one liquid, nothing is stored.
    void identify(const std::vector<FluidParticle>& particles, TaskPool& workers);
    /// After identify(): by the particle's index; empty for one liquid.
    [[nodiscard]] std::span<const std::uint16_t> liquid_of_particles() const { return of_particle_; }
    [[nodiscard]] const FluidProperties& at(std::size_t particle) const {
        return liquids_[is_one() ? 0 : of_particle_[particle]];
    }
    /// Mass of a particle over that of one of the first liquid.
    [[nodiscard]] double relative_mass(std::size_t particle) const {
        return is_one() ? 1 : at(particle).density / first().density;
    }

    /// Mean density, kg/m³, and viscosity, Pa s, of the liquids in the cell of a place of the fluid's frame.
    struct Around {
        double density, viscosity;
    };
    [[nodiscard]] Around around(const FluidGrid& grid, const float* place) const;
    /// Mean over the liquids around a cell's centre by their volumes; the first liquid's value where there is none.
    template <class Value>
    [[nodiscard]] double mean(const FluidGrid& grid, int cell, Value value) const {
        return mean_of_two(grid, cell, cell, value);
    }
    /// Likewise around both cells at a face.
    template <class Value>
    [[nodiscard]] double mean_at_face(const FluidGrid& grid, int axis, int cell, Value value) const {
        return mean_of_two(grid, cell, cell - grid.stride(axis), value);
    }

    /// Whether heavier liquid lies above lighter one: where the density rises upwards it does by more than a twentieth
    /// of what it falls where it falls (fewer are drops that settle).
    [[nodiscard]] bool is_top_heavy(const FluidGrid& grid, Vec3 gravity) const;

private:
    [[nodiscard]] std::uint16_t liquid_of(std::uint32_t id) const;
    template <class Value>
    [[nodiscard]] double mean_of_two(const FluidGrid& grid, int a, int b, Value value) const {
        if (is_one()) return value(first());
        double sum = 0, volume = 0;
        for (std::size_t liquid = 0; liquid < liquids_.size(); ++liquid) {
            const double part = static_cast<double>(grid.liquid_volume[liquid][a]) + grid.liquid_volume[liquid][b];
            sum += part * value(liquids_[liquid]);
            volume += part;
        }
        return volume > 0 ? sum / volume : value(first());
    }

    std::vector<FluidProperties> liquids_;
    std::map<std::uint32_t, std::uint16_t> first_ids_{{0, 0}};  // of each run of ids, with its liquid
    std::vector<std::uint16_t> of_particle_;
};

}  // namespace embody::physics::fluid
