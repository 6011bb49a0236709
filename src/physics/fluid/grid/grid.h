// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "foundation/task_pool.h"
#include "math/bounds.h"
#include "math/vec3.h"
#include "physics/definitions/settings/fluid_cell_settings.h"
#include "physics/fluid/namespace.h"
#include "physics/fluid/particles/particle.h"

namespace embody::physics::fluid {

using Cell = std::array<int, 3>;

/// What a tile is to the particles.
enum TileMark : std::uint8_t {
    tile_active = 1,        ///< has particles that meet the grid, or is next to such a tile
    tile_on_grid = 2,       ///< the particles in it meet the grid
    tile_wet = 4,           ///< there may be liquid cells in it
    tile_around_drops = 8,  ///< has particles that do not meet the grid, or is next to such a tile
};

/// The staggered (MAC) grid of a fluid: a box of cells around its particles, of which only the tiles around particles
/// are ever touched. Cell (x, y, z) counts from the box's lowest; face `axis` of a cell is its lower one. Every array
/// has an element for each cell of the box.
class FluidGrid {
public:
    static constexpr Cell tile{8, 4, 4};  ///< cells; active tiles are those with particles and all around them
    /// Cells: maximum of the distance of obstacles that is stored.
    static constexpr int obstacle_reach = 2;

    explicit FluidGrid(double cell_size) : cell_(cell_size), per_cell_(static_cast<float>(1 / cell_size)) {}

    /// Makes the box hold the particles. Removes those that would make it too large, and returns how many.
    std::size_t cover(std::vector<FluidParticle>& particles, const FluidCellSettings& settings, TaskPool& workers);
    /// Sorts the particles by cell and lists the active tiles. `volume`: a particle's, in cells; `near`: boxes of the
    /// fluid's frame in which even drops meet the grid.
    void sort(std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
              const FluidCellSettings& settings, TaskPool& workers);
    /// Number of particles that meet the grid: they come first; those after them are drops that fly by themselves.
    [[nodiscard]] std::size_t on_grid() const { return on_grid_; }

    [[nodiscard]] double cell_size() const { return cell_; }
    [[nodiscard]] const Cell& lower() const { return lower_; }
    [[nodiscard]] const Cell& size() const { return size_; }
    [[nodiscard]] int index(const Cell& c) const { return c[0] + size_[0] * (c[1] + size_[1] * c[2]); }
    /// Step of the index along an axis.
    [[nodiscard]] int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size_[0] : size_[0] * size_[1]; }
    /// Centre of a cell in the fluid's frame, m.
    [[nodiscard]] Vec3 center(const Cell& c) const {
        return {(lower_[0] + c[0] + 0.5) * cell_, (lower_[1] + c[1] + 0.5) * cell_, (lower_[2] + c[2] + 0.5) * cell_};
    }
    /// A position of the fluid's frame in cells from the box's corner.
    [[nodiscard]] float in_cells(float position, int axis) const {
        return position * per_cell_ - static_cast<float>(lower_[axis]);
    }
    /// Of the tile that holds a cell.
    [[nodiscard]] int tile_of(const Cell& c) const {
        return c[0] / tile[0] + tiles_[0] * (c[1] / tile[1] + tiles_[1] * (c[2] / tile[2]));
    }
    [[nodiscard]] bool is_active(const Cell& c) const { return (tile_state_[tile_of(c)] & tile_active) != 0; }
    /// Lowest cells of the active tiles, ascending in z, y, x.
    [[nodiscard]] std::span<const Cell> tiles() const { return active_; }
    /// Indices into tiles() of those that hold particles, by one of eight colours: tiles of a colour are never next to
    /// each other.
    [[nodiscard]] std::span<const std::uint32_t> colored(int color) const { return colored_[color]; }
    static constexpr int colors = 8;  ///< one for each tile of a block of 2 × 2 × 2
    /// Lowest cells of tiles that were active when the particles were last sorted, and are not now.
    [[nodiscard]] std::span<const Cell> left() const { return left_; }
    /// Of tiles around drops that fly by themselves, whose static obstacles are not known yet.
    [[nodiscard]] std::span<const Cell> unknown_around_drops() const { return unknown_; }
    /// Sets a tile to the state without liquid and moving obstacles. Inactive tiles have that state.
    void clear_tile(const Cell& corner);

    /// Calls visit(index of the row's first cell, its cell) for each row of eight cells of a tile.
    template <class Visit>
    void for_rows(const Cell& corner, Visit visit) const {
        for (int z = corner[2]; z < corner[2] + tile[2]; ++z) {
            for (int y = corner[1]; y < corner[1] + tile[1]; ++y)
                visit(index({corner[0], y, z}), Cell{corner[0], y, z});
        }
    }
    /// Calls visit(index, cell) for each cell of a tile.
    template <class Visit>
    void for_cells(const Cell& corner, Visit visit) const {
        for_rows(corner, [&](int first, Cell c) {
            for (int i = 0; i < tile[0]; ++i, ++c[0]) visit(first + i, c);
        });
    }
    /// Calls work(corner) for each active tile, on all workers; `work` may write to its own tile only.
    template <class Work>
    void for_tiles(TaskPool& workers, Work work) const {
        parallel_for(workers, active_.size(), active_.size() > 16, [&](int, IndexRange range) {
            for (std::size_t i = range.first; i < range.last; ++i) work(active_[i]);
        });
    }

    // Written by the stages of FluidSolver::advance; their units and meaning: docs/physics/fluids.md.
    std::array<std::vector<float>, 3> velocity;      ///< of faces, m/s
    std::array<std::vector<float>, 3> mass;          ///< of particles at faces, in particles
    std::array<std::vector<float>, 3> open;          ///< fraction of a face's control volume outside obstacles
    std::array<std::vector<std::uint8_t>, 3> known;  ///< faces whose velocity is known
    std::vector<float> density;                      ///< particles around a centre, in volumes of the cell
    std::vector<float> surface;                      ///< signed distance to the liquid's surface, in cells, < 0 inside
    std::vector<float> obstacle;                     ///< signed distance to the nearest obstacle, in cells, within ±2
    std::vector<std::int16_t> obstacle_owner;        ///< which of the moving obstacles is nearest; -1: a static one
    std::vector<float> room;                         ///< fraction of the density's kernel outside obstacles
    std::vector<std::uint8_t> thin;                  ///< bits of ThinMark
    std::vector<std::int32_t> row;                   ///< of the pressure's system; -1: not liquid
    std::vector<float> pressure;                     ///< of the last step, Pa
    std::array<std::vector<float>, 3> shift;         ///< displacement of a face against clumping, m
    std::array<std::vector<float>, 3> convection;    ///< half of what (u·∇)u changes a face by in a part, m/s
    /// Of faces where points are immersed: flow by a difference of the pressure that ends at the surface, and by the
    /// whole one, over that of an open face. Empty where there are none: `open` and 0.
    std::array<std::vector<float>, 3> liquid_conductance, solid_conductance;
    /// Where the liquids are several, else empty: by liquid, its particles around a centre, in volumes of the cell; all
    /// particles at faces, by number; and of faces, the first liquid's density over that of the liquid there.
    std::vector<std::vector<float>> liquid_volume;
    std::array<std::vector<float>, 3> face_volume, mobility;
    /// Density of the liquid at a face over the first liquid's.
    [[nodiscard]] double relative_density(int axis, int cell) const {
        return mobility[axis].empty() ? 1 : 1 / static_cast<double>(mobility[axis][cell]);
    }
    /// Acceleration of the liquid at a face by a difference of the pressure, over that of the first liquid.
    [[nodiscard]] float mobility_at(int axis, int cell) const {
        return mobility[axis].empty() ? 1 : mobility[axis][cell];
    }
    std::vector<int> immersed_cells;  ///< that immersed points fill a part of, ascending

    // Of static obstacles alone, kept from step to step.
    std::array<std::vector<float>, 3> static_fraction;
    std::vector<float> static_distance, static_room;
    std::vector<std::uint8_t> static_thin;
    std::vector<std::uint8_t> is_static_known;  ///< by tile

    std::vector<std::uint32_t> first_particle, particle_count;  ///< by cell; sorted particles

private:
    void resize(const Cell& lower, const Cell& upper);
    void mark_tiles(const std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
                    const FluidCellSettings& settings);
    void mark_wet_tiles(const std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
                        const FluidCellSettings& settings);
    void list_tiles();
    template <class Visit>
    void for_tiles_around(int place, Visit visit) const;

    double cell_;
    float per_cell_;
    Cell lower_{}, size_{}, tiles_{};
    std::vector<std::uint8_t> tile_state_;   // bits of TileMark
    std::vector<std::uint32_t> tile_count_;  // particles in it
    std::vector<int> wet_cells_;             // in it, of those cells that few particles fill
    std::vector<Cell> active_, left_, unknown_;
    std::array<std::vector<std::uint32_t>, colors> colored_;
    std::vector<std::uint32_t> cell_of_, tile_of_particle_;  // of each particle; then the place it is sorted to
    std::vector<FluidParticle> sorted_;
    std::size_t on_grid_ = 0;
};

/// What FluidGrid::thin says of a cell.
enum ThinMark : std::uint8_t {
    closed_x = 1,  ///< its lower x face is shut by something thinner than the cell
    closed_y = 2,
    closed_z = 4,
    near_thin = 8,  ///< such a wall is within a cell: particles ask the true shapes
    between = 16,   ///< two obstacles are at one of its faces
};

}  // namespace embody::physics::fluid
