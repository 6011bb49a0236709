// SPDX-License-Identifier: MIT
#include "physics/fluid/pressure/surface_tension.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/fluid/particles/transfer.h"

namespace embody::physics::fluid {

namespace {

/// Smooths along an axis over the active tiles; elsewhere a field stays as it is. The density is smoothed once more by
/// (1, 4, 1)/6 along each axis.
struct Smoothing {
    const FluidGrid& grid;
    float side_weight;
    std::vector<float>& scratch;
    TaskPool& workers;
    void apply(int axis, std::vector<float>& field) const;
};

void Smoothing::apply(int axis, std::vector<float>& field) const {
    const int stride = grid.stride(axis);
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            const float beside = field[cell - stride] + field[cell + stride];
            scratch[cell] = side_weight * beside + (1 - 2 * side_weight) * field[cell];
        });
    });
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_rows(corner, [&](int first, const Cell&) {
            std::copy_n(scratch.begin() + first, FluidGrid::tile[0], field.begin() + first);
        });
    });
}

// −∇·(∇c/|∇c|), in 1/cells, by central differences.
float curvature_at(const FluidGrid& grid, const FluidTensionSettings& settings, const std::vector<float>& c, int cell) {
    const float min_slope = settings.min_slope, max_curvature = settings.max_curvature;
    const int strides[3] = {grid.stride(0), grid.stride(1), grid.stride(2)};
    float g[3], second[3][3];
    for (int a = 0; a < 3; ++a) {
        const int s = strides[a];
        g[a] = 0.5f * (c[cell + s] - c[cell - s]);
        second[a][a] = c[cell + s] - 2 * c[cell] + c[cell - s];
        for (int b = 0; b < a; ++b) {
            const int t = strides[b];
            second[a][b] = 0.25f * (c[cell + s + t] - c[cell + s - t] - c[cell - s + t] + c[cell - s - t]);
        }
    }
    const float squared = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    if (squared < min_slope * min_slope) return 0;
    const float along = g[0] * g[0] * second[0][0] + g[1] * g[1] * second[1][1] + g[2] * g[2] * second[2][2] +
                        2 * (g[0] * g[1] * second[1][0] + g[0] * g[2] * second[2][0] + g[1] * g[2] * second[2][1]);
    const float trace = second[0][0] + second[1][1] + second[2][2];
    return std::clamp((along / squared - trace) / std::sqrt(squared), -max_curvature, max_curvature);
}

}  // namespace

bool is_tense(const FluidTensionSettings& settings, double tension, double density, double gravity, double h) {
    const double coarsest = settings.max_cell_size;
    return tension > 0 && density * gravity * h * h < coarsest * coarsest * tension;
}

double steady_tension(double density, double h, double dt) {
    return density * h * h * h / (4 * std::numbers::pi * dt * dt);
}

void SurfacePressure::measure(double impulse, const FluidTensionSettings& settings, const FluidGrid& grid,
                              TaskPool& workers) {
    constexpr float min_room = 1e-3f;  // of the kernel: smaller values are rounding
    settings_ = settings;
    impulse_ = impulse;
    fractions_.clear();
    const std::size_t cells = grid.row.size();
    filled_.assign(cells, 0);
    room_.assign(cells, 1);
    scratch_.resize(cells);
    curvature_.assign(cells, 0);
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            room_[cell] = grid.room[cell];
            filled_[cell] = std::min(grid.density[cell], grid.room[cell]);
        });
    });
    const Smoothing smoothing{grid, settings.smoothing_weight, scratch_, workers};
    for (int axis = 0; axis < 3; ++axis) {
        smoothing.apply(axis, filled_);
        smoothing.apply(axis, room_);
    }
    // Volume fractions of the part outside obstacles, so that walls add no curvature: the surface meets them at a right
    // angle.
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            filled_[cell] = room_[cell] > min_room ? filled_[cell] / room_[cell] : 0;
        });
    });
    const auto per_cell = static_cast<float>(1 / grid.cell_size());
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_cells(corner, [&](int cell, const Cell&) {
            curvature_[cell] = curvature_at(grid, settings, filled_, cell) * per_cell;
        });
    });
}

void SurfacePressure::draw_in(const FluidGrid& grid, const float* place, float* shift) const {
    float slope[3];
    const float outside = sample_center(grid, grid.surface, place, slope);
    if (outside < settings_.stray_distance) return;
    (void)sample_center(grid, filled_, place, slope);
    const float steepness = std::sqrt(slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]);
    if (steepness < settings_.stray_min_slope) return;
    const float beyond = outside - settings_.stray_distance;
    const float travel = settings_.stray_rate * beyond * static_cast<float>(grid.cell_size()) / steepness;
    for (int axis = 0; axis < 3; ++axis) shift[axis] += travel * slope[axis];
}

}  // namespace embody::physics::fluid
