// SPDX-License-Identifier: MIT
// Which tiles of a fluid's grid are worked on (docs/physics/fluids.md, "Drops").
#include <algorithm>
#include <cmath>

#include "physics/fluid/grid/grid.h"

namespace embody::physics::fluid {

namespace {

/// The eight centres around a place and their trilinear weights.
struct Centers {
    std::array<int, 8> cells;
    std::array<float, 8> weights;

    Centers(const FluidGrid& grid, const float* position) {
        Cell low{};
        float upper[3];
        for (int axis = 0; axis < 3; ++axis) {
            const float at = grid.in_cells(position[axis], axis) - 0.5f;
            low[axis] = static_cast<int>(at);
            upper[axis] = at - static_cast<float>(low[axis]);
        }
        for (std::size_t k = 0; k < cells.size(); ++k) {
            cells[k] = grid.index(low);
            weights[k] = 1;
            for (int axis = 0; axis < 3; ++axis) {
                const bool is_upper = k >> axis & 1;
                if (is_upper) cells[k] += grid.stride(axis);
                weights[k] *= is_upper ? upper[axis] : 1 - upper[axis];
            }
        }
    }
};

}  // namespace

// Neighbours of a tile that is not at the box's rim; no tile with particles or next to one with particles is.
template <class Visit>
void FluidGrid::for_tiles_around(int place, Visit visit) const {
    for (int k = 0; k < 27; ++k) {
        visit(place + k % 3 - 1 + tiles_[0] * (k / 3 % 3 - 1 + tiles_[1] * (k / 9 - 1)));
    }
}

// Tiles where liquid may be: with many particles, next to moving obstacles, where nothing is known of the static ones,
// and around each cell that the particles of the other tiles fill far enough.
void FluidGrid::mark_wet_tiles(const std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
                               const FluidCellSettings& settings) {
    const std::uint32_t full_tile = settings.full_tile_particles;
    for (std::size_t t = 0; t < tile_state_.size(); ++t) {
        if (tile_count_[t] > 0 && (tile_count_[t] >= full_tile || !is_static_known[t])) tile_state_[t] |= tile_wet;
    }
    for (const Bounds& box : near) {
        Cell low{}, high{};
        for (int axis = 0; axis < 3; ++axis) {
            const auto in_tiles = [&](double place) {
                const double at = std::floor((place / cell_ - lower_[axis]) / tile[axis]);
                return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(tiles_[axis])));
            };
            low[axis] = std::max(in_tiles(box.lower[axis]), 0);
            high[axis] = std::min(in_tiles(box.upper[axis]), tiles_[axis] - 1);
        }
        for (int z = low[2]; z <= high[2]; ++z) {
            for (int y = low[1]; y <= high[1]; ++y) {
                for (int x = low[0]; x <= high[0]; ++x) {
                    const int t = x + tiles_[0] * (y + tiles_[1] * z);
                    if (tile_count_[t] > 0) tile_state_[t] |= tile_wet;
                }
            }
        }
    }
    std::vector<Centers> sparse;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        if ((tile_state_[tile_of_particle_[i]] & tile_wet) == 0) sparse.emplace_back(*this, particles[i].position);
    }
    for (const Centers& centers : sparse) {
        for (const int cell : centers.cells) density[cell] = 0;
    }
    for (const Centers& centers : sparse) {
        for (std::size_t k = 0; k < 8; ++k) density[centers.cells[k]] += volume * centers.weights[k];
    }
    // A cell or two of liquid in a tile are a few drops beside each other, as long as they are not full.
    const float min_room = settings.min_room, wet = settings.wet_fraction, full = settings.full_fraction;
    const int across = size_[0], layer = size_[0] * size_[1];
    for (const Centers& centers : sparse) {
        for (const int cell : centers.cells) {
            const float most = static_room[cell], filled = density[cell];
            density[cell] = 0;  // counted once
            if (most < min_room || filled < wet * most) continue;
            const int t = tile_of({cell % across, cell % layer / across, cell / layer});
            if (++wet_cells_[t] > settings.max_drop_cells || filled > full * most) tile_state_[t] |= tile_wet;
        }
    }
}

void FluidGrid::mark_tiles(const std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
                           const FluidCellSettings& settings) {
    std::fill(tile_state_.begin(), tile_state_.end(), 0);
    std::fill(tile_count_.begin(), tile_count_.end(), 0);
    std::fill(wet_cells_.begin(), wet_cells_.end(), 0);
    for (const std::uint32_t t : tile_of_particle_) ++tile_count_[t];
    mark_wet_tiles(particles, volume, near, settings);
    const auto number = static_cast<int>(tile_state_.size());
    for (int t = 0; t < number; ++t) {
        if ((tile_state_[t] & tile_wet) == 0) continue;
        for_tiles_around(t, [&](int other) {
            if (tile_count_[other] > 0) tile_state_[other] |= tile_on_grid;
        });
    }
    for (int t = 0; t < number; ++t) {
        if (tile_count_[t] == 0) continue;
        const bool is_on_grid = (tile_state_[t] & tile_on_grid) != 0;
        const std::uint8_t mark = is_on_grid ? tile_active : tile_around_drops;
        for_tiles_around(t, [&](int other) { tile_state_[other] |= mark; });
    }
    list_tiles();
}

void FluidGrid::list_tiles() {
    left_.clear();
    for (const Cell& corner : active_) {
        if (!is_active(corner)) left_.push_back(corner);
    }
    active_.clear();
    unknown_.clear();
    for (auto& list : colored_) list.clear();
    for (int z = 0, i = 0; z < tiles_[2]; ++z) {
        for (int y = 0; y < tiles_[1]; ++y) {
            for (int x = 0; x < tiles_[0]; ++x, ++i) {
                const int state = tile_state_[i];
                if (state == 0) continue;
                const Cell corner{x * tile[0], y * tile[1], z * tile[2]};
                if ((state & tile_active) == 0) {
                    if (!is_static_known[i]) unknown_.push_back(corner);
                    continue;
                }
                const auto place = static_cast<std::uint32_t>(active_.size());
                active_.push_back(corner);
                if ((state & tile_on_grid) != 0) colored_[(x & 1) | (y & 1) << 1 | (z & 1) << 2].push_back(place);
            }
        }
    }
}

void FluidGrid::clear_tile(const Cell& corner) {
    for_rows(corner, [&](int first, const Cell&) {
        for (int cell = first; cell < first + tile[0]; ++cell) {
            obstacle[cell] = static_distance[cell];
            room[cell] = static_room[cell];
            thin[cell] = static_thin[cell];
            obstacle_owner[cell] = -1;
            row[cell] = -1;
            surface[cell] = 1;
            density[cell] = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                velocity[axis][cell] = mass[axis][cell] = shift[axis][cell] = convection[axis][cell] = 0;
                known[axis][cell] = 0;
            }
        }
    });
}

}  // namespace embody::physics::fluid
