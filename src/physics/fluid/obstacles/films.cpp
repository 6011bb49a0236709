// SPDX-License-Identifier: MIT
// docs/physics/fluids.md, "Films".
#include "physics/fluid/obstacles/films.h"

#include <algorithm>

namespace embody::physics::fluid {

namespace {

bool is_shut(const FluidGrid& grid, int cell) {
    for (int axis = 0; axis < 3; ++axis) {
        if (grid.open[axis][cell] > 0 || grid.open[axis][cell + grid.stride(axis)] > 0) return false;
    }
    return true;
}

// Density of the liquid around a cell's centre over the first liquid's.
double relative_density(const FluidGrid& grid, int cell) {
    if (grid.mobility[0].empty()) return 1;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int face : {cell, cell + grid.stride(axis)}) sum += grid.relative_density(axis, face);
    }
    return sum / 6;
}

}  // namespace

void Films::begin(const FluidGrid& grid) {
    for (const FilmCell& film : cells_) place_[static_cast<std::size_t>(film.cell)] = -1;
    cells_.clear();
    if (place_.size() != grid.row.size()) place_.assign(grid.row.size(), -1);
}

Films::FilmCell& Films::at(const FluidGrid& grid, int cell) {
    std::int32_t& place = place_[static_cast<std::size_t>(cell)];
    if (place < 0) {
        place = static_cast<std::int32_t>(cells_.size());
        cells_.push_back({.cell = cell, .closed = grid.static_thin[cell]});
    }
    return cells_[static_cast<std::size_t>(place)];
}

void Films::meet(FluidGrid& grid, int axis, const Cell& c) {
    Cell below = c;
    --below[axis];
    for (const Cell& side : {below, c}) {
        if (!grid.is_active(side)) continue;
        const int cell = grid.index(side);
        at(grid, cell);
        grid.thin[cell] |= between;
    }
}

void Films::close(const FluidGrid& grid, int cell, int faces) { at(grid, cell).closed |= faces; }

bool Films::is_closed(const FluidGrid& grid, int axis, int face) const {
    const std::int32_t place = place_[static_cast<std::size_t>(face)];
    const int closed = place < 0 ? grid.static_thin[face] : cells_[static_cast<std::size_t>(place)].closed;
    return (closed >> axis & 1) != 0;
}

// Films spread from the liquid, cell by cell, as far as its pressure reaches.
void Films::find(const FluidGrid& grid, Vec3 weight) {
    const double h = grid.cell_size();
    std::vector<std::size_t> reached;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        FilmCell& film = cells_[i];
        if (!(grid.thin[film.cell] & between) || grid.row[film.cell] < 0) continue;
        film.begin = film.cell;
        film.pressure.row = grid.row[film.cell];
        reached.push_back(i);
    }
    for (std::size_t next = 0; next < reached.size(); ++next) {
        const FilmCell from = cells_[reached[next]];
        for (int axis = 0; axis < 3; ++axis) {
            for (const int side : {-1, 1}) {
                const int cell = from.cell + side * grid.stride(axis);
                const std::int32_t place = place_[static_cast<std::size_t>(cell)];
                if (place < 0) continue;
                FilmCell& film = cells_[static_cast<std::size_t>(place)];
                if (!(grid.thin[cell] & between) || film.begin >= 0 || !is_shut(grid, cell)) continue;
                const bool is_at_liquid = from.begin == from.cell;
                if (is_at_liquid && is_closed(grid, axis, std::max(cell, from.cell))) continue;
                const double head = from.pressure.head + weight[axis] * relative_density(grid, from.begin) * side * h;
                if (!(grid.pressure[from.begin] + head > 0)) continue;
                film.begin = from.begin;
                film.pressure = {from.pressure.row, head};
                reached.push_back(static_cast<std::size_t>(place));
            }
        }
    }
}

Films::Pressure Films::pressure(int cell) const {
    const std::int32_t place = place_[static_cast<std::size_t>(cell)];
    return place < 0 ? Pressure{} : cells_[static_cast<std::size_t>(place)].pressure;
}

}  // namespace embody::physics::fluid
