// SPDX-License-Identifier: MIT
#include "physics/fluid/grid.h"

#include <algorithm>
#include <cmath>

namespace embody::physics {

namespace {

/// Cells from lower to upper, both included.
struct CellRange {
    Cell lower{}, upper{};

    [[nodiscard]] std::size_t count() const {
        std::size_t cells = 1;
        for (int axis = 0; axis < 3; ++axis) cells *= static_cast<std::size_t>(upper[axis] - lower[axis] + 1);
        return cells;
    }
};

int floor_to(int value, int unit) { return (value >= 0 ? value / unit : -((-value + unit - 1) / unit)) * unit; }

int cell_of(float position, double cell) { return static_cast<int>(std::floor(position / cell)); }

CellRange range_of(const std::vector<FluidParticle>& particles, double cell) {
    std::array<float, 3> low, high;
    low.fill(INFINITY);
    high.fill(-INFINITY);
    for (const FluidParticle& particle : particles) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], particle.position[axis]);
            high[axis] = std::max(high[axis], particle.position[axis]);
        }
    }
    CellRange range;
    for (int axis = 0; axis < 3; ++axis) {
        range.lower[axis] = cell_of(low[axis], cell);
        range.upper[axis] = cell_of(high[axis], cell);
    }
    return range;
}

// Cuts a tenth off the longest side, at the end with fewer particles, and removes those.
void trim(std::vector<FluidParticle>& particles, const CellRange& range, double cell) {
    int axis = 0;
    for (int other = 1; other < 3; ++other) {
        if (range.upper[other] - range.lower[other] > range.upper[axis] - range.lower[axis]) axis = other;
    }
    const int cut = std::max(1, (range.upper[axis] - range.lower[axis] + 1) / 10);
    const int low = range.lower[axis] + cut, high = range.upper[axis] - cut;
    std::size_t below = 0, above = 0;
    for (const FluidParticle& particle : particles) {
        const int c = cell_of(particle.position[axis], cell);
        below += c < low;
        above += c > high;
    }
    const bool from_below = below < above || (below == above && axis == 1);
    std::erase_if(particles, [&](const FluidParticle& particle) {
        const int c = cell_of(particle.position[axis], cell);
        return from_below ? c < low : c > high;
    });
}

}  // namespace

std::size_t FluidGrid::cover(std::vector<FluidParticle>& particles) {
    // Coordinates beyond these cannot be counted in cells.
    constexpr float farthest = 1e8f;
    const std::size_t before = particles.size();
    std::erase_if(particles, [&](const FluidParticle& p) {
        const auto is_far = [&](float x) { return !(std::fabs(x) * per_cell_ < farthest); };
        return is_far(p.position[0]) || is_far(p.position[1]) || is_far(p.position[2]);
    });
    if (particles.empty()) return before;
    CellRange range = range_of(particles, cell_);
    while (range.count() > std::max(fewest_cells, cells_by_particle * particles.size())) {
        trim(particles, range, cell_);
        range = range_of(particles, cell_);
    }

    // Two tiles more than there are particles: one that is active and one that stencils may reach.
    bool fits = size_[0] > 0;
    Cell low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = floor_to(range.lower[axis], tile[axis]) - 2 * tile[axis];
        high[axis] = floor_to(range.upper[axis], tile[axis]) + 3 * tile[axis];
        fits = fits && low[axis] >= lower_[axis] && high[axis] <= lower_[axis] + size_[axis];
    }
    if (!fits) {
        // A quarter more where it grows: it will go on.
        for (int axis = 0; axis < 3; ++axis) {
            const int more = floor_to((high[axis] - low[axis]) / 4, tile[axis]);
            if (size_[0] > 0 && low[axis] < lower_[axis]) low[axis] -= more;
            if (size_[0] > 0 && high[axis] > lower_[axis] + size_[axis]) high[axis] += more;
        }
        resize(low, high);
    }
    return before - particles.size();
}

void FluidGrid::resize(const Cell& lower, const Cell& upper) {
    const Cell old_lower = lower_, old_size = size_;
    const std::vector<float> old_pressure = std::move(pressure);
    lower_ = lower;
    std::size_t cells = 1, tiles = 1;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = upper[axis] - lower[axis];
        tiles_[axis] = size_[axis] / tile[axis];
        cells *= static_cast<std::size_t>(size_[axis]);
        tiles *= static_cast<std::size_t>(tiles_[axis]);
    }
    for (auto* arrays : {&velocity, &mass, &open, &shift, &static_share}) {
        for (auto& array : *arrays) array.assign(cells, 0);
    }
    for (auto& array : known) array.assign(cells, 0);
    for (auto* array : {&density, &surface, &solid, &room, &pressure, &static_distance, &static_room}) {
        array->assign(cells, 0);
    }
    solid_owner.assign(cells, -1);
    thin.assign(cells, 0);
    static_thin.assign(cells, 0);
    row.assign(cells, -1);
    first_particle.assign(cells, 0);
    particle_count.assign(cells, 0);
    tile_state_.assign(tiles, 0);
    is_static_known.assign(tiles, 0);
    active_.clear();

    // The last pressure is the next solve's guess.
    for (int z = 0; z < old_size[2]; ++z) {
        for (int y = 0; y < old_size[1]; ++y) {
            const Cell from{old_lower[0] - lower_[0], y + old_lower[1] - lower_[1], z + old_lower[2] - lower_[2]};
            if (from[1] < 0 || from[1] >= size_[1] || from[2] < 0 || from[2] >= size_[2]) continue;
            for (int x = std::max(0, -from[0]); x < std::min(old_size[0], size_[0] - from[0]); ++x) {
                pressure[index({x + from[0], from[1], from[2]})] =
                    old_pressure[x + old_size[0] * (y + old_size[1] * z)];
            }
        }
    }
}

void FluidGrid::list_tiles() {
    active_.clear();
    for (auto& list : colored_) list.clear();
    for (int z = 0, i = 0; z < tiles_[2]; ++z) {
        for (int y = 0; y < tiles_[1]; ++y) {
            for (int x = 0; x < tiles_[0]; ++x, ++i) {
                if (tile_state_[i] == 0) continue;
                const auto place = static_cast<std::uint32_t>(active_.size());
                active_.push_back({x * tile[0], y * tile[1], z * tile[2]});
                if (tile_state_[i] != 2) continue;
                colored_[(x & 1) | (y & 1) << 1 | (z & 1) << 2].push_back(place);
            }
        }
    }
}

void FluidGrid::sort(std::vector<FluidParticle>& particles, TaskPool& workers) {
    // Which cell each is in, and which tiles that makes active.
    cell_of_.resize(particles.size());
    share_among(workers, particles.size(), particles.size() > 4000, [&](int, Share share) {
        for (std::size_t i = share.first; i < share.last; ++i) {
            const float* p = particles[i].position;
            cell_of_[i] = static_cast<std::uint32_t>(
                index({static_cast<int>(in_cells(p[0], 0)), static_cast<int>(in_cells(p[1], 1)),
                       static_cast<int>(in_cells(p[2], 2))}));
        }
    });
    std::fill(tile_state_.begin(), tile_state_.end(), 0);
    for (const std::uint32_t cell : cell_of_) {
        const int c = static_cast<int>(cell);
        const int x = c % size_[0], y = c / size_[0] % size_[1], z = c / size_[0] / size_[1];
        tile_state_[tile_of({x, y, z})] = 2;
    }
    for (int z = 1; z + 1 < tiles_[2]; ++z) {
        for (int y = 1; y + 1 < tiles_[1]; ++y) {
            for (int x = 1; x + 1 < tiles_[0]; ++x) {
                if (tile_state_[x + tiles_[0] * (y + tiles_[1] * z)] != 2) continue;
                for (int k = 0; k < 27; ++k) {
                    std::uint8_t& state =
                        tile_state_[x + k % 3 - 1 + tiles_[0] * (y + k / 3 % 3 - 1 + tiles_[1] * (z + k / 9 - 1))];
                    state = std::max<std::uint8_t>(state, 1);
                }
            }
        }
    }
    list_tiles();

    // Counting sort, stable, tile by tile.
    for (const Cell& corner : active_) {
        for_rows(corner, [&](int first, const Cell&) { std::fill_n(particle_count.begin() + first, tile[0], 0u); });
    }
    for (const std::uint32_t cell : cell_of_) ++particle_count[cell];
    std::uint32_t next = 0;
    for (const Cell& corner : active_) {
        for_cells(corner, [&](int cell, const Cell&) {
            first_particle[cell] = next;
            next += particle_count[cell];
        });
    }
    sorted_.resize(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i) sorted_[first_particle[cell_of_[i]]++] = particles[i];
    for (const Cell& corner : active_) {
        for_cells(corner, [&](int cell, const Cell&) { first_particle[cell] -= particle_count[cell]; });
    }
    particles.swap(sorted_);
}

}  // namespace embody::physics
