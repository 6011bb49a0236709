// SPDX-License-Identifier: MIT
// C. Jiang, C. Schroeder, A. Selle, J. Teran, A. Stomakhin, "The affine particle-in-cell method", 2015: on the
// staggered grid with trilinear weights w, velocity v_a = Σ w u_a and its gradient c_a = Σ u_a ∇w go from faces to
// particles, and u_a = Σ w (v_a + c_a · (x_face − x)) / Σ w back. Linear and angular momentum are kept.
#include "physics/fluid/transfer.h"

#include <algorithm>

namespace embody::physics {

namespace {

/// The eight faces or centres around a place and where it lies between them.
struct Corners {
    int base;
    float f[3];  ///< share of the way from the lower to the upper ones
};

// `across`: axis along which the samples lie on the cells' faces; 3: on centres.
Corners corners_at(const FluidGrid& grid, const float* in_cells, int across) {
    Corners corners{};
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const float at = in_cells[axis] - (axis == across ? 0.0f : 0.5f);
        cell[axis] = static_cast<int>(at);
        corners.f[axis] = at - static_cast<float>(cell[axis]);
    }
    corners.base = grid.index(cell);
    return corners;
}

void clear_tiles(FluidGrid& grid, TaskPool& workers) {
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_rows(corner, [&](int first, const Cell&) {
            for (int axis = 0; axis < 3; ++axis) {
                std::fill_n(grid.velocity[axis].begin() + first, FluidGrid::tile[0], 0.0f);
                std::fill_n(grid.mass[axis].begin() + first, FluidGrid::tile[0], 0.0f);
            }
            std::fill_n(grid.density.begin() + first, FluidGrid::tile[0], 0.0f);
        });
    });
}

void spread(FluidGrid& grid, const FluidParticle& particle, const std::array<float, 3>& place, float volume) {
    const int dy = grid.stride(1), dz = grid.stride(2);
    const auto h = static_cast<float>(grid.cell_size());
    float at[3];
    for (int axis = 0; axis < 3; ++axis) at[axis] = grid.in_cells(place[axis], axis);
    const int offsets[8] = {0, 1, dy, dy + 1, dz, dz + 1, dz + dy, dz + dy + 1};
    for (int axis = 0; axis < 3; ++axis) {
        const Corners c = corners_at(grid, at, axis);
        const float* gradient = particle.affine[axis];
        const float gx = gradient[0] * h, gy = gradient[1] * h, gz = gradient[2] * h;
        const float low = particle.velocity[axis] - (gx * c.f[0] + gy * c.f[1] + gz * c.f[2]);
        const float x1 = c.f[0], x0 = 1 - x1, y1 = c.f[1], y0 = 1 - y1, z1 = c.f[2], z0 = 1 - z1;
        const float weights[8] = {x0 * y0 * z0, x1 * y0 * z0, x0 * y1 * z0, x1 * y1 * z0,
                                  x0 * y0 * z1, x1 * y0 * z1, x0 * y1 * z1, x1 * y1 * z1};
        const float values[8] = {low,      low + gx,      low + gy,      low + gy + gx,
                                 low + gz, low + gz + gx, low + gz + gy, low + gz + gy + gx};
        float* momentum = &grid.velocity[axis][c.base];
        float* mass = &grid.mass[axis][c.base];
        for (int k = 0; k < 8; ++k) {
            momentum[offsets[k]] += weights[k] * values[k];
            mass[offsets[k]] += weights[k];
        }
    }
    const Corners c = corners_at(grid, at, 3);
    const float x1 = c.f[0], x0 = 1 - x1, y1 = c.f[1], y0 = 1 - y1, z1 = c.f[2] * volume, z0 = volume - z1;
    const float weights[8] = {x0 * y0 * z0, x1 * y0 * z0, x0 * y1 * z0, x1 * y1 * z0,
                              x0 * y0 * z1, x1 * y0 * z1, x0 * y1 * z1, x1 * y1 * z1};
    float* density = &grid.density[c.base];
    for (int k = 0; k < 8; ++k) density[offsets[k]] += weights[k];
}

}  // namespace

void particles_to_grid(FluidGrid& grid, const std::vector<FluidParticle>& particles,
                       const std::vector<std::array<float, 3>>& places, float volume, TaskPool& workers) {
    clear_tiles(grid, workers);

    // Tiles of one colour reach no common face, so that each face is added to in the same order by any workers.
    for (int color = 0; color < FluidGrid::colors; ++color) {
        const auto list = grid.colored(color);
        share_among(workers, list.size(), list.size() > 3, [&](int, Share share) {
            for (std::size_t i = share.first; i < share.last; ++i) {
                grid.for_cells(grid.tiles()[list[i]], [&](int cell, const Cell&) {
                    const std::uint32_t first = grid.first_particle[cell], count = grid.particle_count[cell];
                    for (std::uint32_t p = first; p < first + count; ++p) spread(grid, particles[p], places[p], volume);
                });
            }
        });
    }
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_rows(corner, [&](int first, const Cell&) {
            for (int axis = 0; axis < 3; ++axis) {
                for (int cell = first; cell < first + FluidGrid::tile[0]; ++cell) {
                    const float mass = grid.mass[axis][cell];
                    grid.known[axis][cell] = mass > 1e-6f;
                    grid.velocity[axis][cell] = mass > 1e-6f ? grid.velocity[axis][cell] / mass : 0;
                }
            }
        });
    });
}

FieldSample sample_field(const FluidGrid& grid, const std::array<std::vector<float>, 3>& field, const float* position) {
    const int dy = grid.stride(1), dz = grid.stride(2);
    const auto per_cell = static_cast<float>(1 / grid.cell_size());
    float at[3];
    for (int axis = 0; axis < 3; ++axis) at[axis] = grid.in_cells(position[axis], axis);
    FieldSample sample;
    for (int axis = 0; axis < 3; ++axis) {
        const Corners c = corners_at(grid, at, axis);
        const float* u = &field[axis][c.base];
        const float fx = c.f[0], fy = c.f[1], fz = c.f[2];
        // Along x on the four edges, then along y, then along z.
        const float d00 = u[1] - u[0], d10 = u[dy + 1] - u[dy], d01 = u[dz + 1] - u[dz],
                    d11 = u[dz + dy + 1] - u[dz + dy];
        const float v00 = u[0] + d00 * fx, v10 = u[dy] + d10 * fx, v01 = u[dz] + d01 * fx, v11 = u[dz + dy] + d11 * fx;
        const float e0 = v10 - v00, e1 = v11 - v01;
        const float w0 = v00 + e0 * fy, w1 = v01 + e1 * fy;
        const float gx0 = d00 + (d10 - d00) * fy, gx1 = d01 + (d11 - d01) * fy;
        sample.value[axis] = w0 + (w1 - w0) * fz;
        sample.gradient[axis][0] = (gx0 + (gx1 - gx0) * fz) * per_cell;
        sample.gradient[axis][1] = (e0 + (e1 - e0) * fz) * per_cell;
        sample.gradient[axis][2] = (w1 - w0) * per_cell;
    }
    return sample;
}

void sample_value(const FluidGrid& grid, const std::array<std::vector<float>, 3>& field, const float* position,
                  float* value) {
    const FieldSample sample = sample_field(grid, field, position);
    std::copy_n(sample.value, 3, value);
}

FaceWeights face_weights(const FluidGrid& grid, const float* position, int axis) {
    float at[3];
    for (int a = 0; a < 3; ++a) at[a] = grid.in_cells(position[a], a);
    const Corners c = corners_at(grid, at, axis);
    FaceWeights faces{};
    for (std::size_t k = 0; k < faces.size(); ++k) {
        faces[k] = {c.base, 1};
        for (int a = 0; a < 3; ++a) {
            const bool is_upper = k >> a & 1;
            if (is_upper) faces[k].cell += grid.stride(a);
            faces[k].weight *= is_upper ? c.f[a] : 1 - c.f[a];
        }
    }
    return faces;
}

float sample_center(const FluidGrid& grid, const std::vector<float>& field, const float* position, float* gradient) {
    const int dy = grid.stride(1), dz = grid.stride(2);
    float at[3];
    for (int axis = 0; axis < 3; ++axis) at[axis] = grid.in_cells(position[axis], axis);
    const Corners c = corners_at(grid, at, 3);
    const float* u = &field[c.base];
    const float fx = c.f[0], fy = c.f[1], fz = c.f[2];
    const float d00 = u[1] - u[0], d10 = u[dy + 1] - u[dy], d01 = u[dz + 1] - u[dz], d11 = u[dz + dy + 1] - u[dz + dy];
    const float v00 = u[0] + d00 * fx, v10 = u[dy] + d10 * fx, v01 = u[dz] + d01 * fx, v11 = u[dz + dy] + d11 * fx;
    const float e0 = v10 - v00, e1 = v11 - v01;
    const float w0 = v00 + e0 * fy, w1 = v01 + e1 * fy;
    const float gx0 = d00 + (d10 - d00) * fy, gx1 = d01 + (d11 - d01) * fy;
    gradient[0] = gx0 + (gx1 - gx0) * fz;
    gradient[1] = e0 + (e1 - e0) * fz;
    gradient[2] = w1 - w0;
    return w0 + (w1 - w0) * fz;
}

}  // namespace embody::physics
