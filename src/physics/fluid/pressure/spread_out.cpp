// SPDX-License-Identifier: MIT
// Displacements that bring the density back to one: A q = (density − room), shift = −h ∂q (docs/physics/fluids.md,
// "Volume"; after T. Kugelstadt and others, "Implicit density projection for volume conserving liquids", 2019).
#include <algorithm>

#include "foundation/zone.h"
#include "physics/fluid/grid/faces.h"
#include "physics/fluid/solver.h"

namespace embody::physics::fluid {

namespace {

// The only cell that this one is open to, or −1: a dead end lies behind a wall that ends within half a cell beyond its
// neighbour's centre.
int neighbour_of_dead_end(const FluidGrid& grid, int cell) {
    int neighbour = -1;
    for (int axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(axis);
        for (const int other : {cell - stride, cell + stride}) {
            if (grid.open[axis][std::max(cell, other)] <= 0) continue;
            if (neighbour >= 0) return -1;
            neighbour = other;
        }
    }
    return neighbour;
}

// Density less room in each row's cell. No flow ends in a dead end, and only particles of its neighbour reach it: what
// it lacks is lacking there. Through the slit between both its own error took displacements of a tenth of a cell,
// which the neighbour's took back, for ever.
void find_density_errors(const FluidGrid& grid, const PressureSystem& system, std::vector<double>& errors) {
    errors.resize(system.size());
    for (std::size_t row = 0; row < errors.size(); ++row) {
        const auto cell = static_cast<int>(system.cell(row));
        errors[row] = grid.density[cell] - grid.room[cell];
    }
    for (std::size_t row = 0; row < errors.size(); ++row) {
        const int neighbour = neighbour_of_dead_end(grid, static_cast<int>(system.cell(row)));
        if (neighbour < 0 || grid.row[neighbour] < 0) continue;
        errors[static_cast<std::size_t>(grid.row[neighbour])] += errors[row];
        errors[row] = 0;
    }
}

// Whether air is beside the cell.
bool is_at_surface(const FluidGrid& grid, int cell) {
    for (int axis = 0; axis < 3; ++axis) {
        const int stride = grid.stride(axis);
        if (grid.open[axis][cell] > 0 && grid.row[cell - stride] < 0) return true;
        if (grid.open[axis][cell + stride] > 0 && grid.row[cell + stride] < 0) return true;
    }
    return false;
}

}  // namespace

void FluidSolver::spread_out(TaskPool& workers) {
    EMBODY_ZONE("solve volume");
    const double fraction = settings_.volume.correction_fraction, most = settings_.volume.max_error;
    const double tolerance = fraction * settings_.volume.tolerance;
    potential_.assign(system_.size(), 0);
    find_density_errors(grid_, system_, flow_);
    for (std::size_t row = 0; row < system_.size(); ++row) {
        double error = std::clamp(flow_[row], -most, most);
        // Next to the surface the density may be less.
        if (error < 0 && is_at_surface(grid_, static_cast<int>(system_.cell(row)))) error = 0;
        flow_[row] = fraction * error;
    }
    system_.set_bodies({}, 0);
    system_.solve(flow_, potential_, tolerance, settings_.volume.max_iterations, workers);
    grid_.for_tiles(workers, [&](const Cell& corner) {
        grid_.for_rows(corner, [&](int first, const Cell&) {
            for (auto& field : grid_.shift) std::fill_n(field.begin() + first, FluidGrid::tile[0], 0.0f);
        });
    });
    subtract_gradient(grid_, {system_, potential_, {}, grid_.cell_size()}, grid_.shift, workers);
}

}  // namespace embody::physics::fluid
