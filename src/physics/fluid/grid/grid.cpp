// SPDX-License-Identifier: MIT
#include "physics/fluid/grid/grid.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::fluid {

namespace {

/// Cells from lower to upper, both included.
struct CellRange {
    Cell lower{}, upper{};

    // Size of a box around it with the tiles that it needs beside it.
    [[nodiscard]] double cells_of_box() const {
        double cells = 1;
        for (int axis = 0; axis < 3; ++axis) cells *= upper[axis] - lower[axis] + 5.0 * FluidGrid::tile[axis];
        return cells;
    }
};

int floor_to(int value, int unit) { return (value >= 0 ? value / unit : -((-value + unit - 1) / unit)) * unit; }

int cell_of(float position, double cell) { return static_cast<int>(std::floor(position / cell)); }

CellRange range_of(const ParticleReach& reach, double cell) {
    CellRange range;
    for (int axis = 0; axis < 3; ++axis) {
        range.lower[axis] = cell_of(reach.lower[axis], cell);
        range.upper[axis] = cell_of(reach.upper[axis], cell);
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

/// A box of cells, or of tiles.
struct Box {
    Cell lower, size;
};

// Converts an array with an element for each cell of one box to another box; new cells get `none`.
template <class T>
void carry_over(std::vector<T>& array, const Box& from, const Box& to, T none = {}) {
    std::vector<T> old(static_cast<std::size_t>(to.size[0]) * static_cast<std::size_t>(to.size[1]) *
                           static_cast<std::size_t>(to.size[2]),
                       none);
    old.swap(array);
    if (from.size[0] == 0) return;
    const Cell shift{from.lower[0] - to.lower[0], from.lower[1] - to.lower[1], from.lower[2] - to.lower[2]};
    const int first = std::max(0, -shift[0]), last = std::min(from.size[0], to.size[0] - shift[0]);
    for (int z = std::max(0, -shift[2]); z < std::min(from.size[2], to.size[2] - shift[2]); ++z) {
        for (int y = std::max(0, -shift[1]); y < std::min(from.size[1], to.size[1] - shift[1]); ++y) {
            const int source = from.size[0] * (y + from.size[1] * z);
            const int target = shift[0] + to.size[0] * (y + shift[1] + to.size[1] * (z + shift[2]));
            for (int x = first; x < last; ++x) array[target + x] = old[source + x];
        }
    }
}

}  // namespace

std::size_t FluidGrid::cover(std::vector<FluidParticle>& particles, const FluidCellSettings& settings,
                             TaskPool& workers) {
    // Coordinates beyond these, in cells, are too large to be counted by an int.
    constexpr float max_coordinate = 1e8f;
    const std::size_t before = particles.size();
    ParticleReach reach = reach_of(particles, workers);
    if (!(reach.farthest() * per_cell_ < max_coordinate)) {
        std::erase_if(particles, [&](const FluidParticle& p) {
            const auto is_far = [&](float x) { return !(std::fabs(x) * per_cell_ < max_coordinate); };
            return is_far(p.position[0]) || is_far(p.position[1]) || is_far(p.position[2]);
        });
        reach = reach_of(particles, workers);
    }
    if (particles.empty()) return before;
    CellRange range = range_of(reach, cell_);
    const auto allowed_cells = [&] {
        return std::max(settings.min_box_cells, settings.box_cells_per_particle * particles.size());
    };
    while (range.cells_of_box() > static_cast<double>(allowed_cells())) {
        trim(particles, range, cell_);
        range = range_of(reach_of(particles, workers), cell_);
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
        // A quarter more where it grows: it will grow further.
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
    lower_ = lower;
    std::size_t cells = 1, tiles = 1;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = upper[axis] - lower[axis];
        tiles_[axis] = size_[axis] / tile[axis];
        cells *= static_cast<std::size_t>(size_[axis]);
        tiles *= static_cast<std::size_t>(tiles_[axis]);
    }
    for (auto* arrays : {&velocity, &mass, &open, &shift, &convection}) {
        for (auto& array : *arrays) array.assign(cells, 0);
    }
    for (auto& array : known) array.assign(cells, 0);
    for (auto* array : {&density, &surface}) array->assign(cells, 0);
    obstacle_owner.assign(cells, -1);
    row.assign(cells, -1);
    first_particle.assign(cells, 0);
    particle_count.assign(cells, 0);
    tile_state_.assign(tiles, 0);
    tile_count_.assign(tiles, 0);
    wet_cells_.assign(tiles, 0);
    active_.clear();

    // The last pressure is the next solve's guess; static obstacles stay where they were.
    const auto box_of = [](const Cell& low, const Cell& whole, const Cell& unit) {
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lower[axis] = low[axis] / unit[axis];
            box.size[axis] = whole[axis] / unit[axis];
        }
        return box;
    };
    const Cell one{1, 1, 1};
    const Box from = box_of(old_lower, old_size, one), to = box_of(lower_, size_, one);
    carry_over(pressure, from, to);
    carry_over(static_distance, from, to, static_cast<float>(obstacle_reach));
    carry_over(static_room, from, to, 1.0f);
    for (auto& array : static_fraction) carry_over(array, from, to);
    carry_over(static_thin, from, to);
    carry_over(is_static_known, box_of(old_lower, old_size, tile), box_of(lower_, size_, tile));
    obstacle = static_distance;
    room = static_room;
    thin = static_thin;
}

void FluidGrid::sort(std::vector<FluidParticle>& particles, float volume, std::span<const Bounds> near,
                     const FluidCellSettings& settings, TaskPool& workers) {
    // The cell of each particle, and which tiles become active by it.
    const std::size_t count = particles.size();
    cell_of_.resize(count);
    tile_of_particle_.resize(count);
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            const float* p = particles[i].position;
            const Cell c{static_cast<int>(in_cells(p[0], 0)), static_cast<int>(in_cells(p[1], 1)),
                         static_cast<int>(in_cells(p[2], 2))};
            cell_of_[i] = static_cast<std::uint32_t>(index(c));
            tile_of_particle_[i] = static_cast<std::uint32_t>(tile_of(c));
        }
    });
    mark_tiles(particles, volume, near, settings);

    // Counting sort, stable, tile by tile, drops after all others. Places first: moving the particles takes longest and
    // can run on all workers.
    for (const Cell& corner : active_) {
        for_rows(corner, [&](int first, const Cell&) { std::fill_n(particle_count.begin() + first, tile[0], 0u); });
    }
    const auto is_on_grid = [&](std::size_t i) { return (tile_state_[tile_of_particle_[i]] & tile_on_grid) != 0; };
    for (std::size_t i = 0; i < count; ++i) {
        if (is_on_grid(i)) ++particle_count[cell_of_[i]];
    }
    std::uint32_t next = 0;
    for (const Cell& corner : active_) {
        for_cells(corner, [&](int cell, const Cell&) {
            first_particle[cell] = next;
            next += particle_count[cell];
        });
    }
    on_grid_ = next;
    for (std::size_t i = 0; i < count; ++i) cell_of_[i] = is_on_grid(i) ? first_particle[cell_of_[i]]++ : next++;
    sorted_.resize(count);
    parallel_for(workers, count, count > few_particles, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) sorted_[cell_of_[i]] = particles[i];
    });
    for_tiles(workers, [&](const Cell& corner) {
        for_cells(corner, [&](int cell, const Cell&) { first_particle[cell] -= particle_count[cell]; });
    });
    particles.swap(sorted_);
}

}  // namespace embody::physics::fluid
