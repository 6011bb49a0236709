// SPDX-License-Identifier: MIT
#include "physics/fluid/grid/liquid_cells.h"

#include <algorithm>
#include <cmath>

namespace embody::physics::fluid {

namespace {

// Height of the surface above a centre, in cells, if the half space below it fills this fraction of the tent kernel.
float height_of_surface(float filled) {
    if (filled <= 0.5f) return std::sqrt(2 * std::max(filled, 0.0f)) - 1;
    return 1 - std::sqrt(2 * std::max(1 - filled, 0.0f));
}

// Depth of the surface over the centre of a hole in the liquid, cells: the hole just counts as liquid.
constexpr float hole_depth = 0.05f;

constexpr float unknown = 2;  // cells; no surface: these are within ±1

struct MarkedCell {
    int cell;
    float surface;
};

template <class Visit>
void visit_open_neighbours(const FluidGrid& grid, int cell, Visit visit) {
    for (int axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(axis);
        if (grid.open[axis][cell] > 0) visit(cell - stride);
        if (grid.open[axis][cell + stride] > 0) visit(cell + stride);
    }
}

bool is_open(const FluidGrid& grid, int cell) {
    bool has_open = false;
    visit_open_neighbours(grid, cell, [&](int) { has_open = true; });
    return has_open;
}

// A hole has liquid in all neighbours with room.
bool is_hole(const FluidGrid& grid, int cell, float min_room) {
    int liquid = 0, dry = 0;
    visit_open_neighbours(grid, cell, [&](int other) {
        if (grid.room[other] < min_room) return;
        ++(grid.surface[other] < 0 ? liquid : dry);
    });
    return liquid > 0 && dry == 0;
}

// The surface goes on into a narrow cell from neighbours that know theirs, as far as they have more room than the cell:
// along a wall it stays as high as beside the wall. From liquid ones where there are any: a seam between pieces of a
// vessel has the air behind it as well. Whether the cell is liquid then.
bool go_on_into(const FluidGrid& grid, int cell, std::vector<MarkedCell>& marked) {
    constexpr float seam_room = 0.05f;  // of the kernel: liquid with less goes on whatever the cell's room. Walls that
                                        // are flat leave 0.125 where they end a cell. Test: FluidVessels, 23.
    constexpr float seam_weight = 1e-3f;  // of the kernel, as those of others. Without it the same vessel loses 7 %.
    struct Mean {
        float sum = 0, weight = 0;
    } liquid, dry;
    visit_open_neighbours(grid, cell, [&](int other) {
        const bool is_seam = grid.surface[other] < 0 && grid.room[other] < seam_room;
        const float weight = std::max(grid.room[other] - grid.room[cell], is_seam ? seam_weight : 0.0f);
        if (grid.surface[other] == unknown || !(weight > 0)) return;
        Mean& mean = grid.surface[other] < 0 ? liquid : dry;
        mean.sum += weight * grid.surface[other];
        mean.weight += weight;
    });
    const Mean& mean = liquid.weight > 0 ? liquid : dry;
    if (mean.weight > 0) marked.push_back({cell, mean.sum / mean.weight});
    return liquid.weight > 0;
}

void mark(FluidGrid& grid, const std::vector<MarkedCell>& marked) {
    for (const MarkedCell& cell : marked) grid.surface[cell.cell] = cell.surface;
}

// Pressure of liquid that goes on to a cell from its neighbour, in direction `step`, as the last pressures there tell.
float pressure_from(const FluidGrid& grid, int neighbour, int step) {
    const float here = grid.pressure[neighbour], before = grid.pressure[neighbour - step];
    return here > 0 && before > 0 ? std::min(2 * here - before, here) : here;
}

// Between obstacles less than a cell apart there is liquid as far as its pressure reaches, cell by cell
// (docs/physics/fluids.md, "Films").
void fill_gaps(FluidGrid& grid, std::vector<int>& gaps) {
    std::vector<MarkedCell> layer;
    std::vector<float> pressures;
    do {
        layer.clear();
        pressures.clear();
        std::erase_if(gaps, [&](int cell) { return grid.surface[cell] < 0; });
        for (const int cell : gaps) {
            float sum = 0, pressure = 0;
            int count = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const int stride = grid.stride(axis);
                for (const int step : {-stride, stride}) {
                    const int other = cell - step;
                    if (grid.open[axis][std::max(cell, other)] <= 0 || !(grid.surface[other] < 0)) continue;
                    const float found = pressure_from(grid, other, step);
                    if (!(found > 0)) continue;
                    sum += grid.surface[other];
                    pressure += found;
                    ++count;
                }
            }
            if (count == 0) continue;
            layer.push_back({cell, sum / static_cast<float>(count)});
            pressures.push_back(pressure / static_cast<float>(count));
        }
        mark(grid, layer);
        for (std::size_t i = 0; i < layer.size(); ++i) grid.pressure[layer[i].cell] = pressures[i];
    } while (!layer.empty());
}

// Thin cells are liquid that no way leads out of through cells with room (docs/physics/fluids.md, "Surface"). Those
// outside are found from cells with no particle near.
void fill_pockets(FluidGrid& grid, const std::vector<int>& thin, float min_room) {
    for (const int cell : thin) grid.surface[cell] = unknown;
    std::vector<int> outside;
    const auto reach = [&](int cell) {
        if (grid.surface[cell] != unknown) return;
        grid.surface[cell] = -height_of_surface(grid.density[cell] / grid.room[cell]);
        outside.push_back(cell);
    };
    for (const int cell : thin) {
        visit_open_neighbours(grid, cell, [&](int other) {
            if (grid.surface[other] >= 0 && grid.room[other] >= min_room && !(grid.density[other] > 0)) reach(cell);
        });
    }
    while (!outside.empty()) {
        const int cell = outside.back();
        outside.pop_back();
        visit_open_neighbours(grid, cell, reach);
    }
    for (const int cell : thin) {
        if (grid.surface[cell] == unknown) grid.surface[cell] = -hole_depth;
    }
}

// Holes with liquid all around are filled, narrow cells take their surface from around, and pockets in the liquid are
// filled.
void mark_beside_liquid(FluidGrid& grid, const FluidCellSettings& settings, TaskPool& workers) {
    const auto tiles = grid.tiles();
    struct Found {
        std::vector<MarkedCell> marked;
        std::vector<int> narrow, between, thin;
    };
    const float min_room = settings.min_room;
    std::vector<Found> found(static_cast<std::size_t>(workers.workers()));
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int worker, IndexRange range) {
        Found& own = found[static_cast<std::size_t>(worker)];
        for (std::size_t i = range.first; i < range.last; ++i) {
            grid.for_cells(tiles[i], [&](int cell, const Cell&) {
                if (grid.room[cell] < min_room) {
                    if (is_open(grid, cell)) own.narrow.push_back(cell);
                } else if (grid.surface[cell] >= 0) {
                    if (is_hole(grid, cell, min_room))
                        own.marked.push_back({cell, -hole_depth});
                    else if (grid.density[cell] > 0)
                        own.thin.push_back(cell);
                }
                if (grid.thin[cell] & between) own.between.push_back(cell);
            });
        }
    });
    std::vector<int> narrow, thin;
    for (const Found& own : found) {
        mark(grid, own.marked);
        thin.insert(thin.end(), own.thin.begin(), own.thin.end());
        narrow.insert(narrow.end(), own.narrow.begin(), own.narrow.end());
    }
    for (const int cell : narrow) grid.surface[cell] = unknown;
    for (int pass = 0; pass <= settings.narrow_passes; ++pass) {
        std::vector<MarkedCell> marked;
        std::erase_if(narrow, [&](int cell) { return go_on_into(grid, cell, marked); });
        mark(grid, marked);
    }
    for (const int cell : narrow) grid.surface[cell] = std::min(grid.surface[cell], 1.0f);
    fill_pockets(grid, thin, min_room);
    std::vector<int> gaps;
    for (const Found& own : found) gaps.insert(gaps.end(), own.between.begin(), own.between.end());
    fill_gaps(grid, gaps);
}

// What bends may fill many cells: the surface goes on through them, layer by layer from around, each as the mean of its
// neighbours.
void extend_into_immersed(FluidGrid& grid, float min_room) {
    std::vector<int> left;
    for (const int cell : grid.immersed_cells) {
        if (grid.room[cell] < min_room && grid.obstacle[cell] > 0) left.push_back(cell);
    }
    for (const int cell : left) grid.surface[cell] = unknown;
    std::vector<MarkedCell> layer;
    do {
        layer.clear();
        for (const int cell : left) {
            float sum = 0;
            int count = 0;
            visit_open_neighbours(grid, cell, [&](int other) {
                if (grid.surface[other] == unknown) return;
                sum += grid.surface[other];
                ++count;
            });
            if (count > 0) layer.push_back({cell, sum / static_cast<float>(count)});
        }
        mark(grid, layer);
        std::erase_if(left, [&](int cell) { return grid.surface[cell] != unknown; });
    } while (!layer.empty());
    for (const int cell : left) grid.surface[cell] = 1;
}

// Rows in the order of the tiles and of the cells in them.
void number_rows(FluidGrid& grid, LiquidCells& liquid, TaskPool& workers) {
    const auto tiles = grid.tiles();
    std::vector<int>& first = liquid.first_row;
    first.assign(tiles.size() + 1, 0);
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            int rows = 0;
            grid.for_cells(tiles[i], [&](int cell, const Cell&) {
                grid.row[cell] = -1;
                if (!(grid.surface[cell] < 0)) return;
                float open = 0;
                for (int axis = 0; axis < 3; ++axis) {
                    open += grid.open[axis][cell] + grid.open[axis][cell + grid.stride(axis)];
                }
                if (open > 1e-4f) grid.row[cell] = rows++;
            });
            first[i + 1] = rows;
        }
    });
    for (std::size_t i = 0; i < tiles.size(); ++i) first[i + 1] += first[i];
    liquid.cells.resize(static_cast<std::size_t>(first.back()));
    parallel_for(workers, tiles.size(), tiles.size() > 16, [&](int, IndexRange range) {
        for (std::size_t i = range.first; i < range.last; ++i) {
            if (first[i] == first[i + 1]) continue;
            grid.for_cells(tiles[i], [&](int cell, const Cell&) {
                if (grid.row[cell] < 0) return;
                grid.row[cell] += first[i];
                liquid.cells[static_cast<std::size_t>(grid.row[cell])] = static_cast<std::uint32_t>(cell);
            });
        }
    });
}

}  // namespace

void mark_liquid(FluidGrid& grid, const FluidCellSettings& settings, LiquidCells& liquid, TaskPool& workers) {
    const float min_room = settings.min_room;
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            const float room = grid.room[cell];
            grid.surface[cell] = room < min_room ? 1 : -height_of_surface(grid.density[cell] / room);
        });
    });

    mark_beside_liquid(grid, settings, workers);
    if (!grid.immersed_cells.empty()) extend_into_immersed(grid, min_room);
    number_rows(grid, liquid, workers);
}

}  // namespace embody::physics::fluid
