// SPDX-License-Identifier: MIT
// C. Jiang, C. Schroeder, A. Selle, J. Teran, A. Stomakhin, "The affine particle-in-cell method", 2015: on the
// staggered grid with trilinear weights w, velocity v_a = Σ w u_a and its gradient c_a = Σ u_a ∇w go from faces to
// particles, and u_a = Σ w (v_a + c_a · (x_face − x)) / Σ w back. Linear and angular momentum are kept.
#include "physics/fluid/particles/transfer.h"

#include <algorithm>

#include "physics/fluid/grid/four.h"

namespace embody::physics::fluid {

namespace {

/// The eight faces or centres around a place and where it lies between them.
struct Corners {
    int base;
    float f[3];  ///< fraction of the distance from the lower to the upper ones
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
            for (auto& volume : grid.face_volume) {
                if (!volume.empty()) std::fill_n(volume.begin() + first, FluidGrid::tile[0], 0.0f);
            }
            for (auto& volumes : grid.liquid_volume) std::fill_n(volumes.begin() + first, FluidGrid::tile[0], 0.0f);
        });
    });
}

// The grid's fields of several liquids: as large as the others, or none.
void size_for(const Mixture& liquids, FluidGrid& grid) {
    const std::size_t cells = liquids.is_one() ? 0 : grid.density.size();
    grid.liquid_volume.resize(liquids.is_one() ? 0 : liquids.liquids().size());
    const auto fit = [cells](std::vector<float>& field) {
        if (field.size() != cells) field.assign(cells, 0);
    };
    for (auto& volumes : grid.liquid_volume) fit(volumes);
    for (auto* fields : {&grid.face_volume, &grid.mobility}) {
        for (auto& field : *fields) fit(field);
    }
}

/// Trilinear weights of eight corners: those with the lower z and with the upper one, each in the order of x, then y.
struct Weights {
    Four lower, upper;

    Weights(const Corners& c, float whole) {
        const float x1 = c.f[0], x0 = 1 - x1, y1 = c.f[1], y0 = 1 - y1, z1 = c.f[2] * whole, z0 = whole - z1;
        const Four layer = Four{x0, x1, x0, x1} * Four{y0, y0, y1, y1};
        lower = layer * z0;
        upper = layer * z1;
    }
};

// Adds to the eight corners from `base` on.
void add_to(float* base, int dy, int dz, Four lower, Four upper) {
    store_pairs(load_pairs(base, base + dy) + lower, base, base + dy);
    store_pairs(load_pairs(base + dz, base + dz + dy) + upper, base + dz, base + dz + dy);
}

/// A particle's volume, in cells; of several liquids, which one it is of and its mass.
struct Load {
    float volume = 0;
    std::size_t liquid = 0;
    float mass = 1;
};

template <bool are_several>
void spread(FluidGrid& grid, const FluidParticle& particle, const std::array<float, 3>& place, const Load& load) {
    const int dy = grid.stride(1), dz = grid.stride(2);
    const auto h = static_cast<float>(grid.cell_size());
    float at[3];
    for (int axis = 0; axis < 3; ++axis) at[axis] = grid.in_cells(place[axis], axis);
    for (int axis = 0; axis < 3; ++axis) {
        const Corners c = corners_at(grid, at, axis);
        const float* gradient = particle.affine[axis];
        const float gx = gradient[0] * h, gy = gradient[1] * h, gz = gradient[2] * h;
        const float low = particle.velocity[axis] - (gx * c.f[0] + gy * c.f[1] + gz * c.f[2]);
        const Weights weights(c, are_several ? load.mass : 1);
        const Four across{0, gx, gy, gy + gx}, values = across + low;
        add_to(&grid.velocity[axis][c.base], dy, dz, weights.lower * values, weights.upper * (values + gz));
        add_to(&grid.mass[axis][c.base], dy, dz, weights.lower, weights.upper);
        if constexpr (are_several) {
            const Weights each(c, 1);
            add_to(&grid.face_volume[axis][c.base], dy, dz, each.lower, each.upper);
        }
    }
    const Corners c = corners_at(grid, at, 3);
    const Weights weights(c, load.volume);
    add_to(&grid.density[c.base], dy, dz, weights.lower, weights.upper);
    if constexpr (are_several) add_to(&grid.liquid_volume[load.liquid][c.base], dy, dz, weights.lower, weights.upper);
}

/// A field between eight corners: its value and gradient by cell.
struct Between {
    float value, x, y, z;

    // Along x on the four edges, then along y, then along z.
    Between(const float* u, int dy, int dz, const float* f) {
        const Four low = load_pairs(u, u + dy), high = load_pairs(u + dz, u + dz + dy);
        // Corners by their y and z: 00, 10, 01, 11.
        const Four left = __builtin_shufflevector(low, high, 0, 2, 4, 6),
                   right = __builtin_shufflevector(low, high, 1, 3, 5, 7);
        const Four slope = right - left, edge = left + slope * f[0];
        // Values and slopes along x at the lower z and at the upper one.
        const Four near = __builtin_shufflevector(edge, slope, 0, 2, 4, 6),
                   far = __builtin_shufflevector(edge, slope, 1, 3, 5, 7);
        const Four rise = far - near, middle = near + rise * f[1];
        value = middle[0] + (middle[1] - middle[0]) * f[2];
        x = middle[2] + (middle[3] - middle[2]) * f[2];
        y = rise[0] + (rise[1] - rise[0]) * f[2];
        z = middle[1] - middle[0];
    }
};

template <bool are_several>
void spread_all(FluidGrid& grid, const std::vector<FluidParticle>& particles,
                const std::vector<std::array<float, 3>>& places, const ParticleMatter& matter, TaskPool& workers) {
    const std::span<const std::uint16_t> liquid_of = matter.liquids.liquid_of_particles();
    std::vector<Load> loads;
    for (const FluidProperties& liquid : matter.liquids.liquids()) {
        const double mass = liquid.density / matter.liquids.first().density;
        loads.push_back({matter.volume, loads.size(), static_cast<float>(mass)});
    }

    // Tiles of one colour reach no common face, so that the order of sums at each face does not depend on the workers.
    for (int color = 0; color < FluidGrid::colors; ++color) {
        const auto list = grid.colored(color);
        parallel_for(workers, list.size(), list.size() > 3, [&](int, IndexRange range) {
            for (std::size_t i = range.first; i < range.last; ++i) {
                grid.for_cells(grid.tiles()[list[i]], [&](int cell, const Cell&) {
                    const std::uint32_t first = grid.first_particle[cell], count = grid.particle_count[cell];
                    for (std::uint32_t p = first; p < first + count; ++p)
                        spread<are_several>(grid, particles[p], places[p], loads[are_several ? liquid_of[p] : 0]);
                });
            }
        });
    }
}

// Where no particle is, in gaps between obstacles, the liquid is that of the cells at the face.
float mobility_of(const FluidGrid& grid, const Mixture& liquids, int axis, int cell) {
    const float mass = grid.mass[axis][cell];
    if (mass > 1e-6f) return grid.face_volume[axis][cell] / mass;
    const auto density = [](const FluidProperties& liquid) { return liquid.density; };
    return static_cast<float>(liquids.first().density / liquids.mean_at_face(grid, axis, cell, density));
}

}  // namespace

void particles_to_grid(FluidGrid& grid, const std::vector<FluidParticle>& particles,
                       const std::vector<std::array<float, 3>>& places, const ParticleMatter& matter,
                       TaskPool& workers) {
    const bool are_several = !matter.liquids.is_one();
    size_for(matter.liquids, grid);
    clear_tiles(grid, workers);
    if (are_several) {
        spread_all<true>(grid, particles, places, matter, workers);
    } else {
        spread_all<false>(grid, particles, places, matter, workers);
    }
    grid.for_tiles(workers, [&](const Cell& corner) {
        grid.for_rows(corner, [&](int first, const Cell&) {
            for (int axis = 0; axis < 3; ++axis) {
                for (int cell = first; cell < first + FluidGrid::tile[0]; ++cell) {
                    const float mass = grid.mass[axis][cell];
                    grid.known[axis][cell] = mass > 1e-6f;
                    grid.velocity[axis][cell] = mass > 1e-6f ? grid.velocity[axis][cell] / mass : 0;
                    if (are_several) grid.mobility[axis][cell] = mobility_of(grid, matter.liquids, axis, cell);
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
        const Between between(&field[axis][c.base], dy, dz, c.f);
        sample.value[axis] = between.value;
        sample.gradient[axis][0] = between.x * per_cell;
        sample.gradient[axis][1] = between.y * per_cell;
        sample.gradient[axis][2] = between.z * per_cell;
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
    float at[3];
    for (int axis = 0; axis < 3; ++axis) at[axis] = grid.in_cells(position[axis], axis);
    const Corners c = corners_at(grid, at, 3);
    const Between between(&field[c.base], grid.stride(1), grid.stride(2), c.f);
    gradient[0] = between.x;
    gradient[1] = between.y;
    gradient[2] = between.z;
    return between.value;
}

}  // namespace embody::physics::fluid
